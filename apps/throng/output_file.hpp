// Output file: a file that is there whole, or not at all.
//
// It is opened before the work begins, so that a path that cannot be written is refused at once; it
// grows under a name of its own and takes its place when it is complete. What is no regular file (a
// pipe, /dev/stdout) is written as it is.
#pragma once

#include <fstream>
#include <string>
#include <string_view>

namespace throng {

class OutputFile {
public:
    /// Throws BadInput, which names the option, when the path cannot be written. An empty path is a
    /// file that nobody asked for.
    OutputFile(std::string_view option, std::string_view path);
    ~OutputFile() { discard(); }
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    bool asked_for() const { return !path_.empty(); }
    /// Where it goes in the end.
    const std::string& path() const { return path_; }
    /// Where it grows, for those who write by name.
    const std::string& growing_path() const { return growing_; }
    /// It is the standard output, by whatever name.
    bool is_stdout() const;

    std::ostream& stream() { return stream_; }
    /// Completes the file. Answers what could not be written, with its option, or nothing.
    std::string try_keep();
    /// The same. Throws BadInput when something could not be written.
    void keep();
    /// Removes what was not kept.
    void discard();

private:
    std::string option_, path_, growing_;
    std::ofstream stream_;
    bool kept_ = true;
};

/// Refuses two outputs of one name, and an output in the place of the input. Throws BadInput.
void refuse_same_file(const OutputFile& output, const std::string& other, std::string_view what);

}  // namespace throng
