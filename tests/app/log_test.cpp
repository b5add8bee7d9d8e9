#include "app/log.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

namespace
{
/// What a log writes to its terminal and its file.
struct Texts
{
    std::string out, file;
};

Texts run(bool terminal)
{
    const support::Folder folder;
    std::FILE* out = std::fopen((folder.path() / "out").c_str(), "w");
    {
        app::Log log(folder.path() / "log.txt", out, terminal);
        log.line("first");
        log.status("10 %");
        log.status("20 %");
        log.line("second");
        log.status("30 %");
    }
    std::fclose(out);
    return {io::read_file(folder.path() / "out"), io::read_file(folder.path() / "log.txt")};
}
} // namespace

TEST(Log, ReplacesTheStatusOnATerminal)
{
    const Texts texts = run(true);
    EXPECT_EQ(texts.out, "first\n10 %\r\033[K20 %\r\033[Ksecond\n30 %\n");
    EXPECT_EQ(texts.file, "first\nsecond\n");
}

TEST(Log, ShowsNoStatusElsewhere)
{
    const Texts texts = run(false);
    EXPECT_EQ(texts.out, "first\nsecond\n");
    EXPECT_EQ(texts.file, "first\nsecond\n");
}

TEST(Log, AppendsToTheFileOfTheRunBefore)
{
    const support::Folder folder;
    io::write_file(folder.path() / "log.txt", "before\n");
    app::Log(folder.path() / "log.txt", stderr, false).file_line("after");
    EXPECT_EQ(io::read_file(folder.path() / "log.txt"), "before\nafter\n");
    EXPECT_THROW(app::Log(folder.path() / "no" / "log.txt", stderr, false), core::FileError);
}
