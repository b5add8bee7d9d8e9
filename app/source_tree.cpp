#include "app/source_tree.h"

namespace app
{
namespace fs = std::filesystem;

std::optional<fs::path> source_file(const fs::path& relative)
{
    std::error_code problem;
    for (fs::path folder = fs::read_symlink("/proc/self/exe", problem).parent_path(); folder.has_relative_path();
         folder = folder.parent_path())
        if (fs::exists(folder / relative, problem)) {
            const fs::path file = fs::proximate(folder / relative, problem); // short in messages
            return problem ? folder / relative : file;
        }
    return {};
}

fs::path here_or_source(const fs::path& file)
{
    std::error_code problem;
    if (file.empty() || file.is_absolute() || fs::exists(file, problem)) return file;
    return source_file(file).value_or(file);
}
} // namespace app
