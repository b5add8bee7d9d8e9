#include "io/numbered_files.h"

#include "io/atomic_file.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fs = std::filesystem;

namespace
{
using Names = std::vector<std::string>;

constexpr io::NumberedFiles kind{"checkpoint", "ck_", 6, ".h5", "latest"};

void write(const support::Folder& folder, const Names& names)
{
    fs::create_directories(folder / kind.folder);
    for (const std::string& name : names) io::write_file(folder / kind.folder / name, "text");
}

Names names_in(const support::Folder& folder)
{
    Names names;
    for (const auto& entry : fs::directory_iterator(folder / kind.folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}
} // namespace

TEST(NumberedFiles, know_the_names_they_give)
{
    EXPECT_EQ(kind.name(7), "ck_000007.h5");
    EXPECT_EQ(kind.name(12345678), "ck_12345678.h5");
    for (const std::int64_t number : {std::int64_t{0}, std::int64_t{7}, std::int64_t{999999}, std::int64_t{12345678}})
        EXPECT_EQ(kind.number(fs::path("out") / kind.name(number)), number);
}

TEST(NumberedFiles, know_no_other_names)
{
    for (const char* name :
         {"ck_7.h5", "ck_000007_keep.h5", "ck_000007.h5.bak", "ck_0000007.h5", "ck_-00007.h5", "ck_+00007.h5",
          "ck_ 000007.h5", "ck_.h5", "ck_99999999999999999999.h5", "xck_000007.h5", ".ck_000007.h5.tmp", "latest", ""})
        EXPECT_EQ(kind.number(name), -1) << name;
}

TEST(NumberedFiles, are_listed_from_the_largest_number)
{
    const support::Folder folder;
    write(folder, {"ck_000007.h5", "ck_1000000.h5", "ck_999999.h5", "ck_7.h5", "ck_000008_keep.h5", "latest"});
    Names names;
    for (const fs::path& path : io::newest_first(folder / kind.folder, kind)) names.push_back(path.filename().string());
    EXPECT_EQ(names, (Names{"ck_1000000.h5", "ck_999999.h5", "ck_000007.h5"}));
    EXPECT_TRUE(io::newest_first(folder / "none", kind).empty());
}

TEST(NumberedFiles, lose_their_own_temporaries_only)
{
    const support::Folder folder;
    write(folder,
          {"ck_000007.h5", ".ck_000012.h5.tmp", ".latest.tmp", ".note.tmp", ".ck_7.h5.tmp", "ck_000013.h5.tmp"});
    io::remove_temporaries(folder / kind.folder, kind);
    EXPECT_EQ(names_in(folder), (Names{".ck_7.h5.tmp", ".note.tmp", "ck_000007.h5", "ck_000013.h5.tmp"}));
}

TEST(NumberedFiles, are_removed_from_between_those_of_others)
{
    const support::Folder folder;
    io::remove_all(folder.path(), kind); // a run without any
    write(folder, {"ck_000007.h5", "latest", ".ck_000012.h5.tmp", "ck_7.h5", "ck_000007_keep.h5"});
    io::remove_all(folder.path(), kind);
    EXPECT_EQ(names_in(folder), (Names{"ck_000007_keep.h5", "ck_7.h5"}));
    for (const char* own : {"ck_7.h5", "ck_000007_keep.h5"}) fs::remove(folder / kind.folder / own);
    write(folder, {"ck_000007.h5", "latest"});
    io::remove_all(folder.path(), kind);
    EXPECT_FALSE(fs::exists(folder / kind.folder));
}

// A list without a name is no file: nothing else may be taken for it.
TEST(NumberedFiles, may_have_no_list)
{
    constexpr io::NumberedFiles volumes{"vdb", "vol_", 4, ".vdb", ""};
    const support::Folder folder;
    fs::create_directories(folder / "vdb");
    for (const char* name : {"vol_0001.vdb", "vol_10000.vdb", "vol_001.vdb"}) io::write_file(folder / "vdb" / name, "");
    io::remove_all(folder.path(), volumes);
    EXPECT_TRUE(fs::exists(folder / "vdb/vol_001.vdb"));
    EXPECT_FALSE(fs::exists(folder / "vdb/vol_10000.vdb"));
}
