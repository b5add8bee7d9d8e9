#include "io/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace io
{
namespace
{
/// Damerau-Levenshtein distance (restricted: a pair is swapped at most once).
std::size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            cost[i][j] = std::min({changed, cost[i - 1][j] + 1, cost[i][j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
        }
    return cost[a.size()][b.size()];
}

/// A line as it may be shown: what would command the terminal, as in a file that is no text, becomes '?'.
std::string printable(std::string line)
{
    for (char& c : line)
        if ((static_cast<unsigned char>(c) < ' ' && c != '\t') || c == '\x7f') c = '?';
    return line;
}
} // namespace

int Diagnostics::add_source(std::string name, std::string_view text)
{
    Source source{std::move(name), {}};
    while (true) {
        const std::size_t end = text.find('\n');
        std::string line(text.substr(0, end));
        if (!line.empty() && line.back() == '\r') line.pop_back();
        source.lines.push_back(std::move(line));
        if (end == std::string_view::npos) break;
        text.remove_prefix(end + 1);
    }
    sources_.push_back(std::move(source));
    return static_cast<int>(sources_.size()) - 1;
}

void Diagnostics::error(const Place& place, std::string message, std::string beside, std::vector<std::string> notes)
{
    errors_.push_back({place, std::move(message), std::move(beside), std::move(notes)});
}

void Diagnostics::key_error(const Place& place, std::string message, std::string beside, std::vector<std::string> notes)
{
    errors_.push_back({place, std::move(message), std::move(beside), std::move(notes), true});
}

void Diagnostics::warning(const Place& place, std::string message, std::string beside)
{
    warnings_.push_back({place, std::move(message), std::move(beside), {}});
}

void Diagnostics::forget_errors(std::size_t count)
{
    errors_.erase(errors_.begin() + static_cast<std::ptrdiff_t>(std::min(count, errors_.size())), errors_.end());
}

std::string_view Diagnostics::source_name(const Place& place) const
{
    return place.file < 0 ? std::string_view() : std::string_view(sources_[static_cast<std::size_t>(place.file)].name);
}

std::optional<Complaint> Diagnostics::key_error_in(std::size_t source) const
{
    const auto found = std::find_if(errors_.begin(), errors_.end(), [&](const Complaint& one) {
        return one.of_key && one.place.file == static_cast<int>(source);
    });
    return found == errors_.end() ? std::nullopt : std::optional(*found);
}

std::string Diagnostics::format(const Complaint& complaint, std::string_view kind) const
{
    const Place& place = complaint.place;
    std::string text;
    if (place.file < 0)
        text = fmt::format("{}: {}\n", kind, complaint.message);
    else {
        const Source& source = sources_[static_cast<std::size_t>(place.file)];
        text = fmt::format("{}:{}:{}: {}: {}\n", source.name, place.line, place.column, kind, complaint.message);
        const auto line = static_cast<std::size_t>(std::max(place.line, 1)) - 1;
        const std::string quoted = line < source.lines.size() ? printable(source.lines[line]) : std::string();
        // Tabs stay tabs under the line, so that the caret stands where the eye expects it.
        std::string lead = quoted.substr(0, std::min(quoted.size(), static_cast<std::size_t>(place.column - 1)));
        for (char& c : lead)
            if (c != '\t') c = ' ';
        const std::string underline = "^" + std::string(static_cast<std::size_t>(std::max(place.length, 1)) - 1, '~');
        const std::string beside = complaint.beside.empty() ? "" : "  " + complaint.beside;
        text += fmt::format("{:>5} | {}\n", place.line, quoted);
        text += fmt::format("      | {}{}{}\n", lead, underline, beside);
    }
    for (const std::string& note : complaint.notes) text += fmt::format("   {}\n", note);
    return text;
}

std::string Diagnostics::error_text() const
{
    std::vector<Complaint> sorted = errors_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Complaint& a, const Complaint& b) {
        return std::tie(a.place.file, a.place.line, a.place.column) <
               std::tie(b.place.file, b.place.line, b.place.column);
    });
    std::string text;
    for (const Complaint& complaint : sorted) text += format(complaint, "error");
    return text + fmt::format("{} error{}", sorted.size(), sorted.size() == 1 ? "" : "s");
}

std::vector<std::string> Diagnostics::warning_texts() const
{
    std::vector<std::string> texts;
    for (const Complaint& complaint : warnings_) {
        texts.push_back(format(complaint, "warning"));
        texts.back().pop_back(); // the final newline
    }
    return texts;
}

std::string nearest_name(std::string_view misspelt, const std::vector<std::string>& candidates)
{
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(1, (misspelt.size() + 1) / 3) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(misspelt, candidate);
        if (distance < best_distance) {
            best_distance = distance;
            best = candidate;
        }
    }
    return best;
}

std::string nearest_hint(std::string_view misspelt, const std::vector<std::string>& candidates, std::string_view before)
{
    const std::string near = nearest_name(misspelt, candidates);
    return near.empty() ? "" : fmt::format("{}did you mean '{}'?", before, near);
}

std::string joined(const std::vector<std::string>& names, std::string_view separator)
{
    return fmt::format("{}", fmt::join(names, separator));
}
} // namespace io
