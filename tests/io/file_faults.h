/// Places where writing fails.
#pragma once

#include <sys/resource.h>

#include <csignal>
#include <string>

namespace faults
{
/// While it lives no file of this process can grow beyond `bytes`: writes fail with "File too large", as with a full
/// disk they fail with "No space left on device".
class FileSizeLimit
{
public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN))
    {
        ::getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit()
    {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit old_{};
    void (*handler_)(int);
};

/// Predicate for EXPECT_PRED2, which prints both texts when it fails.
inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != text.npos;
}

/// What an exception of type Error thrown by `action` says; empty if there is none.
template <class Error, class Action>
std::string message(Action&& action)
{
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}
} // namespace faults
