/// What a run says: every line goes to log.txt and to the terminal; a status line is replaced in place.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

namespace app
{
/// Write to the terminal at once. A reader that went away (`| head`) ends nothing.
void say(const std::string& text);

class Log
{
public:
    /// Append to a log file; parts of a resumed run follow each other.
    ///
    /// @param out       where the terminal lines go
    /// @param terminal  does `out` show a replaced line in place?
    /// @error FileError if the file cannot be opened
    Log(const std::filesystem::path& path, std::FILE* out, bool terminal);
    /// The same on standard output.
    explicit Log(const std::filesystem::path& path);
    /// Keep the file to oneself while the log lives.
    /// @return false if another run holds it
    bool lock();
    ~Log();
    Log(const Log&) = delete;
    Log& operator=(const Log&) = delete;

    bool terminal() const { return terminal_; }
    /// Write one line. A full disk does not stop a run here: the results report it.
    void line(const std::string& text);
    /// Write one line to the file only.
    void file_line(const std::string& text);
    /// Replace the status line on a terminal; nothing elsewhere.
    void status(const std::string& text);

private:
    void clear_status();

    std::FILE* file_;
    std::FILE* out_;
    bool terminal_;
    bool status_shown_ = false;
};
} // namespace app
