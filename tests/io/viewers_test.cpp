/// The programs our users open results with read them: pyopenvdb and ParaView, where they are installed.
#include "io/grid_file.h"
#include "io/particle_fields.h"
#include "io/particle_file.h"
#include "io/vdb_file.h"
#include "tests/io/sample_state.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace
{
bool succeeds(const std::string& command)
{
    return std::system(command.c_str()) == 0;
}

void write_frames(const std::filesystem::path& folder)
{
    solver::State state = sample::state();
    io::ParticleFileOptions particle_options{.version = "0.1.0"};
    for (const io::ParticleField& field : io::particle_fields) particle_options.fields.emplace_back(field.name);
    io::VdbFileOptions vdb_options{.version = "0.1.0"};
    vdb_options.grids.assign(io::vdb_grid_names.begin(), io::vdb_grid_names.end());
    for (int frame = 1; frame <= 2; ++frame) {
        state.clock.step = 100 * frame;
        state.clock.time = 0.01 * frame * frame;
        for (Real& x : state.particles.position[0]) x += 0.1;
        io::write_particle_frame(folder / "particles", state.particles, state.levels, state.clock, particle_options);
        io::write_vdb_frame(folder / "vdb", frame, state.particles, state.levels, state.clock, vdb_options);
    }
}

/// A frame of two levels and one of three.
void write_grid_frames(const std::filesystem::path& folder)
{
    io::GridFileOptions options{.version = "0.1.0"};
    options.fields.assign(io::grid_field_names.begin(), io::grid_field_names.end());
    int frame = 0;
    for (solver::State state : {sample::state(), sample::three_levels(-16)}) {
        state.clock.step = 100 * ++frame;
        state.clock.time = 0.01 * frame * frame;
        io::write_grid_frame(folder / "grid", state.particles, state.levels, state.clock, options);
    }
}

const std::string debian_python = "/usr/bin/python3"; // the modules are Debian packages
const std::string tools = std::string(CLEAVE_SOURCE_DIR) + "/tools/";

/// Is there a ParaView that draws without a screen, and what its checks need?
bool paraview_is_there()
{
    return succeeds("command -v pvbatch xvfb-run >/dev/null && " + debian_python + " -c 'import h5py' 2>/dev/null");
}
} // namespace

TEST(Viewers, PyopenvdbReadsAllGridsOfAVolume)
{
    if (!succeeds(debian_python + " -c 'import pyopenvdb' 2>/dev/null"))
        GTEST_SKIP() << "python3-openvdb is not installed";
    const support::Folder folder;
    write_frames(folder.path());
    EXPECT_TRUE(succeeds(debian_python + " " + tools + "check_vdb.py " + folder.path().string()));
}

TEST(Viewers, SlowParaviewShowsWhatTheFilesHold)
{
    if (!paraview_is_there()) GTEST_SKIP() << "paraview, xvfb or python3-h5py is not installed";
    const support::Folder folder;
    write_frames(folder.path());
    EXPECT_TRUE(succeeds("xvfb-run -a pvbatch " + tools + "check_particles_pvbatch.py " + folder.path().string()));
}

TEST(Viewers, SlowParaviewShowsTheNestedGrid)
{
    if (!paraview_is_there()) GTEST_SKIP() << "paraview, xvfb or python3-h5py is not installed";
    const support::Folder folder;
    write_grid_frames(folder.path());
    EXPECT_TRUE(succeeds("xvfb-run -a pvbatch " + tools + "check_grid_pvbatch.py " + folder.path().string()));
}
