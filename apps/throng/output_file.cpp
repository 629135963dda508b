// Output file: a file that is there whole, or not at all.
#include "apps/throng/output_file.hpp"

#include "apps/throng/options.hpp"

#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace throng {
namespace {

namespace fs = std::filesystem;

/// A file that a name can be given to once it is complete.
bool is_replaceable(const fs::path& path)
{
    std::error_code ignored;
    // Names there stand for what the process has open, whatever that is.
    const std::string text = path.string();
    if (text.starts_with("/dev/") || text.starts_with("/proc/")) return false;
    return !fs::exists(path, ignored) || fs::is_regular_file(path, ignored);
}

/// Creates the file, as the user's umask has it. False, and errno, when that cannot be.
bool create(const std::string& path)
{
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return file >= 0 && ::close(file) == 0;
}

// What the last call of the system failed for.
std::string last_error() { return std::generic_category().message(errno); }

}  // namespace

OutputFile::OutputFile(std::string_view option, std::string_view path)
    : option_(option), path_(path == "-" ? "/dev/stdout" : path), growing_(path_)
{
    if (path.empty()) return;
    const auto refuse = [&](const std::string& why) {
        throw BadInput(option_ + ": " + path_ + ": cannot be written: " + why);
    };
    std::error_code trouble;
    if (fs::is_directory(path_, trouble)) refuse("it is a folder");
    if (is_replaceable(path_)) {
        // A link stays one; what it leads to is replaced.
        if (fs::is_symlink(path_, trouble)) path_ = fs::weakly_canonical(path_, trouble).string();
        if (fs::exists(path_, trouble) && ::access(path_.c_str(), W_OK) != 0) refuse(last_error());
        growing_ = path_ + '.' + std::to_string(::getpid()) + ".part";
        if (!create(growing_)) refuse(last_error());
        kept_ = false;
    }
    stream_.open(growing_, std::ios::binary);
    if (!stream_) {
        const std::string why = last_error();
        if (!kept_) fs::remove(growing_, trouble);
        refuse(why);
    }
}

void OutputFile::discard()
{
    if (kept_) return;
    kept_ = true;
    stream_.close();
    std::error_code ignored;
    fs::remove(growing_, ignored);
}

bool OutputFile::is_stdout() const
{
    struct stat ours = {}, standard = {};
    return !path_.empty() && ::stat(path_.c_str(), &ours) == 0
        && ::fstat(STDOUT_FILENO, &standard) == 0 && ours.st_dev == standard.st_dev
        && ours.st_ino == standard.st_ino;
}

std::string OutputFile::try_keep()
{
    if (path_.empty()) return {};
    const std::string failed = option_ + ": " + path_ + ": cannot be written";
    errno = 0;
    stream_.close();
    if (!stream_) return failed + (errno != 0 ? ": " + last_error() : "");
    if (kept_) return {};
    std::error_code trouble;
    fs::rename(growing_, path_, trouble);
    if (trouble) return failed + ": " + trouble.message();
    kept_ = true;
    return {};
}

void OutputFile::keep()
{
    if (const std::string trouble = try_keep(); !trouble.empty()) throw BadInput(trouble);
}

void refuse_same_file(const OutputFile& output, const std::string& other, std::string_view what)
{
    if (!output.asked_for() || other.empty()) return;
    std::error_code ignored;
    const bool same = output.path() == other || fs::equivalent(output.path(), other, ignored)
        || fs::weakly_canonical(output.path(), ignored) == fs::weakly_canonical(other, ignored);
    if (same && output.path() != "/dev/null")
        throw BadInput(output.path() + ": is " + std::string(what) + " already; give another name");
}

}  // namespace throng
