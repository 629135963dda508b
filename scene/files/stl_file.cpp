#include "scene/files/stl_file.hpp"

#include "scene/files/scene_error.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace throng {
namespace {

// A binary file: 80 bytes of anything, the number of triangles, and for each its normal and three
// corners in float and two bytes of anything, least byte first.
constexpr std::size_t kHeader = 84, kRecord = 50, kNormal = 12, kCorner = 12;

// Triangles by their corners, the same place being the same vertex.
class Welder {
public:
    void add_corner(Vec3 place)
    {
        // Adding zero turns -0 into 0.
        place += Vec3::Zero();
        const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
        const auto [at, is_new] = vertex_at_.try_emplace(bits_of(place), next);
        if (is_new) mesh_.vertices.push_back(place);
        triangle_[corners_++] = at->second;
        if (corners_ < 3) return;
        mesh_.triangles.push_back(triangle_);
        corners_ = 0;
    }
    MeshFile take() { return std::move(mesh_); }

private:
    using Bits = std::array<std::uint64_t, 3>;
    struct HashOf {
        std::size_t operator()(const Bits& bits) const
        {
            std::uint64_t hash = 0;
            for (const std::uint64_t word : bits)
                hash = (std::rotl(hash, 23) ^ word) * 0x9e3779b97f4a7c15;
            return hash ^ hash >> 29;
        }
    };
    static Bits bits_of(const Vec3& place)
    {
        return {std::bit_cast<std::uint64_t>(place.x()), std::bit_cast<std::uint64_t>(place.y()),
                std::bit_cast<std::uint64_t>(place.z())};
    }

    MeshFile mesh_;
    std::unordered_map<Bits, std::uint32_t, HashOf> vertex_at_;
    std::array<std::uint32_t, 3> triangle_{};
    std::size_t corners_ = 0;
};

std::uint32_t word_at(std::string_view bytes, std::size_t at)
{
    std::uint32_t word = 0;
    for (std::size_t k = 4; k-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[at + k]);
    return word;
}

// Bytes that the file would have by its own count of triangles.
std::uint64_t size_told(std::string_view bytes)
{
    return kHeader + kRecord * std::uint64_t{word_at(bytes, kHeader - 4)};
}

constexpr std::string_view kSpace = " \t\r\v\f\n";

bool same_word(std::string_view a, std::string_view b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return (x >= 'A' && x <= 'Z' ? x - 'A' + 'a' : x) == y;
    });
}

std::string_view first_word(std::string_view text)
{
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    return text.substr(0, text.find_first_of(kSpace));
}

// Many a binary file begins with "solid" too; what follows the rest of that line is a facet, or the
// end of an empty solid, in a text alone.
bool is_text(std::string_view bytes)
{
    if (!same_word(first_word(bytes), "solid")) return false;
    const std::size_t line = bytes.find('\n', bytes.find_first_not_of(kSpace));
    if (line == bytes.npos) return false;
    const std::string_view next = first_word(bytes.substr(line));
    return same_word(next, "facet") || same_word(next, "endsolid");
}

// The same of a text that is damaged there: numbers in bytes have zeros among them.
bool may_be_text(std::string_view bytes)
{
    constexpr std::size_t kLooked = 1024;
    return same_word(first_word(bytes), "solid")
        && bytes.substr(0, kLooked).find('\0') == bytes.npos;
}

bool is_binary(std::string_view bytes)
{
    return bytes.size() >= kHeader && bytes.size() == size_told(bytes);
}

class TextParser {
public:
    TextParser(std::string_view text, std::string_view file) : text_(text), file_(file) { }

    MeshFile parse()
    {
        while (!peek().empty()) {
            take_line("solid");
            while (next_is("facet")) parse_facet();
            take_line("endsolid");
        }
        return welder_.take();
    }

private:
    [[noreturn]] void
    fail(std::string_view keyword, std::string_view word, const std::string& wanted) const
    {
        const auto at = static_cast<std::size_t>(word.data() - text_.data());
        const std::string met = word.empty() ? "the end of the file" : in_quotes(word);
        throw scene_error(file_, text_, at, keyword, "wanted " + wanted + ", not " + met);
    }

    std::string_view peek() const
    {
        const std::size_t start = std::min(text_.find_first_not_of(kSpace, at_), text_.size());
        const std::size_t end = std::min(text_.find_first_of(kSpace, start), text_.size());
        return text_.substr(start, end - start);
    }
    bool next_is(std::string_view keyword) const { return same_word(peek(), keyword); }
    std::string_view next_word()
    {
        word_ = peek();
        at_ = static_cast<std::size_t>(word_.data() - text_.data()) + word_.size();
        return word_;
    }
    void take(std::string_view keyword)
    {
        if (!same_word(next_word(), keyword)) fail(keyword, word_, in_quotes(keyword));
    }

    // With its name, which is the rest of the line.
    void take_line(std::string_view keyword)
    {
        take(keyword);
        at_ = std::min(text_.find('\n', at_), text_.size());
    }

    void parse_facet()
    {
        take("facet");
        take("normal");
        // Of a sliver it may be anything.
        for (int k = 0; k < 3; ++k)
            if (next_word().empty()) fail("normal", word_, "three numbers");
        take("outer");
        take("loop");
        for (int corner = 0; corner < 3; ++corner) parse_vertex();
        take("endloop");
        take("endfacet");
    }

    void parse_vertex()
    {
        take("vertex");
        Vec3 place;
        for (Eigen::Index k = 0; k < 3; ++k) {
            std::string_view number = next_word();
            if (number.starts_with('+')) number.remove_prefix(1);
            place[k] = parse_number(number);
            if (!std::isfinite(place[k])) fail("vertex", word_, "three finite numbers");
        }
        welder_.add_corner(place);
    }

    std::string_view text_, file_, word_;
    std::size_t at_ = 0;
    Welder welder_;
};

[[noreturn]] void
fail_at(std::string_view file, std::size_t byte, const std::string& path, const std::string& wanted)
{
    throw SceneError(std::string(file) + ": byte " + std::to_string(byte) + ": error: " + path
                     + ": wanted " + wanted);
}

MeshFile read_binary(std::string_view bytes, std::string_view file)
{
    if (bytes.size() < kHeader)
        fail_at(file, bytes.size(), "header",
                "an STL file: a text of solids and facets, or at least 84 bytes");
    if (bytes.size() != size_told(bytes))
        fail_at(file, kHeader - 4, "triangles",
                std::to_string(size_told(bytes)) + " bytes, 84 and 50 for each of "
                    + std::to_string(word_at(bytes, kHeader - 4)) + " triangles, not "
                    + std::to_string(bytes.size()));
    Welder welder;
    for (std::size_t record = kHeader; record < bytes.size(); record += kRecord)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t at = record + kNormal + corner * kCorner;
            Vec3 place;
            for (std::size_t k = 0; k < 3; ++k)
                place[static_cast<Eigen::Index>(k)] =
                    std::bit_cast<float>(word_at(bytes, at + 4 * k));
            if (!place.allFinite())
                fail_at(file, at, "triangle " + std::to_string((record - kHeader) / kRecord + 1),
                        "corners of finite coordinates");
            welder.add_corner(place);
        }
    return welder.take();
}

}  // namespace

bool is_stl(std::string_view bytes) { return is_binary(bytes) || is_text(bytes); }

MeshFile read_stl(std::string_view bytes, std::string_view file)
{
    const bool text = !is_binary(bytes) && (is_text(bytes) || may_be_text(bytes));
    return text ? TextParser(bytes, file).parse() : read_binary(bytes, file);
}

}  // namespace throng
