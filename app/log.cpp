#include "app/log.h"

#include "io/atomic_file.h"

#include <cerrno>
#include <sys/file.h>
#include <unistd.h>

namespace app
{
void say(const std::string& text)
{
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

Log::Log(const std::filesystem::path& path, std::FILE* out, bool terminal)
    : file_(std::fopen(path.c_str(), "ae")), out_(out), terminal_(terminal)
{
    if (file_ == nullptr) io::throw_file_error("write", path, errno);
}

Log::Log(const std::filesystem::path& path) : Log(path, stdout, ::isatty(STDOUT_FILENO) == 1) {}

bool Log::lock()
{
    return ::flock(::fileno(file_), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; // some file systems have no locks
}

Log::~Log()
{
    if (status_shown_) std::fputc('\n', out_); // the last status stays readable
    std::fclose(file_);
}

void Log::clear_status()
{
    if (status_shown_) std::fputs("\r\033[K", out_);
    status_shown_ = false;
}

void Log::file_line(const std::string& text)
{
    std::fprintf(file_, "%s\n", text.c_str());
    std::fflush(file_);
}

void Log::line(const std::string& text)
{
    clear_status();
    std::fprintf(out_, "%s\n", text.c_str());
    std::fflush(out_);
    file_line(text);
}

void Log::status(const std::string& text)
{
    if (!terminal_) return;
    clear_status();
    std::fputs(text.c_str(), out_);
    std::fflush(out_);
    status_shown_ = true;
}
} // namespace app
