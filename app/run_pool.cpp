#include "app/run_pool.h"

#include "app/stop_request.h"
#include "app/wall_clock.h"
#include "core/error.h"
#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <exception>
#include <thread>

namespace app
{
namespace
{
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds pause{10}; // between two looks at the children

struct Child
{
    pid_t process = 0;
    std::size_t job = 0;
    Clock::time_point start;
};

double seconds(const timeval& time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Between fork and exec only calls that are safe there: everything is prepared before.
[[noreturn]] void become(char* const* argv, int log, rlim_t cpu_limit, pid_t parent)
{
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(127); // it died in between
    ::setpgid(0, 0);                         // Ctrl-C reaches the pool only, which then asks its children to stop
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    if (cpu_limit > 0) {
        const rlimit limit{cpu_limit, cpu_limit + 5};
        ::setrlimit(RLIMIT_CPU, &limit);
    }
    ::execv("/proc/self/exe", argv);
    ::_exit(127);
}

Child start(const Job& job, std::size_t number)
{
    std::vector<std::string> words{"cleave"};
    words.insert(words.end(), job.arguments.begin(), job.arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const int log = ::open(job.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (log < 0) io::throw_file_error("write", job.log, errno);
    const pid_t parent = ::getpid();
    const auto limit = static_cast<rlim_t>(std::ceil(job.cpu_limit));
    const Child child{::fork(), number, Clock::now()};
    if (child.process == 0) become(argv.data(), log, limit, parent);
    ::close(log);
    if (child.process < 0) throw core::FileError("no more processes can be started");
    return child;
}

/// How a child ended, nothing if it still runs.
std::optional<JobEnd> ended(const Child& child)
{
    int status = 0;
    rusage usage{};
    if (::wait4(child.process, &status, WNOHANG, &usage) != child.process) return std::nullopt;
    JobEnd end;
    end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    end.over_limit = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
    end.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    end.wall_s = seconds_since(child.start);
    end.peak_rss = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return end;
}
} // namespace

PoolEnd run_jobs(const std::vector<Job>& jobs, int slots, std::optional<double> walltime, const PoolEvents& events)
{
    const Clock::time_point begin = Clock::now();
    std::vector<Child> children;
    std::size_t next = 0;
    bool stopping = false;
    std::exception_ptr failure; // of a log or record that cannot be written: the children end in order all the same
    const auto attempt = [&](const auto& action) {
        try {
            action();
        } catch (...) {
            if (!failure) failure = std::current_exception();
        }
    };
    std::signal(SIGCHLD, SIG_DFL); // ignored, as some parents leave it, it would keep the ends of children from us
    while (next < jobs.size() || !children.empty()) {
        const bool late = walltime && seconds_since(begin) > *walltime;
        if (!stopping && (stop_requested() || late || failure)) {
            stopping = true;
            for (const Child& child : children) ::kill(child.process, SIGTERM);
        }
        if (stopping && children.empty()) break;
        while (!stopping && next < jobs.size() && children.size() < static_cast<std::size_t>(std::max(1, slots))) {
            attempt([&] { children.push_back(start(jobs[next], next)); });
            if (failure) break;
            events.started(next++);
        }
        std::this_thread::sleep_for(pause);
        for (std::size_t i = 0; i < children.size();)
            if (const std::optional<JobEnd> end = ended(children[i])) {
                const std::size_t job = children[i].job;
                children.erase(children.begin() + static_cast<std::ptrdiff_t>(i));
                attempt([&] { events.ended(job, *end); });
            } else
                ++i;
    }
    if (failure) std::rethrow_exception(failure);
    return stopping ? PoolEnd::stopped : PoolEnd::all_done;
}
} // namespace app
