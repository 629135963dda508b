// Scene reader: a scene file's text into a Scene.
//
// Here a value gets its type and a name its place; whether the whole makes sense is for
// scene_check.hpp to say, and its answer is then given the place it has in the text.
#include "scene/files/scene_reader.hpp"

#include "scene/files/json_reader.hpp"
#include "scene/files/mesh_file.hpp"
#include "scene/names.hpp"
#include "scene/shapes/level_set.hpp"
#include "throng/dials.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <unordered_map>

namespace throng {
namespace {

using Node = JsonDocument::Node;

constexpr std::string_view kSceneKeys[] = {"throng",  "gravity",    "settings",  "materials",
                                           "pairs",   "shapes",     "instances", "bodies",
                                           "springs", "attractors", "wind"};
constexpr std::string_view kMaterialKeys[] = {"density", "friction", "restitution",
                                              "rolling_friction"};
constexpr std::string_view kPairKeys[] = {"materials", "friction", "restitution"};
constexpr std::string_view kShapeKinds[] = {"sphere", "capsule", "cylinder", "box",   "hull",
                                            "plane",  "mesh",    "compound", "voxels"};
constexpr std::string_view kMeshKeys[] = {
    "file", "scale", "nonconvex", "voxel_size", "image_resolution", "sphere_levels", "max_parts"};
constexpr std::string_view kBodyKeys[] = {"shape",         "material",       "motion",
                                          "mass",          "inertia",        "center",
                                          "force",         "torque",         "drag",
                                          "pivot",         "drive_velocity", "lock_rotation",
                                          "lock_position", "group",          "mask",
                                          "fast",          "name",           "position",
                                          "orientation",   "velocity",       "angular_velocity"};
constexpr std::size_t kSharedBodyKeys = 16;  // the first of them, which instances have too
constexpr std::string_view kInstanceKeys[] = {"count", "file", "sizes"};
constexpr std::string_view kSpringKeys[] = {"a",         "b",       "at_a",  "at_b",
                                            "stiffness", "damping", "length"};

// Ids are 32 bits wide, and the last one means nobody.
constexpr double kMostBodies = 4294967294.0;

/// Reads one document; scene() is the answer.
class SceneReader : private JsonReader {
public:
    SceneReader(const JsonDocument& json, const std::string& folder, const FileReader& files)
        : JsonReader(json), folder_(folder), files_(files)
    { }

    Scene read()
    {
        const Node top = JsonDocument::kRoot;
        need_keys(top, kSceneKeys);
        constexpr std::string_view wanted = "1, the version of the format";
        const Node version = required(top, "throng", wanted);
        if (kind(version) != JsonKind::number || number(version) != 1)
            refuse_value(version, wanted);

        if (const Node at = find(top, "gravity")) scene_.gravity = vector(at);
        if (const Node at = find(top, "wind")) scene_.wind = vector(at);
        if (const Node at = find(top, "settings")) read_settings(at);
        if (const Node at = find(top, "materials")) read_materials(at);
        if (const Node at = find(top, "pairs")) each(at, [&](Node pair) { read_pair(pair); });
        if (const Node at = find(top, "shapes")) read_shapes(at);
        if (const Node at = find(top, "bodies")) {
            scene_.bodies.reserve(json_.size(need(at, JsonKind::array, "a list")));
            each(at, [&](Node body) { read_body(body); });
        }
        if (const Node at = find(top, "instances"))
            each(at, [&](Node group) { read_instances(group); });
        if (const Node at = find(top, "springs"))
            each(at, [&](Node spring) { read_spring(spring); });
        if (const Node at = find(top, "attractors"))
            each(at, [&](Node attractor) { read_attractor(attractor); });
        return std::move(scene_);
    }

private:
    using Names = std::unordered_map<std::string, std::uint32_t>;  // looked up, never walked

    template <class Named>
    std::uint32_t find_name(Node node,
                            const Names& names,
                            std::string_view what,
                            const std::vector<Named>& all) const
    {
        if (const auto found = names.find(std::string(text(node))); found != names.end())
            return found->second;
        std::vector<std::string_view> known;
        for (const Named& one : all)
            if (!one.name.empty()) known.push_back(one.name);
        refuse_name(node, what, known);
    }
    std::uint32_t find_shape(Node node) const
    {
        return find_name(node, shape_names_, "the name of a shape", scene_.shapes);
    }
    std::uint32_t find_material(Node node) const
    {
        return find_name(node, material_names_, "the name of a material", scene_.materials);
    }
    /// null is the world.
    std::uint32_t find_end(Node node) const
    {
        if (kind(node) == JsonKind::null) return kNone;
        if (kind(node) != JsonKind::string)
            refuse_value(node, "the name of a body, or null for the world");
        return find_name(node, body_names_, "the name of a body", scene_.bodies);
    }

    // The parts of a scene, in the order in which they need one another.

    void read_settings(Node settings)
    {
        std::vector<std::string_view> names;
        for (const Dial& dial : dials()) names.push_back(dial.name);
        need_keys(settings, names);
        each_member(settings, [&](Node key, Node value) {
            const Dial& dial = *find_dial(text(key));
            const std::string trouble = dial.set(scene_.settings, text_or_number(value));
            if (!trouble.empty()) refuse(value, trouble);
            scene_.dials_set.emplace_back(dial.name);
        });
    }

    void read_materials(Node materials)
    {
        each_member(materials, [&](Node key, Node value) {
            need_keys(value, kMaterialKeys);
            need_name(key);
            Material material;
            material.name = text(key);
            if (const Node at = find(value, "density")) material.density = number(at);
            if (const Node at = find(value, "friction")) material.friction = number(at);
            if (const Node at = find(value, "restitution")) material.restitution = number(at);
            if (const Node at = find(value, "rolling_friction"))
                material.rolling_friction = number(at);
            material_names_.emplace(material.name, scene_.materials.size());
            scene_.materials.push_back(std::move(material));
        });
    }

    void need_name(Node key) const
    {
        if (json_.text(key).empty()) refuse(key, "wanted a name of at least one letter");
    }

    void read_pair(Node node)
    {
        need_keys(node, kPairKeys);
        constexpr std::string_view wanted = "a list of two names of materials";
        const Node names = required(node, "materials", wanted);
        if (kind(names) != JsonKind::array || json_.size(names) != 2) refuse_value(names, wanted);
        MaterialPairDescription pair;
        pair.a = find_material(json_.first(names));
        pair.b = find_material(json_.next(json_.first(names)));
        if (const Node at = find(node, "friction")) pair.friction = number(at);
        if (const Node at = find(node, "restitution")) pair.restitution = number(at);
        scene_.pairs.push_back(pair);
    }

    void read_shapes(Node shapes)
    {
        // Names first: a compound may name what comes after it.
        each_member(shapes, [&](Node key, Node) {
            need_name(key);
            shape_names_.emplace(json_.text(key), scene_.shapes.size());
            scene_.shapes.push_back({std::string(json_.text(key)), {}});
        });
        std::size_t place = 0;
        each_member(shapes, [&](Node, Node value) { read_shape(value, scene_.shapes[place++]); });
    }

    void read_shape(Node node, ShapeDescription& out)
    {
        need_keys(node, kShapeKinds);
        if (json_.size(node) != 1)
            refuse(node, "wanted one kind of shape, one of " + either_of(kShapeKinds));
        const std::string_view name = text(json_.first(node));
        const Node at = json_.first(node) + 1;
        if (name == "sphere") {
            out.shape = SphereShape{length_of(at, kRadius, 0)};
        } else if (name == "capsule") {
            out.shape = CapsuleShape{length_of(at, kRound, 0), length_of(at, kRound, 1)};
        } else if (name == "cylinder") {
            out.shape = CylinderShape{length_of(at, kRound, 0), length_of(at, kRound, 1)};
        } else if (name == "box") {
            constexpr std::string_view keys[] = {"half_extents"};
            need_keys(at, keys);
            out.shape = BoxShape{vector(required(at, keys[0], "three lengths [x, y, z]"))};
        } else if (name == "hull") {
            constexpr std::string_view keys[] = {"points"};
            need_keys(at, keys);
            HullShape hull;
            each(required(at, keys[0], "a list of points"),
                 [&](Node point) { hull.points.push_back(vector(point)); });
            out.shape = std::move(hull);
        } else if (name == "plane") {
            constexpr std::string_view keys[] = {"normal", "offset"};
            need_keys(at, keys);
            PlaneShape plane;
            plane.normal = vector(required(at, keys[0], "a direction [x, y, z]"));
            if (const Node offset = find(at, keys[1])) plane.offset = number(offset);
            out.shape = plane;
        } else if (name == "mesh") {
            out.shape = read_mesh(at);
        } else if (name == "compound") {
            out.shape = read_compound(at);
        } else {
            out.shape = read_voxels(at);
        }
    }

    static constexpr std::string_view kRadius[] = {"radius"};
    static constexpr std::string_view kRound[] = {"radius", "half_length"};

    double length_of(Node object, Keys keys, std::size_t key) const
    {
        need_keys(object, keys);
        return number(required(object, keys[key], "a length in m"));
    }

    MeshShape read_mesh(Node node)
    {
        need_keys(node, kMeshKeys);
        const Node file = required(node, "file", "the name of an OBJ or STL file");
        MeshShape mesh;
        mesh.file = text(file);
        if (const Node at = find(node, "scale")) mesh.scale = number(at);
        // The dials of one shape take what the dials of the scene take.
        Settings own;
        for (const std::string_view dial : Keys(kMeshKeys).subspan(2)) {
            const Node at = find(node, dial);
            if (!at) continue;
            const std::string trouble = find_dial(dial)->set(own, text_or_number(at));
            if (!trouble.empty()) refuse(at, trouble);
            if (dial == "nonconvex") mesh.nonconvex = text(at);
        }
        mesh.voxel_size = own.voxel_size;
        mesh.image_resolution = own.image_resolution;
        mesh.sphere_levels = own.sphere_levels;
        mesh.max_parts = own.max_parts;
        const FileContent content = read_named(file, kGreatestMeshFile);
        if (content.size > kGreatestMeshFile) refuse(file, "wanted a mesh file of at most 4 GiB");
        MeshFile read = read_mesh_file(content.bytes, mesh.file);
        for (Vec3& vertex : read.vertices) vertex *= mesh.scale;
        mesh.vertices = std::move(read.vertices);
        mesh.triangles = std::move(read.triangles);
        return mesh;
    }

    VoxelsShape read_voxels(Node node)
    {
        constexpr std::string_view keys[] = {"file"};
        need_keys(node, keys);
        const Node file = required(node, keys[0], "the name of a .vdb file");
        VoxelsShape voxels;
        voxels.file = text(file);
        FileContent content = read_named(file, kGreatestMeshFile);
        if (content.size > kGreatestMeshFile) refuse(file, "wanted a .vdb file of at most 4 GiB");
        LevelSetResult read = read_level_set(std::move(content.bytes));
        if (!read.trouble.empty())
            refuse(file, "wanted a level set; " + in_quotes(voxels.file) + ' ' + read.trouble);
        voxels.level_set = std::move(read.level_set);
        return voxels;
    }

    CompoundShape read_compound(Node node)
    {
        constexpr std::string_view keys[] = {"shape", "position", "orientation"};
        CompoundShape compound;
        each(node, [&](Node at) {
            need_keys(at, keys);
            CompoundShape::Part part;
            part.shape = find_shape(required(at, keys[0], "the name of a shape"));
            if (const Node place = find(at, keys[1])) part.pose.position = vector(place);
            if (const Node turn = find(at, keys[2])) part.pose.orientation = quaternion(turn);
            compound.parts.push_back(part);
        });
        return compound;
    }

    void read_body(Node node)
    {
        need_keys(node, kBodyKeys);
        BodyDescription body = read_shared(node);
        if (const Node at = find(node, "name")) body.name = text(at);
        if (const Node at = find(node, "position")) body.position = vector(at);
        if (const Node at = find(node, "orientation")) body.orientation = quaternion(at);
        if (const Node at = find(node, "velocity")) body.velocity = vector(at);
        if (const Node at = find(node, "angular_velocity")) body.angular_velocity = vector(at);
        if (!body.name.empty()) body_names_.emplace(body.name, scene_.bodies.size());
        scene_.bodies.push_back(std::move(body));
    }

    /// What bodies and instances have in common.
    BodyDescription read_shared(Node node)
    {
        BodyDescription body;
        const Node shape = required(node, "shape", "the name of a shape, or null");
        if (kind(shape) != JsonKind::null) body.shape = find_shape(shape);
        if (const Node at = find(node, "material")) body.material = find_material(at);
        if (const Node at = find(node, "motion")) body.motion = motion(at);
        if (const Node at = find(node, "mass")) body.mass = number(at);
        if (const Node at = find(node, "inertia")) body.inertia = symmetric(at);
        if (const Node at = find(node, "center")) body.center = vector(at);
        if (const Node at = find(node, "force")) body.force = vector(at);
        if (const Node at = find(node, "torque")) body.torque = vector(at);
        if (const Node at = find(node, "drag")) read_drag(at, body);
        if (const Node at = find(node, "pivot")) body.pivot = vector(at);
        if (const Node at = find(node, "drive_velocity")) read_drive(at, body);
        if (const Node at = find(node, "lock_rotation")) body.lock_rotation = boolean(at);
        if (const Node at = find(node, "lock_position")) body.lock_position = boolean(at);
        if (const Node at = find(node, "group")) body.group = mask(at);
        if (const Node at = find(node, "mask")) body.mask = mask(at);
        if (const Node at = find(node, "fast")) body.fast = boolean(at);
        return body;
    }

    std::uint32_t mask(Node node) const
    {
        return static_cast<std::uint32_t>(whole(node, 4294967295.0));
    }

    Motion motion(Node node) const
    {
        const std::string_view name = kind(node) == JsonKind::string ? text(node) : "";
        if (name == "static") return Motion::static_;
        if (name == "kinematic") return Motion::kinematic;
        if (name != "dynamic") refuse_value(node, "static, kinematic or dynamic");
        return Motion::dynamic;
    }

    void read_drag(Node node, BodyDescription& body) const
    {
        constexpr std::string_view keys[] = {"linear", "angular"};
        need_keys(node, keys);
        if (const Node at = find(node, keys[0])) body.linear_drag = number(at);
        if (const Node at = find(node, keys[1])) body.angular_drag = number(at);
    }

    void read_drive(Node node, BodyDescription& body) const
    {
        if (kind(node) != JsonKind::array || json_.size(node) != 3)
            refuse_value(node, "three numbers or nulls [x, y, z]");
        std::size_t axis = 0;
        each(node, [&](Node at) {
            std::optional<double>& speed = body.drive_velocity[axis++];
            if (kind(at) == JsonKind::null) return;
            speed = json_.number(need(at, JsonKind::number, "a number or null"));
        });
    }

    void read_instances(Node node)
    {
        need_keys(node, Keys(kBodyKeys).first(kSharedBodyKeys), kInstanceKeys);
        Instances group;
        group.common = read_shared(node);
        if (const Node at = find(node, "sizes")) {
            if (kind(at) != JsonKind::string || json_.text(at) != "file")
                refuse_value(at, "\"file\"");
            group.own_sizes = true;
        }
        const Node file = required(node, "file", "the name of a file of records");
        group.file = text(file);

        const std::uint64_t record = group.stride() * sizeof(double);
        const Node count = find(node, "count");
        const double most = kMostBodies - static_cast<double>(scene_.body_count());
        const auto bodies = static_cast<std::uint64_t>(count ? whole(count, most) : most);
        const FileContent content = read_named(file, bodies * record);
        const bool fits = count ? content.size == bodies * record
                                : content.size % record == 0 && content.size / record <= bodies;
        if (!fits)
            refuse(file,
                   "wanted "
                       + (count ? std::to_string(bodies * record) + " bytes, "
                                  + std::to_string(bodies) + " records"
                                : std::string("whole records"))
                       + " of " + std::to_string(record) + " bytes, not "
                       + std::to_string(content.size) + " bytes in " + in_quotes(group.file));
        static_assert(std::endian::native == std::endian::little, "bulk files are little-endian");
        group.records.resize(content.bytes.size() / sizeof(double));
        if (!group.records.empty())
            std::memcpy(group.records.data(), content.bytes.data(), content.bytes.size());
        scene_.instances.push_back(std::move(group));
    }

    /// The content of a file that the scene names.
    FileContent read_named(Node file, std::uint64_t limit) const
    {
        const std::string name(text(file));
        if (name.empty() || name.find('\0') != name.npos)
            refuse(file, "wanted the name of a file, not " + in_quotes(name));
        FileContent content = files_((std::filesystem::path(folder_) / name).string(), limit);
        if (!content.trouble.empty())
            refuse(file,
                   "wanted a file that can be read, not " + in_quotes(name) + " (" + content.trouble
                       + ")");
        return content;
    }

    void read_spring(Node node)
    {
        need_keys(node, kSpringKeys);
        constexpr std::string_view end = "the name of a body, or null for the world";
        Spring spring;
        spring.a = find_end(required(node, "a", end));
        spring.b = find_end(required(node, "b", end));
        if (const Node at = find(node, "at_a")) spring.at_a = vector(at);
        if (const Node at = find(node, "at_b")) spring.at_b = vector(at);
        spring.stiffness = number(required(node, "stiffness", "a stiffness in N/m"));
        if (const Node at = find(node, "damping")) spring.damping = number(at);
        if (const Node at = find(node, "length")) spring.length = number(at);
        scene_.springs.push_back(spring);
    }

    void read_attractor(Node node)
    {
        constexpr std::string_view keys[] = {"position", "strength"};
        need_keys(node, keys);
        Attractor attractor;
        if (const Node at = find(node, keys[0])) attractor.position = vector(at);
        attractor.strength = number(required(node, keys[1], "a strength"));
        scene_.attractors.push_back(attractor);
    }

    const std::string& folder_;
    const FileReader& files_;
    Scene scene_;
    Names material_names_, shape_names_, body_names_;
};

}  // namespace

Scene scene_of(const JsonDocument& json, const std::string& folder, const FileReader& files)
{
    return SceneReader(json, folder, files).read();
}

}  // namespace throng
