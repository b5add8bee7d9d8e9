/// Checkpoints: checkpoint/ck_NNNNNN.h5 (N = step) and `latest`, a text file with the name of the newest.
///
/// A checkpoint holds everything a bitwise continuation needs: all of solver::State and of grid::Levels the choice of
/// leaves and cells; neighbours, tiles and interfaces are rebuilt by the reader, and so are node values, except in the
/// nodal scheme: there motion and force of the nodes are state. Values are exact, uncompressed and protected by
/// checksums. It also holds the text of resolved.toml, so that only the same case goes on; its sections [end]
/// and [output.checkpoint] may differ: a run that has ended can go on further.
#pragma once

#include "io/numbered_files.h"
#include "solver/state.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace io
{
inline constexpr NumberedFiles checkpoint_files{"checkpoint", "ck_", 6, ".h5", "latest"};

/// What a checkpoint must agree with.
struct CheckpointCase
{
    std::string resolved; // text of resolved.toml
    std::string version;  // of the program
};

/// Compare the resolved text of another run with that of this one, without the sections that change no step.
///
/// @param source  file the other text is from
/// @error InputError with the first line that differs
void require_same_case(const std::filesystem::path& source, std::string_view there, const CheckpointCase& of_case);

/// Write a checkpoint, point `latest` at it and remove all but the newest `keep` up to its step. Later ones, left over
/// from another run in this directory, go too.
///
/// @return path of the checkpoint
/// @error FileError; earlier checkpoints are then still there
std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const solver::State& state,
                                       const CheckpointCase& of_case, int keep);

/// Read one checkpoint.
///
/// Of `levels` it fills spacing0, count, origin, leaves (level, origin), level_start, cell_active and cell_start.
/// @error InputError if it belongs to another case or was written by another layout of the program
/// @error FileError if it is missing, truncated or damaged
solver::State read_checkpoint(const std::filesystem::path& path, const CheckpointCase& of_case);

/// Read the checkpoint `latest` names or, if it cannot be read, the newest before it that can.
///
/// Whatever is skipped is passed to `warn` as a sentence.
///
/// @return nothing if there is no checkpoint at all
/// @error InputError as read_checkpoint; FileError if there are checkpoints and none can be read
std::optional<solver::State> resume(const std::filesystem::path& directory, const CheckpointCase& of_case,
                                    const std::function<void(const std::string&)>& warn);
} // namespace io
