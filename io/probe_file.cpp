#include "io/probe_file.h"

#include <fmt/format.h>

namespace io
{
namespace
{
bool has_column(const solver::Quantity& quantity)
{
    return !std::holds_alternative<solver::Ratio>(quantity.kind);
}
} // namespace

std::string probe_header(const std::vector<solver::Quantity>& quantities)
{
    std::string text = "step,time_ms";
    for (const solver::Quantity& quantity : quantities)
        if (has_column(quantity)) text += "," + quantity.name;
    return text;
}

std::string probe_text(const std::vector<solver::Quantity>& quantities, const solver::Sample& sample)
{
    std::string text = fmt::format("{},{:.10g}", sample.step, sample.time);
    for (std::size_t i = 0; i < quantities.size(); ++i)
        if (has_column(quantities[i])) text += fmt::format(",{:.10g}", sample.value[i]);
    return text;
}
} // namespace io
