// Mesh file: triangles from a Wavefront OBJ text, and back.
#include "scene/files/mesh_file.hpp"

#include "scene/files/polygon_cut.hpp"
#include "scene/files/scene_error.hpp"
#include "scene/files/stl_file.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

namespace throng {
namespace {

class MeshParser {
public:
    MeshParser(std::string_view text, std::string_view file) : text_(text), file_(file) { }

    MeshFile parse()
    {
        if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;  // how some programs begin a text in UTF-8
        while (at_ < text_.size()) {
            line_end_ = end_of_line();
            const std::string_view keyword = next_word();
            if (keyword == "v") parse_vertex();
            if (keyword == "f") parse_face();
            at_ = line_end_ + 1;
        }
        // A face may name a vertex further down, so that this is known only at the end.
        if (greatest_ > mesh_.vertices.size())
            fail("f", greatest_at_, "wanted one of the " + vertex_count() + " vertices");
        cut_polygons();
        return std::move(mesh_);
    }

private:
    [[noreturn]] void
    fail(std::string_view keyword, std::size_t at, const std::string& wanted) const
    {
        throw scene_error(file_, text_, at, keyword, wanted);
    }
    std::string vertex_count() const { return std::to_string(mesh_.vertices.size()); }

    /// A line goes on in the next one where it ends with a backslash.
    std::size_t end_of_line() const
    {
        std::size_t end = text_.find('\n', at_);
        while (end != text_.npos && goes_on(end)) end = text_.find('\n', end + 1);
        return std::min(end, text_.size());
    }
    bool goes_on(std::size_t end) const
    {
        const std::string_view line = text_.substr(at_, end - at_);
        return line.ends_with('\\') || line.ends_with("\\\r");
    }

    /// The next word of the line, empty at its end or at a comment.
    std::string_view next_word()
    {
        constexpr std::string_view kSpace = " \t\r\v\f\n\\";
        const std::string_view line = text_.substr(0, line_end_);
        at_ = std::min(line.find_first_not_of(kSpace, at_), line_end_);
        if (at_ < line_end_ && line[at_] == '#') at_ = line_end_;
        const std::size_t start = at_;
        at_ = std::min(line.find_first_of(kSpace, at_), line_end_);
        return text_.substr(start, at_ - start);
    }

    std::size_t start_of(std::string_view word) const
    {
        return static_cast<std::size_t>(word.data() - text_.data());
    }

    void parse_vertex()
    {
        Vec3 vertex;
        for (Eigen::Index i = 0; i < 3; ++i) {
            std::string_view word = next_word();
            const std::size_t start = start_of(word);
            if (word.starts_with('+')) word.remove_prefix(1);
            vertex[i] = parse_number(word);
            if (!std::isfinite(vertex[i]))
                fail("v", start, "wanted three finite numbers, not " + in_quotes(word));
        }
        mesh_.vertices.push_back(vertex);
    }

    /// A corner is V, V/VT, V//VN or V/VT/VN; a negative V counts back from the last vertex.
    std::uint32_t parse_corner(std::string_view word)
    {
        std::int64_t place = 0;
        const char* const end = word.data() + word.size();
        const auto [stop, trouble] = std::from_chars(word.data(), end, place);
        const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
        const std::int64_t from_start = place < 0 ? count + 1 + place : place;
        const bool good = trouble == std::errc{} && (stop == end || *stop == '/') && from_start >= 1
            && from_start < 0xffffffff;
        if (!good)
            fail("f", start_of(word),
                 "wanted the number of a vertex, 1 to " + vertex_count() + " or -1 to -"
                     + vertex_count() + ", not " + in_quotes(word));
        if (static_cast<std::uint64_t>(from_start) > greatest_) {
            greatest_ = static_cast<std::uint64_t>(from_start);
            greatest_at_ = start_of(word);
        }
        return static_cast<std::uint32_t>(from_start - 1);
    }

    void parse_face()
    {
        std::array<std::uint32_t, 3> triangle{};
        std::size_t corners = 0;
        for (std::string_view word = next_word(); !word.empty(); word = next_word(), ++corners) {
            const std::uint32_t corner = parse_corner(word);
            if (corners >= 3) triangle[1] = triangle[2];
            triangle[std::min<std::size_t>(corners, 2)] = corner;
            if (corners >= 2) mesh_.triangles.push_back(triangle);
        }
        if (corners < 3) fail("f", at_, "wanted at least three corners");
        if (corners > 3) polygons_.push_back({mesh_.triangles.size() - (corners - 2), corners});
    }

    /// Fans become what their vertices, which may come after their faces, make of them.
    void cut_polygons()
    {
        std::vector<std::uint32_t> corners;
        for (const Polygon& polygon : polygons_) {
            const auto fan = std::span(mesh_.triangles).subspan(polygon.first, polygon.corners - 2);
            corners.assign(fan[0].begin(), fan[0].begin() + 2);
            for (const auto& triangle : fan) corners.push_back(triangle[2]);
            cut_polygon(mesh_.vertices, corners, fan);
        }
    }

    struct Polygon {
        std::size_t first = 0;  // of its triangles
        std::size_t corners = 0;
    };

    std::string_view text_, file_;
    MeshFile mesh_;
    std::vector<Polygon> polygons_;
    std::size_t at_ = 0, line_end_ = 0;
    std::uint64_t greatest_ = 0;  // vertex named by any face, from 1
    std::size_t greatest_at_ = 0;
};

// How files of meshes begin that are not read.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kOthers = {{
    {"ply\n", "PLY"},
    {"ply\r\n", "PLY"},
    {"OFF", "OFF"},
    {"glTF", "glTF"},
    {"Kaydara FBX", "FBX"},
    {"PK\x03\x04", "zip, as 3MF,"},
    {"<?xml", "XML, as COLLADA,"},
}};

bool named_stl(std::string_view file)
{
    std::string tail(file.substr(file.size() - std::min<std::size_t>(file.size(), 4)));
    for (char& c : tail) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return tail == ".stl";
}

}  // namespace

MeshFile read_mesh_file(std::string_view bytes, std::string_view file)
{
    if (is_stl(bytes)) return read_stl(bytes, file);
    for (const auto& [beginning, name] : kOthers)
        if (bytes.starts_with(beginning))
            throw scene_error(file, bytes, 0, "mesh",
                              "wanted a Wavefront OBJ or an STL file, not a " + std::string(name)
                                  + " file");
    return named_stl(file) ? read_stl(bytes, file) : read_mesh_text(bytes, file);
}

MeshFile read_mesh_text(std::string_view text, std::string_view file)
{
    return MeshParser(text, file).parse();
}

std::string mesh_text(const MeshFile& mesh)
{
    std::string text;
    for (const Vec3& v : mesh.vertices)
        text +=
            "v " + number_text(v.x()) + ' ' + number_text(v.y()) + ' ' + number_text(v.z()) + '\n';
    for (const auto& t : mesh.triangles)
        text += "f " + std::to_string(t[0] + 1) + ' ' + std::to_string(t[1] + 1) + ' '
            + std::to_string(t[2] + 1) + '\n';
    return text;
}

}  // namespace throng
