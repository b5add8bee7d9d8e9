#include "io/hdf5.h"

#include "core/error.h"
#include "tests/io/file_faults.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>
#include <numeric>
#include <sys/mount.h>

using faults::contains;
using Names = std::vector<std::string>;

namespace
{
/// Numbers that do not compress.
std::vector<double> noise(std::size_t count)
{
    std::vector<double> values(count);
    std::uint64_t seed = 1;
    for (double& value : values) value = static_cast<double>(seed = seed * 6364136223846793005u + 1442695040888963407u);
    return values;
}

void write_noise(const std::filesystem::path& path, io::Hdf5Filter filter)
{
    io::Hdf5Writer file(path);
    file.group("/g");
    file.dataset<double>("/g/noise", noise(300000), 3, filter);
    file.attribute("/g", "after", 1.0);
    file.commit();
}
} // namespace

TEST(Hdf5, ReturnsWhatWasWritten)
{
    const support::Folder folder;
    const auto path = folder.path() / "a.h5";
    const std::vector<double> values = noise(3 * 70001);
    {
        io::Hdf5Writer file(path);
        file.group("/g");
        file.dataset<double>("/g/reals", values, 3);
        file.dataset<std::uint8_t>("/g/bytes", std::vector<std::uint8_t>{1, 2, 255}, 1, io::Hdf5Filter::checksum);
        file.dataset<std::int64_t>("/g/none", std::vector<std::int64_t>{});
        file.attribute("/", "text", std::string_view("mm-g-ms"));
        file.attribute("/", "empty", std::string_view(""));
        file.attribute("/g", "number", std::uint64_t(1) << 63);
        EXPECT_FALSE(std::filesystem::exists(path));
        file.commit();
    }
    EXPECT_EQ(folder.names(), Names{"a.h5"});
    const io::Hdf5Reader file(path);
    EXPECT_EQ(file.dataset<double>("/g/reals"), values);
    EXPECT_EQ(file.columns("/g/reals"), 3);
    EXPECT_EQ(file.columns("/g/bytes"), 1);
    EXPECT_EQ(file.dataset<std::uint8_t>("/g/bytes"), (std::vector<std::uint8_t>{1, 2, 255}));
    EXPECT_TRUE(file.dataset<std::int64_t>("/g/none").empty());
    EXPECT_EQ(file.text_attribute("/", "text"), "mm-g-ms");
    EXPECT_EQ(file.text_attribute("/", "empty"), "");
    EXPECT_EQ(file.attribute<std::uint64_t>("/g", "number").at(0), std::uint64_t(1) << 63);
    EXPECT_TRUE(file.exists("/g/bytes"));
    EXPECT_FALSE(file.exists("/g/other"));
}

TEST(Hdf5, StoresNoTimesSoThatEqualDataGiveEqualBytes)
{
    const support::Folder folder;
    write_noise(folder.path() / "a.h5", io::Hdf5Filter::deflate);
    const hid_t file = H5Fopen((folder.path() / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    H5O_info_t about{};
    EXPECT_GE(H5Oget_info_by_name(file, "/g/noise", &about, H5P_DEFAULT), 0);
    H5Fclose(file);
    EXPECT_EQ(about.ctime, 0); // where HDF5 reports the only time of this kind of object header
}

TEST(Hdf5, LeavesNothingWhenTheDiskIsFull)
{
    const support::Folder folder;
    for (const auto filter : {io::Hdf5Filter::deflate, io::Hdf5Filter::checksum})
        for (const rlim_t bytes : {rlim_t(0), rlim_t(100), rlim_t(5000), rlim_t(1000000)}) {
            std::string message;
            {
                const faults::FileSizeLimit limit(bytes);
                message = faults::message<core::FileError>([&] { write_noise(folder.path() / "a.h5", filter); });
            }
            EXPECT_PRED2(contains, message, "a.h5': File too large") << bytes;
            EXPECT_EQ(folder.names(), Names{});
        }
    write_noise(folder.path() / "a.h5", io::Hdf5Filter::deflate); // the library is still well
    EXPECT_EQ(io::Hdf5Reader(folder.path() / "a.h5").dataset<double>("/g/noise"), noise(300000));
}

TEST(Hdf5, ReportsAFullFileSystem)
{
    const support::Folder folder;
    if (::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=200k") != 0)
        GTEST_SKIP() << "mounting needs a privilege";
    const std::string message =
        faults::message<core::FileError>([&] { write_noise(folder.path() / "a.h5", io::Hdf5Filter::deflate); });
    const std::vector<std::string> names = folder.names();
    ::umount(folder.path().c_str());
    EXPECT_PRED2(contains, message, "No space left on device");
    EXPECT_EQ(names, Names{});
}

TEST(Hdf5, FindsDamagedBytesByTheirChecksum)
{
    const support::Folder folder;
    const auto path = folder.path() / "a.h5";
    write_noise(path, io::Hdf5Filter::checksum);
    {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(path) / 2));
        file.write("damage", 6);
    }
    const io::Hdf5Reader file(path);
    const std::string message =
        faults::message<core::FileError>([&] { std::ignore = file.dataset<double>("/g/noise"); });
    EXPECT_PRED2(contains, message, path.string());
    EXPECT_PRED2(contains, message, "'/g/noise'");
    EXPECT_PRED2(contains, message, "checksum");
}

TEST(Hdf5, NamesFileAndObjectOfAnError)
{
    const support::Folder folder;
    const auto path = folder.path() / "a.h5";
    EXPECT_PRED2(contains, faults::message<core::FileError>([&] { io::Hdf5Reader file(path); }),
                 "No such file or directory");
    write_noise(path, io::Hdf5Filter::deflate);
    {
        const io::Hdf5Reader file(path);
        const auto read = [&] { std::ignore = file.dataset<double>("/g/other"); };
        EXPECT_PRED2(contains, faults::message<core::FileError>(read), "'/g/other'");
    }
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    EXPECT_PRED2(contains, faults::message<core::FileError>([&] { io::Hdf5Reader cut(path); }), "truncated");

    io::Hdf5Writer twice(folder.path() / "b.h5");
    twice.group("/g");
    EXPECT_PRED2(contains, faults::message<core::FileError>([&] { twice.group("/g"); }), "group '/g'");
    EXPECT_PRED2(contains,
                 faults::message<core::FileError>([&] { io::Hdf5Writer lost(folder.path() / "no" / "c.h5"); }),
                 "No such file or directory");
}
