// STL file: text and bytes give the same mesh, and what is wrong in either is told by its place.
#include "scene/files/stl_file.hpp"

#include "scene/catalog/closed_meshes.hpp"
#include "scene/files/scene_error.hpp"
#include "throng/scene_file.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <random>

namespace throng {
namespace {

// Powers of two, which float holds.
TriangleSoup block() { return box_mesh({0.5, 0.25, 2}); }

std::string text_of(const TriangleSoup& mesh)
{
    std::string text = "solid a block of wood\n";
    for (const auto& triangle : mesh.triangles) {
        text += " facet normal 0 0 nan\n  outer loop\n";
        for (const std::uint32_t corner : triangle) {
            text += "   vertex";
            for (const double x : mesh.vertices[corner]) text += ' ' + std::to_string(x);
            text += '\n';
        }
        text += "  endloop\n endfacet\n";
    }
    return text + "endsolid a block of wood\n";
}

void add_word(std::string& bytes, std::uint32_t word)
{
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>(word >> 8 * k & 0xff);
}

std::string bytes_of(const TriangleSoup& mesh, std::string header = "solid of some program")
{
    header.resize(80, ' ');
    std::string bytes = header;
    add_word(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) add_word(bytes, 0);
        for (const std::uint32_t corner : triangle)
            for (const double x : mesh.vertices[corner])
                add_word(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
        bytes += "ab";
    }
    return bytes;
}

// Each corner where it was, and as many vertices as there are places.
void expect_block(const MeshFile& read)
{
    const TriangleSoup wanted = block();
    ASSERT_EQ(read.triangles.size(), wanted.triangles.size());
    EXPECT_EQ(read.vertices.size(), 8u);
    for (std::size_t t = 0; t < wanted.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(read.vertices[read.triangles[t][k]], wanted.vertices[wanted.triangles[t][k]]);
}

std::string refusal_of(const std::string& bytes, const char* name = "m.stl")
{
    try {
        read_mesh_file(bytes, name);
    } catch (const SceneError& error) {
        return error.what();
    }
    return {};
}

TEST(StlFile, TextAndBytesGiveTheSameMeshWhateverTheirName)
{
    for (const char* name : {"m.stl", "M.STL", "m.obj", "stl", ""}) {
        expect_block(read_mesh_file(text_of(block()), name));
        expect_block(read_mesh_file(bytes_of(block()), name));
        expect_block(read_mesh_file(bytes_of(block(), "exported"), name));
    }
}

TEST(StlFile, ReadsWhatProgramsWrite)
{
    std::string shouted = text_of(block());
    for (char& c : shouted)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    expect_block(read_mesh_file(shouted, "m.stl"));
    std::string lines;
    for (const char c : text_of(block())) lines += c == '\n' ? "\r\n" : std::string(1, c);
    expect_block(read_mesh_file(lines, "m.stl"));

    // Several solids are one mesh, and one without a name or a facet is empty.
    const MeshFile twice = read_mesh_file(text_of(block()) + "\n\n" + text_of(block()), "m.stl");
    EXPECT_EQ(twice.triangles.size(), 24u);
    EXPECT_EQ(twice.vertices.size(), 8u);
    EXPECT_TRUE(read_mesh_file("solid\nendsolid", "m.stl").triangles.empty());
    EXPECT_TRUE(read_mesh_file(bytes_of({}), "m.stl").triangles.empty());

    // The two zeros are one place.
    const MeshFile zeros =
        read_mesh_file("solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex "
                       "-0 0 -0 vertex +1e-3 1 1 endloop endfacet endsolid",
                       "m.stl");
    EXPECT_EQ(zeros.vertices.size(), 2u);
}

TEST(StlFile, RefusesBadTextsAtTheirLine)
{
    const std::string facet = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n";
    const std::pair<std::string, std::string> all[] = {
        {facet + "vertex 1 0 0\nvertex 0 1 x\n",
         "m.stl:6:12: error: vertex: wanted three finite numbers, not \"x\""},
        {facet + "vertex 1 inf 0\n",
         "m.stl:5:10: error: vertex: wanted three finite numbers, not \"inf\""},
        {facet + "vertex 1 0 0\nendloop\n",
         "m.stl:6:1: error: vertex: wanted \"vertex\", not \"endloop\""},
        {facet + "vertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\n",
         "m.stl:7:1: error: endloop: wanted \"endloop\", not \"vertex\""},
        {facet, "m.stl:5:1: error: vertex: wanted \"vertex\", not the end of the file"},
        {"solid x\nfacet normal 0 0",
         "m.stl:2:17: error: normal: wanted three numbers, not the end"},
        {"solid x\nfacte normal 0 0 1\n",
         "m.stl:2:1: error: endsolid: wanted \"endsolid\", not \"facte\""},
        {"solid x\nendsolid x\nmore\n", "m.stl:3:1: error: solid: wanted \"solid\", not \"more\""},
    };
    for (const auto& [text, expected] : all)
        EXPECT_EQ(refusal_of(text).substr(0, expected.size()), expected) << text;
}

TEST(StlFile, RefusesBadBytesAtTheirTriangle)
{
    const std::string good = bytes_of(block());
    EXPECT_EQ(refusal_of(good.substr(0, good.size() - 1)),
              "m.stl: byte 80: error: triangles: wanted 684 bytes, 84 and 50 for each of 12 "
              "triangles, not 683");
    EXPECT_NE(refusal_of(good + "x").find("wanted 684 bytes"), std::string::npos);
    std::string bad = good;
    bad.replace(84 + 2 * 50 + 24 + 4, 4, std::string("\0\0\xc0\x7f", 4));
    EXPECT_EQ(refusal_of(bad),
              "m.stl: byte 208: error: triangle 3: wanted corners of finite coordinates");
    bad = good;
    bad.replace(80, 4, "\xff\xff\xff\xff");
    EXPECT_NE(refusal_of(bad).find("wanted 214748364834 bytes"), std::string::npos);
    EXPECT_EQ(refusal_of("").substr(0, 30), "m.stl: byte 0: error: header: ");
}

TEST(StlFile, OthersAreRefusedByTheirName)
{
    for (const auto& [bytes, name] :
         {std::pair("ply\nformat ascii 1.0\n", "PLY"), std::pair("OFF\n8 12 0\n", "OFF"),
          std::pair("glTF\2", "glTF"), std::pair("Kaydara FBX Binary", "FBX")})
        EXPECT_EQ(refusal_of(bytes, "cow"),
                  std::string("cow:1:1: error: mesh: wanted a Wavefront OBJ or an STL file, not a ")
                      + name + " file");
}

// Whatever becomes of the bytes, they are a mesh whose triangles are between its vertices, or an
// error of one line.
TEST(StlFile, AnyBytesAreAMeshOrAnError)
{
    std::mt19937 dice(5);
    const std::string goods[] = {text_of(block()), bytes_of(block())};
    std::size_t refused = 0;
    for (int i = 0; i < 4000; ++i) {
        std::string bytes = goods[dice() % 2];
        for (std::uint32_t k = dice() % 4; k-- > 0;)
            bytes[dice() % bytes.size()] = static_cast<char>(dice());
        if (dice() % 3 == 0) bytes.resize(dice() % bytes.size());
        try {
            const MeshFile read = read_mesh_file(bytes, "m.stl");
            for (const auto& triangle : read.triangles)
                for (const std::uint32_t corner : triangle) ASSERT_LT(corner, read.vertices.size());
            for (const Vec3& vertex : read.vertices) ASSERT_TRUE(vertex.allFinite());
        } catch (const SceneError& error) {
            const std::string what = error.what();
            EXPECT_NE(what.find(": error: "), std::string::npos);
            EXPECT_NE(what.find("wanted "), std::string::npos);
            EXPECT_EQ(what.find('\n'), std::string::npos);
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000u);
}

TEST(StlFile, AreMeshesOfScenes)
{
    const FileReader reader = [](const std::string& path, std::uint64_t) {
        EXPECT_EQ(path, "in/block.stl");
        const std::string bytes = bytes_of(block());
        return FileContent{bytes, bytes.size(), {}};
    };
    const Scene scene = read_scene_text(R"({"throng": 1,
        "shapes": {"b": {"mesh": {"file": "block.stl", "scale": 0.5}}},
        "bodies": [{"shape": "b"}]})",
                                        "s.json", "in", reader);
    const auto& mesh = std::get<MeshShape>(scene.shapes[0].shape);
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.vertices[0].cwiseAbs(), Vec3(0.25, 0.125, 1));
}

}  // namespace
}  // namespace throng
