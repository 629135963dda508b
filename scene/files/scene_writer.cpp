// Scene writer: a Scene into a scene file's text, and the files that belong to it.
//
// What is at its default is left out. "At its default" is asked of the bits, so that even a zero
// keeps its sign on the way through a file.
#include "scene/files/json.hpp"
#include "scene/files/json_writer.hpp"
#include "scene/files/mesh_file.hpp"
#include "scene/names.hpp"
#include "scene/rules/scene_check.hpp"
#include "scene/shapes/level_set.hpp"
#include "throng/dials.hpp"
#include "throng/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

namespace throng {
namespace {

/// A group of at most this many is as easily read as bodies.
constexpr std::size_t kMostInline = 1000;

/// Names for those that have none, unlike those that have: others refer to them by name.
template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all, std::string_view kind)
{
    std::set<std::string_view> taken;
    for (const Named& one : all) taken.insert(one.name);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::string name = all[i].name;
        if (name.empty()) {
            name = std::string(kind) + '_' + std::to_string(i);
            while (taken.contains(name)) name += '_';
        }
        names.push_back(std::move(name));
    }
    return names;
}

class SceneWriter {
public:
    SceneWriter(const Scene& scene, const std::filesystem::path& path)
        : scene_(scene), path_(path), shape_names_(names_of(scene.shapes, "shape")),
          material_names_(names_of(scene.materials, "material")),
          body_names_(names_of(scene.bodies, "body"))
    {
        for (const Instances& group : scene.instances) taken_files_.insert(group.file);
        for (const ShapeDescription& shape : scene.shapes)
            if (const auto* mesh = std::get_if<MeshShape>(&shape.shape))
                taken_files_.insert(mesh->file);
            else if (const auto* voxels = std::get_if<VoxelsShape>(&shape.shape))
                taken_files_.insert(voxels->file);
        for (const Spring& spring : scene.springs) {
            for (const std::uint32_t end : {spring.a, spring.b}) {
                if (end == kNone) continue;
                if (end >= scene.bodies.size())
                    throw std::runtime_error(path.string()
                                             + ": springs: wanted springs between bodies; one of "
                                               "many instances has no name");
                named_ends_.insert(end);
            }
        }
    }

    void write()
    {
        const Scene standard;
        std::string text = "{\n  \"throng\": 1";
        if (!same_bits(scene_.gravity, standard.gravity))
            text += ",\n  \"gravity\": " + json_text(scene_.gravity);
        if (!same_bits(scene_.wind, standard.wind))
            text += ",\n  \"wind\": " + json_text(scene_.wind);
        const std::string settings = settings_text();
        if (settings != "{}") text += ",\n  \"settings\": " + settings;
        text += json_lines("materials", material_lines(), "{}");
        text += json_lines("pairs", pair_lines(), "[]");
        text += json_lines("shapes", shape_lines(), "{}");
        text += json_lines("bodies", body_lines(), "[]");
        text += json_lines("instances", instance_lines(), "[]");
        text += json_lines("springs", spring_lines(), "[]");
        text += json_lines("attractors", attractor_lines(), "[]");
        write_file(path_, text + "\n}\n");
    }

private:
    static void write_file(const std::filesystem::path& path, std::string_view bytes)
    {
        std::ofstream file(path, std::ios::binary);
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        file.close();
        if (!file) throw std::runtime_error(path.string() + ": cannot be written");
    }

    /// The name of a file beside the scene that no other part of the scene uses.
    std::string name_beside(const std::string& tail, const std::string& own)
    {
        std::string name = path_.stem().string() + tail;
        const std::string extension = std::filesystem::path(tail).extension().string();
        while (name != own && taken_files_.contains(name))
            name = std::filesystem::path(name).stem().string() + '_' + extension;
        taken_files_.insert(name);
        return name;
    }
    std::string
    write_beside(const std::string& tail, const std::string& own, std::string_view bytes)
    {
        std::string name = name_beside(tail, own);
        write_file(path_.parent_path() / name, bytes);
        return name;
    }

    std::string settings_text() const
    {
        JsonMembers members;
        const auto add = [&](std::string_view name) {
            const std::string value = dial_value(scene_.settings, name);
            // A fraction or a word goes in quotes.
            members.add(name, std::isnan(parse_number(value)) ? json_string(value) : value);
        };
        for (const std::string& name : scene_.dials_set)
            if (find_dial(name)) add(name);
        for (const Dial& dial : dials()) {
            const auto& set = scene_.dials_set;
            const bool done = std::find(set.begin(), set.end(), dial.name) != set.end();
            if (!done && dial.get(scene_.settings) != dial.default_value) add(dial.name);
        }
        return members.text();
    }

    std::vector<std::string> material_lines() const
    {
        std::vector<std::string> all;
        const Material standard;
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            const Material& material = scene_.materials[i];
            JsonMembers members;
            members.add("density", material.density, standard.density);
            members.add("friction", material.friction, standard.friction);
            members.add("restitution", material.restitution, standard.restitution);
            members.add("rolling_friction", material.rolling_friction, standard.rolling_friction);
            all.push_back(json_string(material_names_[i]) + ": " + members.text());
        }
        return all;
    }

    std::vector<std::string> pair_lines() const
    {
        std::vector<std::string> all;
        for (const MaterialPairDescription& pair : scene_.pairs) {
            JsonMembers members;
            members.add("materials",
                        '[' + json_string(material_names_[pair.a]) + ", "
                            + json_string(material_names_[pair.b]) + ']');
            if (pair.friction) members.add("friction", json_text(*pair.friction));
            if (pair.restitution) members.add("restitution", json_text(*pair.restitution));
            all.push_back(members.text());
        }
        return all;
    }

    // Shapes.

    std::vector<std::string> shape_lines()
    {
        std::vector<std::string> all;
        for (std::size_t i = 0; i < scene_.shapes.size(); ++i) {
            const std::string text = std::visit(
                [&](const auto& shape) { return shape_text(shape, i); }, scene_.shapes[i].shape);
            all.push_back(json_string(shape_names_[i]) + ": {" + text + '}');
        }
        return all;
    }

    static std::string shape_text(const SphereShape& sphere, std::size_t)
    {
        return "\"sphere\": {\"radius\": " + json_text(sphere.radius) + '}';
    }
    static std::string shape_text(const CapsuleShape& capsule, std::size_t)
    {
        return "\"capsule\": {\"radius\": " + json_text(capsule.radius)
            + ", \"half_length\": " + json_text(capsule.half_length) + '}';
    }
    static std::string shape_text(const CylinderShape& cylinder, std::size_t)
    {
        return "\"cylinder\": {\"radius\": " + json_text(cylinder.radius)
            + ", \"half_length\": " + json_text(cylinder.half_length) + '}';
    }
    static std::string shape_text(const BoxShape& box, std::size_t)
    {
        return "\"box\": {\"half_extents\": " + json_text(box.half_extents) + '}';
    }
    static std::string shape_text(const HullShape& hull, std::size_t)
    {
        std::string points;
        for (const Vec3& point : hull.points)
            points += (points.empty() ? "" : ", ") + json_text(point);
        return "\"hull\": {\"points\": [" + points + "]}";
    }
    static std::string shape_text(const PlaneShape& plane, std::size_t)
    {
        return "\"plane\": {\"normal\": " + json_text(plane.normal)
            + ", \"offset\": " + json_text(plane.offset) + '}';
    }
    std::string shape_text(const CompoundShape& compound, std::size_t) const
    {
        std::string parts;
        for (const CompoundShape::Part& part : compound.parts) {
            JsonMembers members;
            members.add("shape", json_string(shape_names_[part.shape]));
            members.add("position", part.pose.position, Pose{}.position);
            members.add("orientation", part.pose.orientation, Pose{}.orientation);
            parts += (parts.empty() ? "" : ", ") + members.text();
        }
        return "\"compound\": [" + parts + ']';
    }

    std::string shape_text(const MeshShape& mesh, std::size_t place)
    {
        JsonMembers members;
        if (holds(mesh)) {
            members.add("file", json_string(mesh.file));
            members.add("scale", mesh.scale, MeshShape{}.scale);
        } else {
            const std::string text = mesh_text({mesh.vertices, mesh.triangles});
            const std::string tail = '.' + std::to_string(place) + ".obj";
            members.add("file", json_string(write_beside(tail, mesh.file, text)));
        }
        if (!mesh.nonconvex.empty()) members.add("nonconvex", json_string(mesh.nonconvex));
        const auto add_dial = [&](std::string_view dial, double number) {
            members.add(dial, number, 0.0);
        };
        add_dial("voxel_size", mesh.voxel_size);
        add_dial("image_resolution", mesh.image_resolution);
        add_dial("sphere_levels", mesh.sphere_levels);
        add_dial("max_parts", mesh.max_parts);
        return "\"mesh\": " + members.text();
    }

    /// Whether the mesh's own file, seen from where the scene is written, says what it holds.
    bool holds(const MeshShape& mesh) const
    {
        if (mesh.file.empty()) return false;
        const FileContent content =
            read_file((path_.parent_path() / mesh.file).string(), ~std::uint64_t{0});
        if (!content.trouble.empty()) return false;
        try {
            MeshFile read = read_mesh_file(content.bytes, mesh.file);
            for (Vec3& vertex : read.vertices) vertex *= mesh.scale;
            return read.triangles == mesh.triangles
                && std::equal(read.vertices.begin(), read.vertices.end(), mesh.vertices.begin(),
                              mesh.vertices.end(),
                              [](const Vec3& a, const Vec3& b) { return same_bits(a, b); });
        } catch (const SceneError&) {
            return false;
        }
    }

    std::string shape_text(const VoxelsShape& voxels, std::size_t place)
    {
        std::string name = voxels.file;
        if (!holds(voxels)) {
            name = name_beside('.' + std::to_string(place) + ".vdb", voxels.file);
            const std::string trouble =
                write_level_set(*voxels.level_set, (path_.parent_path() / name).string());
            if (!trouble.empty()) throw std::runtime_error(trouble);
        }
        JsonMembers members;
        members.add("file", json_string(name));
        return "\"voxels\": " + members.text();
    }

    bool holds(const VoxelsShape& voxels) const
    {
        if (voxels.file.empty()) return false;
        FileContent content =
            read_file((path_.parent_path() / voxels.file).string(), ~std::uint64_t{0});
        if (!content.trouble.empty()) return false;
        const LevelSetResult read = read_level_set(std::move(content.bytes));
        return read.level_set != nullptr && same_level_set(*read.level_set, *voxels.level_set);
    }

    // Bodies.

    std::vector<std::string> body_lines()
    {
        std::vector<std::string> all;
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            const BodyDescription& body = scene_.bodies[i];
            const bool named =
                !body.name.empty() || named_ends_.contains(static_cast<std::uint32_t>(i));
            all.push_back(body_text(body, named ? body_names_[i] : ""));
        }
        for (const Instances& group : scene_.instances) {
            // Ids go by order: past the first group that stays one, all do.
            if (!group.file.empty() || group.own_sizes || group.count() > kMostInline) break;
            ++inlined_;
            for (std::size_t i = 0; i < group.count(); ++i) all.push_back(record_text(group, i));
        }
        return all;
    }

    std::string body_text(const BodyDescription& body, const std::string& name) const
    {
        const BodyDescription standard;
        JsonMembers members;
        if (!name.empty()) members.add("name", json_string(name));
        add_shared(body, members);
        members.add("position", body.position, standard.position);
        members.add("orientation", body.orientation, standard.orientation);
        members.add("velocity", body.velocity, standard.velocity);
        members.add("angular_velocity", body.angular_velocity, standard.angular_velocity);
        return members.text();
    }

    std::string record_text(const Instances& group, std::size_t place) const
    {
        const double* const r = &group.records[place * group.stride()];
        BodyDescription body = group.common;
        body.position = Vec3(r[0], r[1], r[2]);
        body.orientation = Quat(r[3], r[4], r[5], r[6]);
        body.velocity = Vec3(r[7], r[8], r[9]);
        body.angular_velocity = Vec3(r[10], r[11], r[12]);
        return body_text(body, "");
    }

    void add_shared(const BodyDescription& body, JsonMembers& members) const
    {
        const BodyDescription standard;
        members.add("shape", body.shape == kNone ? "null" : json_string(shape_names_[body.shape]));
        if (body.material != kNone)
            members.add("material", json_string(material_names_[body.material]));
        if (body.motion == Motion::static_) members.add("motion", "\"static\"");
        if (body.motion == Motion::kinematic) members.add("motion", "\"kinematic\"");
        if (body.mass) members.add("mass", json_text(*body.mass));
        if (body.inertia) {
            const Sym3& i = *body.inertia;
            members.add("inertia", json_text({i.xx, i.yy, i.zz, i.xy, i.xz, i.yz}));
        }
        if (body.center) members.add("center", json_text(*body.center));
        members.add("force", body.force, standard.force);
        members.add("torque", body.torque, standard.torque);
        JsonMembers drag;
        drag.add("linear", body.linear_drag, standard.linear_drag);
        drag.add("angular", body.angular_drag, standard.angular_drag);
        if (!drag.empty()) members.add("drag", drag.text());
        if (body.pivot) members.add("pivot", json_text(*body.pivot));
        const auto& drive = body.drive_velocity;
        const auto axis = [&](std::size_t i) { return drive[i] ? json_text(*drive[i]) : "null"; };
        if (drive[0] || drive[1] || drive[2])
            members.add("drive_velocity", '[' + axis(0) + ", " + axis(1) + ", " + axis(2) + ']');
        if (body.lock_rotation) members.add("lock_rotation", "true");
        if (body.lock_position) members.add("lock_position", "true");
        if (body.group != standard.group) members.add("group", std::to_string(body.group));
        if (body.mask != standard.mask) members.add("mask", std::to_string(body.mask));
        if (body.fast) members.add("fast", "true");
    }

    std::vector<std::string> instance_lines()
    {
        std::vector<std::string> all;
        for (std::size_t i = inlined_; i < scene_.instances.size(); ++i) {
            const Instances& group = scene_.instances[i];
            const std::string_view bytes(reinterpret_cast<const char*>(group.records.data()),
                                         group.records.size() * sizeof(double));
            JsonMembers members;
            add_shared(group.common, members);
            members.add("count", std::to_string(group.count()));
            if (group.own_sizes) members.add("sizes", "\"file\"");
            const std::string tail = '.' + std::to_string(i) + ".bin";
            members.add("file",
                        json_string(holds(group.file, bytes)
                                        ? group.file
                                        : write_beside(tail, group.file, bytes)));
            all.push_back(members.text());
        }
        return all;
    }

    bool holds(const std::string& file, std::string_view bytes) const
    {
        if (file.empty()) return false;
        const FileContent content =
            read_file((path_.parent_path() / file).string(), bytes.size() + 1);
        return content.trouble.empty() && content.bytes == bytes;
    }

    std::vector<std::string> spring_lines() const
    {
        const auto end = [&](std::uint32_t body) {
            return body == kNone ? "null" : json_string(body_names_[body]);
        };
        std::vector<std::string> all;
        const Spring standard;
        for (const Spring& spring : scene_.springs) {
            JsonMembers members;
            members.add("a", end(spring.a));
            members.add("b", end(spring.b));
            members.add("at_a", spring.at_a, standard.at_a);
            members.add("at_b", spring.at_b, standard.at_b);
            members.add("stiffness", json_text(spring.stiffness));
            members.add("damping", spring.damping, standard.damping);
            members.add("length", spring.length, standard.length);
            all.push_back(members.text());
        }
        return all;
    }

    std::vector<std::string> attractor_lines() const
    {
        std::vector<std::string> all;
        for (const Attractor& attractor : scene_.attractors) {
            JsonMembers members;
            members.add("position", attractor.position, Attractor{}.position);
            members.add("strength", json_text(attractor.strength));
            all.push_back(members.text());
        }
        return all;
    }

    const Scene& scene_;
    const std::filesystem::path path_;
    std::vector<std::string> shape_names_, material_names_, body_names_;
    std::set<std::uint32_t> named_ends_;  // bodies that springs refer to
    std::set<std::string> taken_files_;
    std::size_t inlined_ = 0;  // groups written as bodies
};

}  // namespace

void write_scene(const Scene& scene, const std::string& path)
{
    const std::string trouble = check_scene(scene);
    if (!trouble.empty()) throw std::runtime_error(path + ": " + trouble);
    SceneWriter(scene, path).write();
}

}  // namespace throng
