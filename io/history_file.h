/// history.csv: one line per output with the forces, the opening and the energies; units stand in the header.
#pragma once

#include "io/line_file.h"
#include "solver/state.h"

#include <filesystem>
#include <string>
#include <vector>

namespace io
{
/// Column names for that many levels, without the end of line.
std::string history_header(int levels);

/// One line in the order of the header: numbers with 10 significant digits, without the end of line.
std::string history_text(const solver::HistoryLine& line);

/// All complete lines of a history file; the part of an energy that is not a column stays 0.
/// @error FileError if the file cannot be read or its header or a line is not one of these
std::vector<solver::HistoryLine> read_history(const std::filesystem::path& path);

/// The open history file of a run.
class HistoryFile
{
public:
    /// Replace the file by the history there is already: what stands in a checkpoint does not hang on the old file.
    HistoryFile(const std::filesystem::path& path, int levels, const std::vector<solver::HistoryLine>& history);

    /// Append one line.
    /// @error FileError
    void append(const solver::HistoryLine& line);

private:
    LineFile file_;
};
} // namespace io
