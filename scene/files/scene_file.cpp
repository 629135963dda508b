// Scene file: reading from the disk, and the checks that need the whole scene.
#include "throng/scene_file.hpp"

#include "scene/files/scene_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

namespace throng {
namespace {

/// A length that is off 1 by no more than rounding stays as it is, so that what was written reads
/// back to the same bits.
constexpr double kRounding = 1e-14;

void normalise(Quat& orientation)
{
    const double length = orientation.norm();
    if (std::abs(length - 1) > kRounding) orientation.coeffs() /= length;
}

/// Unit lengths that were given in fewer digits, made so.
void normalise(Scene& scene)
{
    for (BodyDescription& body : scene.bodies) normalise(body.orientation);
    for (Instances& group : scene.instances) {
        for (std::size_t i = 0; i < group.records.size(); i += group.stride()) {
            double* const q = &group.records[i + 3];
            Quat orientation(q[0], q[1], q[2], q[3]);
            normalise(orientation);
            q[0] = orientation.w(), q[1] = orientation.x(), q[2] = orientation.y(),
            q[3] = orientation.z();
        }
    }
    for (ShapeDescription& shape : scene.shapes) {
        if (auto* compound = std::get_if<CompoundShape>(&shape.shape))
            for (CompoundShape::Part& part : compound->parts) normalise(part.pose.orientation);
        if (auto* plane = std::get_if<PlaneShape>(&shape.shape)) {
            const double length = plane->normal.norm();
            if (std::abs(length - 1) <= kRounding) continue;
            plane->normal /= length;
            plane->offset /= length;
        }
    }
}

}  // namespace

FileContent read_file(const std::string& path, std::uint64_t limit)
{
    FileContent content;
    std::error_code trouble;
    if (std::filesystem::is_directory(path, trouble)) {
        content.trouble = "it is a folder";
        return content;
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               std::fclose);
    if (!file) {
        content.trouble = std::generic_category().message(errno);
        return content;
    }
    // A pipe has no size beforehand: it is read up to the limit.
    const std::uintmax_t size = std::filesystem::file_size(path, trouble);
    const std::uint64_t expected = trouble ? 0 : std::min<std::uint64_t>(size, limit);
    content.bytes.resize(expected);
    content.bytes.resize(std::fread(content.bytes.data(), 1, expected, file.get()));
    char buffer[65536];
    while (trouble && content.bytes.size() < limit) {
        const std::size_t wanted =
            static_cast<std::size_t>(std::min<std::uint64_t>(sizeof buffer, limit));
        const std::size_t got = std::fread(buffer, 1, wanted, file.get());
        if (got == 0) break;
        content.bytes.append(buffer, got);
    }
    if (std::ferror(file.get())) content.trouble = std::generic_category().message(errno);
    content.size = trouble ? content.bytes.size() : size;
    if (content.bytes.size() < expected) content.trouble = "it ends before its size";
    return content;
}

Scene read_scene_text(std::string text,
                      const std::string& file,
                      const std::string& folder,
                      const FileReader& reader)
{
    const JsonDocument json(std::move(text), file);
    Scene scene = scene_of(json, folder, reader);
    if (const std::optional<SceneTrouble> trouble = find_trouble(scene))
        throw json.error(json.resolve(trouble->path), trouble->path, trouble->wanted);
    normalise(scene);
    return scene;
}

Scene read_scene(const std::string& path)
{
    FileContent content = read_file(path, ~std::uint64_t{0});
    if (!content.trouble.empty())
        throw scene_error(path, {}, 0, "scene",
                          "wanted a file that can be read (" + content.trouble + ")");
    const std::filesystem::path place(path);
    Scene scene = read_scene_text(std::move(content.bytes), path, place.parent_path().string());
    scene.name = place.stem().string();
    return scene;
}

SceneError error_in_scene(const std::string& path, const SceneTrouble& trouble)
{
    try {
        const JsonDocument json(read_file(path, ~std::uint64_t{0}).bytes, path);
        return json.error(json.resolve(trouble.path), trouble.path, trouble.wanted);
    } catch (const SceneError&) {
        // What cannot be read a second time, as a pipe, has no places any more.
        return SceneError(path + ": error: " + path_text(trouble.path) + ": " + trouble.wanted);
    }
}

}  // namespace throng
