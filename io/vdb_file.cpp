#include "io/vdb_file.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/voxel_sums.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cerrno>
#include <fstream>

namespace io
{
namespace
{
/// openvdb::io::File::write does not look whether the bytes arrived; this one writes to a stream that throws.
class CheckedArchive : public openvdb::io::Archive
{
public:
    using openvdb::io::Archive::write;
    Ptr copy() const override { return std::make_shared<CheckedArchive>(*this); }
};

/// Name of a quantity in the scene of the preset's program.
std::string scene_name(const std::string& grid, const std::string& preset)
{
    return preset == "houdini" && grid == "velocity" ? "vel" : grid;
}

openvdb::math::Transform::Ptr cell_transform(const grid::Levels& levels, Real scale)
{
    const Real h = levels.spacing(levels.count - 1) * scale;
    auto transform = openvdb::math::Transform::createLinearTransform(h);
    const Vec3 centre = levels.origin * scale + Vec3::Constant(h / 2); // a voxel is centred on its index
    transform->postTranslate({centre.x(), centre.y(), centre.z()});
    return transform;
}

/// Grid of one quantity: `value(block, voxel)` where there is mass, background elsewhere.
template <class Grid, class Value>
typename Grid::Ptr fill(const std::vector<VoxelBlock>& blocks, Value value)
{
    auto grid = Grid::create();
    for (const VoxelBlock& block : blocks) {
        const openvdb::Coord origin(block.origin.x(), block.origin.y(), block.origin.z());
        auto* leaf = new typename Grid::TreeType::LeafNodeType(origin, grid->background(), false);
        for (std::size_t voxel = 0; voxel < block.mass.size(); ++voxel)
            if (block.mass[voxel] > 0) leaf->setValueOn(static_cast<openvdb::Index>(voxel), value(block, voxel));
        grid->tree().addLeaf(leaf); // takes ownership
    }
    return grid;
}

openvdb::GridBase::Ptr make_grid(const std::string& name, const std::vector<VoxelBlock>& blocks, Real voxel_volume)
{
    using openvdb::FloatGrid;
    const auto fog = [](FloatGrid::Ptr grid) {
        grid->setGridClass(openvdb::GRID_FOG_VOLUME);
        return grid;
    };
    if (name == "density") {
        const auto per_volume = static_cast<float>(1 / voxel_volume);
        return fog(fill<FloatGrid>(blocks, [&](const VoxelBlock& b, std::size_t i) { return b.mass[i] * per_volume; }));
    }
    if (name == "damage")
        return fog(fill<FloatGrid>(blocks, [](const VoxelBlock& b, std::size_t i) { return b.damage[i] / b.mass[i]; }));
    if (name == "eq_plastic_strain")
        return fog(fill<FloatGrid>(
            blocks, [](const VoxelBlock& b, std::size_t i) { return b.eq_plastic_strain[i] / b.mass[i]; }));
    auto velocity = fill<openvdb::Vec3SGrid>(blocks, [](const VoxelBlock& b, std::size_t i) {
        return openvdb::Vec3s(b.momentum[0][i], b.momentum[1][i], b.momentum[2][i]) / b.mass[i];
    });
    velocity->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE); // turns with the object, is not moved with it
    return velocity;
}

const char* unit_of(const std::string& grid)
{
    if (grid == "density") return "g/mm^3";
    return grid == "velocity" ? "mm/ms" : "1";
}

void write_archive(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids,
                   const openvdb::MetaMap& metadata)
{
    AtomicFile target(path);
    std::ofstream stream(target.temporary(), std::ios::binary | std::ios::trunc);
    if (!stream) throw_file_error("write", path, errno);
    errno = 0;
    try {
        stream.exceptions(std::ios::failbit | std::ios::badbit);
        CheckedArchive().write(stream, grids, /*seekable=*/true, metadata);
        stream.close();
    } catch (const std::ios::failure&) {
        throw_file_error("write", path, errno != 0 ? errno : EIO);
    }
    target.commit();
}
} // namespace

std::filesystem::path write_vdb_frame(const std::filesystem::path& directory, int frame,
                                      const particles::Particles& particles, const grid::Levels& levels,
                                      const solver::Clock& clock, const VdbFileOptions& options)
{
    openvdb::initialize();
    make_directory(directory);
    const std::vector<VoxelBlock> blocks = sum_voxels(particles, levels, options.particles_per_cell);
    const Real h = levels.spacing(levels.count - 1);
    const auto transform = cell_transform(levels, options.scale);
    const std::string creator = "cleave " + options.version;

    openvdb::GridCPtrVec grids;
    for (const std::string& name : options.grids) {
        openvdb::GridBase::Ptr grid = make_grid(name, blocks, h * h * h);
        grid->setName(scene_name(name, options.preset));
        grid->setTransform(transform);
        grid->setCreator(creator);
        grid->setSaveFloatAsHalf(true);
        grid->insertMeta("units", openvdb::StringMetadata(unit_of(name)));
        grids.push_back(grid);
    }
    openvdb::MetaMap metadata;
    metadata.insertMeta("time", openvdb::DoubleMetadata(clock.time));
    metadata.insertMeta("step", openvdb::Int64Metadata(clock.step));
    metadata.insertMeta("units", openvdb::StringMetadata("mm-g-ms"));
    metadata.insertMeta("scene_units_per_mm", openvdb::DoubleMetadata(options.scale));
    metadata.insertMeta("creator", openvdb::StringMetadata(creator));
    write_archive(directory / vdb_files.name(frame), grids, metadata);
    return directory / vdb_files.name(frame);
}

VdbFrame last_vdb_frame(const std::filesystem::path& directory, std::int64_t step)
{
    openvdb::initialize();
    VdbFrame last;
    while (true) {
        const std::filesystem::path path = directory / vdb_files.name(last.number + 1);
        if (!std::filesystem::exists(path)) return last;
        try {
            openvdb::io::File file(path.string());
            file.open();
            const auto own_step = file.getMetadata()->metaValue<std::int64_t>("step");
            if (own_step > step) return last;
            last = {last.number + 1, own_step};
        } catch (const openvdb::Exception& error) {
            throw core::FileError("cannot read '" + path.string() + "': " + error.what());
        }
    }
}
} // namespace io
