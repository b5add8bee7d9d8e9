#include "app/stop_request.h"

#include <csignal>
#include <cstdlib>
#include <sstream>

namespace app
{
namespace
{
volatile std::sig_atomic_t requested = 0;

extern "C" void request_stop(int signal)
{
    if (signal == SIGINT && requested != 0) std::_Exit(128 + SIGINT);
    requested = 1;
}
} // namespace

void catch_stop_signals()
{
    requested = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, request_stop);
    // A terminal that closes stops a run, unless it was started with nohup; a reader that goes away (`| head`) does
    // not.
    if (std::signal(SIGHUP, request_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

bool stop_requested()
{
    return requested != 0;
}

std::optional<double> parse_walltime(const std::string& text)
{
    std::istringstream in(text);
    double part = 0;
    if (!(in >> part) || part < 0) return std::nullopt;
    double total = part;
    const bool clock = in.peek() == ':';
    while (in.peek() == ':') {
        in.get();
        if (!(in >> part) || part < 0) return std::nullopt;
        total = 60 * total + part;
    }
    std::string unit;
    in >> unit;
    std::string more;
    if (in >> more || (clock && !unit.empty())) return std::nullopt;
    if (unit == "min") return 60 * total;
    if (unit == "h") return 3600 * total;
    if (!unit.empty() && unit != "s") return std::nullopt;
    return total;
}
} // namespace app
