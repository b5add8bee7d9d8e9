#include "app/exit_code.h"

#include "core/error.h"

#include <cstdio>
#include <filesystem>
#include <new>

namespace app
{
namespace
{
int report(const char* text, int code)
{
    std::fflush(stdout);
    std::fprintf(stderr, "%s\n", text);
    return code;
}
} // namespace

int run_reporting_errors(const Command& command)
{
    try {
        return command();
    } catch (const core::InputError& error) {
        return report(error.what(), exit_bad_input);
    } catch (const core::NumericalError& error) {
        return report(error.what(), exit_numerical);
    } catch (const core::FileError& error) {
        return report(error.what(), exit_file);
    } catch (const std::filesystem::filesystem_error& error) {
        return report(error.what(), exit_file);
    } catch (const std::bad_alloc&) {
        return report("out of memory: `cleave check` tells how much a case needs", exit_bad_input);
    } catch (const std::exception& error) {
        return report(error.what(), exit_internal);
    }
}
} // namespace app
