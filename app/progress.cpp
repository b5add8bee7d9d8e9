#include "app/progress.h"

#include "app/wall_clock.h"
#include "io/process_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace app
{
namespace
{
constexpr double terminal_pause = 0.5; // s between two status lines on a terminal
constexpr double plain_pause = 30;     // s between two plain lines

/// 41200 as "41 200".
std::string grouped(std::int64_t number)
{
    std::string text = std::to_string(number);
    for (std::size_t end = text.size(); end > 3; end -= 3) text.insert(end - 3, " ");
    return text;
}

/// 1100000 as "1.1M", 85000 as "85k".
std::string short_count(std::uint64_t count)
{
    const auto value = static_cast<double>(count);
    if (count < 1000) return std::to_string(count);
    if (value < 999500) return fmt::format("{:.{}f}k", value / 1e3, value < 9950 ? 1 : 0);
    return fmt::format("{:.{}f}M", value / 1e6, value < 99.5e6 ? 1 : 0);
}

std::string force_text(Real force)
{
    return std::abs(force) < 1000 ? fmt::format("{:.1f} N", force) : fmt::format("{:.2f} kN", force / 1000);
}

double system_seconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
} // namespace

std::string status_line(const Status& status)
{
    const solver::HistoryLine& last = status.last;
    std::string text = "step " + grouped(status.clock.step);
    if (status.done && *status.done > 0)
        text += "/" + grouped(std::llround(static_cast<Real>(status.clock.step) / *status.done));
    text += fmt::format("  t {:.4g} ms", status.clock.time);
    if (status.done) text += fmt::format(" ({:.0f} %)", std::floor(100 * *status.done));
    text += fmt::format("  dt {:.3g}  F {}  COD {:.3g} mm", status.clock.dt, force_text(last.force_upper), last.cod);
    const Real internal = last.energy.elastic + last.energy.plastic + last.energy.decohesion;
    if (internal > 0) text += fmt::format("  KE/IE {:.2g} %", 100 * last.energy.kinetic / internal);
    text += " ";
    for (std::size_t l = 0; l < last.particles.size(); ++l)
        text += fmt::format(" L{} {}", l, short_count(last.particles[l]));
    text += fmt::format("  {:.3g} Mp/s", status.particle_steps_per_s / 1e6);
    if (status.seconds_left) text += "  ETA " + clock_time(*status.seconds_left);
    return text + fmt::format("  RSS {:.1f} GB", static_cast<double>(status.resident_bytes) / 1e9);
}

std::optional<Real> share_done(const solver::End& end, Real time, Real cod)
{
    if (!std::isfinite(end.time) && !std::isfinite(end.cod)) return {};
    const Real share = std::max(time / end.time, cod / end.cod); // an infinite end gives 0
    return std::clamp(share, Real(0), Real(1));
}

Progress::Progress(const solver::End& end, Log& log, std::function<double()> seconds)
    : end_(end), log_(&log), seconds_(std::move(seconds)), start_(seconds_()), shown_(start_), plain_(start_)
{}

Progress::Progress(const solver::End& end, Log& log) : Progress(end, log, system_seconds) {}

void Progress::after_step(const solver::Clock& clock, const solver::HistoryLine& last, std::uint64_t updates)
{
    particle_steps_ += updates;
    const std::optional<Real> done = share_done(end_, clock.time, last.cod);
    if (!started_) {
        started_ = true;
        done_at_start_ = done;
    }
    const double now = seconds_();
    const bool plain = now - plain_ >= plain_pause;
    const bool show = log_->terminal() ? now - shown_ >= terminal_pause : plain;
    if (!show && !plain) return;

    Status status{clock, last, done, {}, 0, io::resident_bytes()};
    status.particle_steps_per_s = static_cast<Real>(particle_steps_) / (now - shown_);
    if (done && *done > *done_at_start_) status.seconds_left = (now - start_) * (1 - *done) / (*done - *done_at_start_);
    const std::string text = status_line(status);
    if (!log_->terminal())
        log_->line(text);
    else
        log_->status(text);
    if (plain) {
        if (log_->terminal()) log_->file_line(text);
        plain_ = now;
    }
    shown_ = now;
    particle_steps_ = 0;
}
} // namespace app
