// Options: the words of a command line, checked against what a command takes.
#include "apps/throng/options.hpp"

#include "scene/names.hpp"

#include <algorithm>
#include <charconv>

namespace throng {
namespace {

constexpr std::string_view kHelp = "--help";

bool asks_for_help(std::string_view word) { return word == kHelp || word == "-h"; }

const Option* find_option(const Usage& usage, std::string_view name)
{
    const auto found = std::find_if(usage.options.begin(), usage.options.end(),
                                    [&](const Option& option) { return option.name == name; });
    return found == usage.options.end() ? nullptr : &*found;
}

std::string unknown_option(const Usage& usage, std::string_view name)
{
    std::vector<std::string_view> known = {kHelp};
    for (const Option& option : usage.options) known.push_back(option.name);
    const std::string near = nearest_names(name, known);
    return std::string(usage.name) + ": there is no option " + in_quotes(name)
        + (near.empty() ? "" : "; did you mean " + near + "?") + " (throng "
        + std::string(usage.name) + " --help lists them)";
}

}  // namespace

Options::Options(const Usage& usage, std::span<const std::string_view> arguments)
{
    const auto end = std::find(arguments.begin(), arguments.end(), "--");
    wants_help_ = std::any_of(arguments.begin(), end, asks_for_help);
    if (wants_help_) return;

    bool only_words = false;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view word = arguments[i];
        if (!only_words && word == "--")
            only_words = true;
        else if (!only_words && word.size() > 1 && word.front() == '-')
            take_option(usage, arguments, i);
        else
            words_.push_back(word);
    }
    const std::string who(usage.name);
    if (words_.size() < usage.least_words)
        throw BadInput(who + ": wanted " + std::string(usage.words) + " (throng " + who
                       + " --help says more)");
    if (words_.size() > usage.most_words)
        throw BadInput(who + ": one word too many: " + in_quotes(words_[usage.most_words])
                       + " (throng " + who + " --help says more)");
}

void Options::take_option(const Usage& usage,
                          std::span<const std::string_view> arguments,
                          std::size_t& place)
{
    const std::string_view word = arguments[place];
    const std::size_t equals = word.find('=');
    const std::string_view name = word.substr(0, equals);
    const Option* option = find_option(usage, name);
    if (option == nullptr) throw BadInput(unknown_option(usage, name));

    const std::string label(name);
    const bool has_value = equals != std::string_view::npos;
    std::string_view value;
    if (option->value.empty()) {
        if (has_value) throw BadInput(label + ": takes no value");
    } else if (has_value) {
        value = word.substr(equals + 1);
    } else {
        // What looks like the next option is taken for one: a forgotten value is the likelier slip.
        const bool there = place + 1 < arguments.size() && !arguments[place + 1].starts_with("--");
        if (there) value = arguments[++place];
    }
    if (!option->value.empty() && value.empty())
        throw BadInput(label + ": wanted a value: " + label + ' ' + std::string(option->value));
    std::vector<std::string_view>& values = values_[option->name];
    if (!values.empty() && !option->repeats) throw BadInput(label + ": given twice");
    values.push_back(value);
}

std::string_view Options::text(std::string_view name) const
{
    const auto found = values_.find(name);
    return found == values_.end() ? std::string_view() : found->second.back();
}

std::vector<std::string_view> Options::all(std::string_view name) const
{
    const auto found = values_.find(name);
    return found == values_.end() ? std::vector<std::string_view>() : found->second;
}

std::int64_t Options::whole(std::string_view name,
                            std::int64_t standard,
                            std::int64_t least,
                            std::int64_t most) const
{
    return has(name) ? parse_whole(name, text(name), least, most) : standard;
}

std::int64_t
parse_whole(std::string_view what, std::string_view text, std::int64_t least, std::int64_t most)
{
    std::int64_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, trouble] = std::from_chars(text.data(), end, number);
    if (trouble != std::errc{} || stop != end || number < least || number > most)
        throw BadInput(std::string(what) + ": wanted a whole number from " + std::to_string(least)
                       + " to " + std::to_string(most) + ", not " + in_quotes(text));
    return number;
}

void print_columns(std::span<const std::pair<std::string, std::string>> rows, std::ostream& out)
{
    constexpr std::size_t kScreen = 100, kWidest = 26;
    std::size_t width = 0;
    for (const auto& [left, right] : rows)
        if (left.size() <= kWidest) width = std::max(width, left.size());
    const std::size_t indent = 2 + width + 2;
    for (const auto& [left, right] : rows) {
        out << "  " << left;
        // A left side that is too wide has its line to itself.
        std::size_t column = 2 + left.size();
        if (column + 2 > indent) {
            out << '\n';
            column = 0;
        }
        out << std::string(indent - column, ' ');
        std::string_view rest = right;
        while (rest.size() > kScreen - indent) {
            std::size_t cut = rest.rfind(' ', kScreen - indent);
            if (cut == std::string_view::npos || cut == 0) break;
            out << rest.substr(0, cut) << '\n' << std::string(indent, ' ');
            rest.remove_prefix(cut + 1);
        }
        out << rest << '\n';
    }
}

std::vector<std::string_view> parts_of(std::string_view option, std::string_view text)
{
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t comma = text.find(',');
        parts.push_back(text.substr(0, comma));
        if (parts.back().empty())
            throw BadInput(std::string(option) + ": wanted a list such as A,B, with no empty part");
        if (comma == std::string_view::npos) return parts;
        text.remove_prefix(comma + 1);
    }
}

void print_usage(const Usage& usage, std::ostream& out)
{
    out << "usage: throng " << usage.name;
    if (!usage.words.empty()) out << ' ' << usage.words;
    if (!usage.options.empty()) out << " [options]";
    out << "\n\n" << usage.about << "\n\n";
    std::vector<std::pair<std::string, std::string>> rows;
    for (const Option& option : usage.options) {
        std::string left(option.name);
        if (!option.value.empty()) left += ' ' + std::string(option.value);
        rows.emplace_back(left, option.about);
    }
    rows.emplace_back("--help", "this text");
    print_columns(rows, out);
}

}  // namespace throng
