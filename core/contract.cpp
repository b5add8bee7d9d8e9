#include "core/contract.h"

#include <cstdio>
#include <cstdlib>

namespace core
{
void contract_broken(const char* kind, const char* condition, const char* file, int line)
{
    std::fprintf(stderr, "%s:%d: contract broken: %s(%s)\n", file, line, kind, condition);
    std::abort();
}
} // namespace core
