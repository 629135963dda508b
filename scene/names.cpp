// Names: what a sentence about a wrong name or value needs.
#include "scene/names.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace throng {
namespace {

// Longer names are never a mistyped key, and the distance costs length times length.
constexpr std::size_t kLongestName = 64;

/// Letters to change, add, leave out or swap with their neighbour to get from a to b.
std::size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        next[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            next[j] = std::min({changed, row[j] + 1, next[j - 1] + 1});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) next[j] = std::min(next[j], before[j - 2] + 1);
        }
        std::swap(before, row);
        std::swap(row, next);
    }
    return row[b.size()];
}

void append_escaped(std::string& out, char letter)
{
    constexpr std::string_view kHex = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(letter);
    if (byte >= 0x20 && byte != 0x7f) {
        out += letter;
        return;
    }
    out += "\\x";
    out += kHex[byte >> 4];
    out += kHex[byte & 15];
}

/// Where a character of UTF-8 begins, at or before the position.
std::size_t character_start(std::string_view text, std::size_t at)
{
    while (at > 0 && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) --at;
    return at;
}

}  // namespace

std::string in_quotes(std::string_view text)
{
    constexpr std::size_t kLongest = 60;
    std::string out = "\"";
    const bool cut = text.size() > kLongest;
    const std::size_t head = cut ? character_start(text, kLongest - 20) : text.size();
    for (const char letter : text.substr(0, head)) append_escaped(out, letter);
    if (cut) {
        out += "...";
        for (const char letter : text.substr(character_start(text, text.size() - 12)))
            append_escaped(out, letter);
    }
    return out + '"';
}

std::string number_text(double number)
{
    std::array<char, 32> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
    return std::string(buffer.data(), end);
}

double parse_number(std::string_view text)
{
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, trouble] = std::from_chars(text.data(), end, number);
    const bool whole = trouble == std::errc{} && stop == end && std::isfinite(number);
    return whole ? number : kNone;
}

std::string nearest_names(std::string_view name, std::span<const std::string_view> known)
{
    if (name.size() > kLongestName) return {};
    struct Candidate {
        std::size_t distance;
        std::string_view name;
    };
    std::vector<Candidate> near;
    for (const std::string_view candidate : known) {
        if (candidate.empty() || candidate.size() > kLongestName) continue;
        const std::size_t distance = edit_distance(name, candidate);
        // A third of the letters wrong is still a slip; so is a name left unfinished.
        const bool begins = name.size() > 2 && candidate.starts_with(name);
        if (begins || distance * 3 <= std::max(name.size(), candidate.size()) + 1)
            near.push_back({distance, candidate});
    }
    std::stable_sort(near.begin(), near.end(), [](const Candidate& a, const Candidate& b) {
        return a.distance < b.distance;
    });
    std::vector<std::string_view> names;
    for (const Candidate& candidate : near)
        if (names.size() < 3) names.push_back(candidate.name);
    return either_of(names);
}

std::string either_of(std::span<const std::string_view> words)
{
    std::string out;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) out += i + 1 == words.size() ? " or " : ", ";
        out += words[i];
    }
    return out;
}

}  // namespace throng
