#include "io/atomic_file.h"

#include "core/error.h"
#include "tests/io/file_faults.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sys/mount.h>

using faults::contains;
using Names = std::vector<std::string>;

TEST(AtomicFile, ReplacesTheOldTextWhole)
{
    const support::Folder folder;
    const auto path = folder.path() / "a.txt";
    io::write_file(path, "first, longer text");
    io::write_file(path, "second");
    EXPECT_EQ(io::read_file(path), "second");
    EXPECT_EQ(folder.names(), Names{"a.txt"});
}

TEST(AtomicFile, KeepsTheOldTextWhenTheDiskIsFull)
{
    const support::Folder folder;
    const auto path = folder.path() / "a.txt";
    io::write_file(path, "old");
    std::string message;
    {
        const faults::FileSizeLimit limit(1000);
        message = faults::message<core::FileError>([&] { io::write_file(path, std::string(5000, 'x')); });
    }
    EXPECT_PRED2(contains, message, path.string());
    EXPECT_PRED2(contains, message, "File too large");
    EXPECT_EQ(io::read_file(path), "old");
    EXPECT_EQ(folder.names(), Names{"a.txt"});
}

TEST(AtomicFile, LeavesNothingWithoutCommit)
{
    const support::Folder folder;
    {
        const io::AtomicFile file(folder.path() / "a.txt");
        std::ofstream(file.temporary()) << "half";
        EXPECT_EQ(folder.names(), Names{".a.txt.tmp"});
    }
    EXPECT_EQ(folder.names(), Names{});
}

TEST(AtomicFile, NamesPathAndReasonWhenTheDirectoryIsAFile)
{
    const support::Folder folder;
    io::write_file(folder.path() / "file", "");
    const auto path = folder.path() / "file" / "a.txt";
    const std::string message = faults::message<core::FileError>([&] { io::write_file(path, "text"); });
    EXPECT_PRED2(contains, message, path.string());
    EXPECT_PRED2(contains, message, "Not a directory");
    EXPECT_THROW(io::make_directory(folder.path() / "file"), core::FileError);
    EXPECT_THROW(io::make_directory(folder.path() / "file" / "sub"), core::FileError);
}

TEST(AtomicFile, ReportsAReadOnlyFileSystem)
{
    const support::Folder folder;
    if (::mount("tmpfs", folder.path().c_str(), "tmpfs", MS_RDONLY, nullptr) != 0)
        GTEST_SKIP() << "mounting needs a privilege";
    const std::string message =
        faults::message<core::FileError>([&] { io::write_file(folder.path() / "a.txt", "text"); });
    ::umount(folder.path().c_str());
    EXPECT_PRED2(contains, message, "Read-only file system");
}

TEST(AtomicFile, ReportsAMissingFile)
{
    EXPECT_PRED2(contains, faults::message<core::FileError>([] { io::read_file("/nowhere/a.txt"); }),
                 "cannot read '/nowhere/a.txt': No such file or directory");
}
