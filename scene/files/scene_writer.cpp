// Scene writer: a Scene into a scene file's text, and the files that belong to it.
//
// What is at its default is left out. "At its default" is asked of the bits, so that even a zero
// keeps its sign on the way through a file.
#include "scene/bound_field.hpp"
#include "scene/files/json.hpp"
#include "scene/files/json_writer.hpp"
#include "scene/files/mesh_file.hpp"
#include "scene/names.hpp"
#include "scene/rules/scene_check.hpp"
#include "scene/shapes/level_set.hpp"
#include "throng/dials.hpp"
#include "throng/scene_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

namespace throng {
namespace {

/// A group of at most this many is as easily read as bodies.
constexpr std::size_t kMostInline = 1000;

/// Names for those that have none, unlike those that have: others refer to them by name.
template <class Listed>
std::vector<std::string> names_of(const std::vector<Listed>& all, std::string_view kind)
{
    std::set<std::string_view> taken;
    for (const Listed& one : all) taken.insert(one.name);
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

/// The same to the last bit, the sign of a zero included.
bool same_bits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same_bits(const Vec3& a, const Vec3& b)
{
    return same_bits(a.x(), b.x()) && same_bits(a.y(), b.y()) && same_bits(a.z(), b.z());
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
        std::string text = "{\n  \"throng\": 1";
        for (const auto& [key, value] : stated(scene_, Fields<Scene>(kSceneFields)))
            text += ",\n  " + json_string(key) + ": " + value;
        const std::string settings = settings_text();
        if (settings != "{}") text += ",\n  \"settings\": " + settings;
        text += json_lines("materials", material_lines(), "{}");
        text += json_lines("pairs", pair_lines(), "[]");
        text += json_lines("shapes", shape_lines(), "{}");
        text += json_lines("bodies", body_lines(), "[]");
        text += json_lines("instances", instance_lines(), "[]");
        text += json_lines("springs", lines_of(scene_.springs, kSpringFields), "[]");
        text += json_lines("attractors", lines_of(scene_.attractors, kAttractorFields), "[]");
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

    // Members of an object by their fields. A text is empty where there is nothing to state.

    using Member = std::pair<std::string_view, std::string>;

    /// What is stated of `fields`: all but what is as it is in `standard`, the same fields of an
    /// object of which nothing was said.
    std::vector<Member> stated(const BoundFields& fields, const BoundFields& standard) const
    {
        std::vector<Member> stated;
        for (std::size_t i = 0; i < fields.size(); ++i)
            if (std::string text = text_of(fields[i], standard[i]); !text.empty())
                stated.emplace_back(fields[i].words->key, std::move(text));
        return stated;
    }
    template <class Object>
    std::vector<Member> stated(const Object& object, Fields<Object> fields) const
    {
        const Object standard;
        return stated(bound(object, fields), bound(standard, fields));
    }
    template <class Object>
    void add_stated(const Object& object, Fields<Object> fields, JsonMembers& members) const
    {
        for (const auto& [key, text] : stated(object, fields)) members.add(key, text);
    }
    std::string text_of(const BoundField& field, const BoundField& standard) const
    {
        if (const auto* const group = std::get_if<BoundFields>(&field.place)) {
            JsonMembers members;
            for (const auto& [key, text] : stated(*group, std::get<BoundFields>(standard.place)))
                members.add(key, text);
            return members.empty() ? "" : members.text();
        }
        const auto text_at = [&](const BoundField& one) {
            return std::visit([&](const auto& kept) { return member_text(kept); }, one.place);
        };
        std::string text = text_at(field);
        return field.words->required.empty() && text == text_at(standard) ? "" : text;
    }

    template <class Value>
    std::string member_text(const Value* kept) const
    {
        return json_text(*kept);
    }
    template <class Value>
    std::string member_text(const std::optional<Value>* kept) const
    {
        return *kept ? json_text(**kept) : std::string();
    }
    std::string member_text(const BoundName& name) const
    {
        if (*name.place == kNone) return name.or_null ? "null" : "";
        switch (name.kind) {
        case Named::shape:
            return json_string(shape_names_[*name.place]);
        case Named::material:
            return json_string(material_names_[*name.place]);
        case Named::body:
            return json_string(body_names_[*name.place]);
        }
        return {};
    }
    std::string member_text(const BoundBits& bits) const { return std::to_string(*bits.bits); }
    std::string member_text(const BoundDial& dial) const
    {
        return std::visit([&](const auto* kept) { return own_text(*kept); }, dial);
    }
    static std::string own_text(double number) { return number == 0 ? "" : json_text(number); }
    static std::string own_text(const std::string& text)
    {
        return text.empty() ? "" : json_string(text);
    }
    std::string member_text(const BoundFields&) const { return {}; }  // text_of() knows them
    std::string member_text(ByHand) const { return {}; }

    std::string settings_text() const
    {
        JsonMembers members;
        const auto add = [&](std::string_view name) {
            members.add(name, json_dial_value(dial_value(scene_.settings, name)));
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
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            JsonMembers members;
            add_stated(scene_.materials[i], kMaterialFields, members);
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
            add_stated(pair, kPairFields, members);
            all.push_back(members.text());
        }
        return all;
    }

    // Shapes.

    std::vector<std::string> shape_lines()
    {
        std::vector<std::string> all;
        for (std::size_t i = 0; i < scene_.shapes.size(); ++i) {
            const ShapeDescription& shape = scene_.shapes[i];
            const std::string text =
                std::visit([&](const auto& stated) { return shape_text(stated, i); }, shape.shape);
            JsonMembers members;
            members.add(kShapeNames[shape.shape.index()].name, text);
            all.push_back(json_string(shape_names_[i]) + ": " + members.text());
        }
        return all;
    }

    template <class Shape>
    std::string shape_text(const Shape& shape, std::size_t) const
    {
        JsonMembers members;
        add_stated(shape, fields_of(shape), members);
        return members.text();
    }
    std::string shape_text(const CompoundShape& compound, std::size_t) const
    {
        std::string parts;
        for (const CompoundShape::Part& part : compound.parts) {
            JsonMembers members;
            add_stated(part, kPartFields, members);
            add_stated(part.pose, kPoseFields, members);
            parts += (parts.empty() ? "" : ", ") + members.text();
        }
        return '[' + parts + ']';
    }

    std::string shape_text(const MeshShape& mesh, std::size_t place)
    {
        if (holds(mesh)) return shape_text<MeshShape>(mesh, place);
        const std::string text = mesh_text({mesh.vertices, mesh.triangles});
        const std::string tail = '.' + std::to_string(place) + ".obj";
        JsonMembers members;
        members.add_text("file", write_beside(tail, mesh.file, text));
        add_stated(mesh, std::span(kMeshFields).subspan(2), members);  // its dials
        return members.text();
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
        return members.text();
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
        JsonMembers members;
        if (!name.empty()) members.add("name", json_string(name));
        add_stated(body, kBodyFields, members);
        add_stated(body, std::span(kOwnBodyFields).subspan(1), members);  // but for the name
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

    std::vector<std::string> instance_lines()
    {
        std::vector<std::string> all;
        for (std::size_t i = inlined_; i < scene_.instances.size(); ++i) {
            const Instances& group = scene_.instances[i];
            const std::string_view bytes(reinterpret_cast<const char*>(group.records.data()),
                                         group.records.size() * sizeof(double));
            JsonMembers members;
            add_stated(group.common, kBodyFields, members);
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

    template <class Object>
    std::vector<std::string> lines_of(const std::vector<Object>& objects,
                                      Fields<Object> fields) const
    {
        std::vector<std::string> all;
        for (const Object& object : objects) {
            JsonMembers members;
            add_stated(object, fields, members);
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
