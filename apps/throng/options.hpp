// Options: the words of a command line, checked against what a command takes.
//
// `--name value` and `--name=value` mean the same; `--` ends the options. Whatever is wrong is said
// in one sentence, with the nearest name where one was mistyped.
#pragma once

#include <cstdint>
#include <map>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace throng {

/// What the user gave cannot be done: bad usage, bad input, an output that cannot be written.
class BadInput : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct Option {
    std::string_view name;   // with its dashes
    std::string_view value;  // what stands for its value in the help; empty when it takes none
    std::string_view about;  // units and default included
    bool repeats = false;
};

/// How a command is called.
struct Usage {
    std::string_view name;
    std::string_view words;  // those that are no options, as the help shows them
    std::string_view about;
    std::size_t least_words = 0, most_words = 0;
    std::span<const Option> options;
};

/// A command line taken apart.
class Options {
public:
    /// Throws BadInput. Asking for help forgives everything else.
    Options(const Usage& usage, std::span<const std::string_view> arguments);

    bool wants_help() const { return wants_help_; }
    const std::vector<std::string_view>& words() const { return words_; }
    bool has(std::string_view name) const { return values_.contains(name); }
    /// The value of an option; empty when it was not given.
    std::string_view text(std::string_view name) const;
    /// The values of one that repeats, in order.
    std::vector<std::string_view> all(std::string_view name) const;
    /// A whole number in a range, or the default when the option was not given. Throws BadInput.
    std::int64_t whole(std::string_view name,
                       std::int64_t standard,
                       std::int64_t least,
                       std::int64_t most) const;

private:
    void take_option(const Usage& usage,
                     std::span<const std::string_view> arguments,
                     std::size_t& place);

    std::vector<std::string_view> words_;
    std::map<std::string_view, std::vector<std::string_view>> values_;
    bool wants_help_ = false;
};

/// A whole number in a range; throws BadInput, which calls it `what`.
std::int64_t
parse_whole(std::string_view what, std::string_view text, std::int64_t least, std::int64_t most);

/// The parts of a list between commas. Throws BadInput for an empty one.
std::vector<std::string_view> parts_of(std::string_view option, std::string_view text);

/// Writes how a command is called, and its options in columns.
void print_usage(const Usage& usage, std::ostream& out);

/// Rows of two columns; the second is wrapped to a screen and keeps its indent.
void print_columns(std::span<const std::pair<std::string, std::string>> rows, std::ostream& out);

}  // namespace throng
