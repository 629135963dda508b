// Scene reader: a scene file's text into a Scene.
//
// Here a value gets its type and a name its place; whether the whole makes sense is for
// scene_check.hpp to say, and its answer is then given the place it has in the text.
#include "scene/files/scene_reader.hpp"

#include "scene/bound_field.hpp"
#include "scene/files/json_reader.hpp"
#include "scene/files/mesh_file.hpp"
#include "scene/names.hpp"
#include "scene/shapes/level_set.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <unordered_map>

namespace throng {
namespace {

using Node = JsonDocument::Node;

/// The keys of some tables together.
template <const auto&... tables>
constexpr auto kKeysOf = [] {
    std::array<std::string_view, (std::size(tables) + ...)> keys;
    std::size_t count = 0;
    const auto take = [&](const auto& table) {
        for (const auto& field : table) keys[count++] = field.key;
    };
    (take(tables), ...);
    return keys;
}();

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
        need_keys(top, kKeysOf<kSceneFields>);
        // First: of another version nothing else is known.
        const std::string_view wanted = kSceneFields[0].required;
        const Node version = required(top, kSceneFields[0].key, wanted);
        if (kind(version) != JsonKind::number || number(version) != 1)
            refuse_value(version, wanted);

        read_fields(top, kSceneFields, scene_);
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
            each(at, [&](Node spring) {
                read_object(spring, kSpringFields, scene_.springs.emplace_back());
            });
        if (const Node at = find(top, "attractors"))
            each(at, [&](Node attractor) {
                read_object(attractor, kAttractorFields, scene_.attractors.emplace_back());
            });
        return std::move(scene_);
    }

private:
    using Names = std::unordered_map<std::string, std::uint32_t>;  // looked up, never walked

    template <class Listed>
    std::uint32_t find_name(Node node,
                            const Names& names,
                            std::string_view what,
                            const std::vector<Listed>& all) const
    {
        if (const auto found = names.find(std::string(text(node))); found != names.end())
            return found->second;
        std::vector<std::string_view> known;
        for (const Listed& one : all)
            if (!one.name.empty()) known.push_back(one.name);
        refuse_name(node, what, known);
    }
    std::uint32_t find_named(Node node, Named kind) const
    {
        switch (kind) {
        case Named::shape:
            return find_name(node, shape_names_, "the name of a shape", scene_.shapes);
        case Named::material:
            return find_name(node, material_names_, "the name of a material", scene_.materials);
        case Named::body:
            return find_name(node, body_names_, "the name of a body", scene_.bodies);
        }
        return kNone;
    }

    // Members of an object by their fields.

    void read_fields(Node node, const WritableFields& fields) const
    {
        for (const auto& [words, place] : fields) {
            const Node at = words->required.empty() ? find(node, words->key)
                                                    : required(node, words->key, words->required);
            if (!at) continue;
            std::visit([&, words = words](const auto& kept) { read_member(at, *words, kept); },
                       place);
        }
    }
    template <class Object>
    void read_fields(Node node, Fields<Object> fields, Object& object) const
    {
        read_fields(node, writable(object, fields));
    }
    /// The same where no other key may be there.
    void read_object(Node node, const WritableFields& fields) const
    {
        std::vector<std::string_view> keys;
        for (const auto& field : fields) keys.push_back(field.words->key);
        need_keys(node, keys);
        read_fields(node, fields);
    }
    template <class Object>
    void read_object(Node node, Fields<Object> fields, Object& object) const
    {
        read_object(node, writable(object, fields));
    }

    template <class Value>
    void read_member(Node at, const FieldWords&, Value* kept) const
    {
        read_value(at, *kept);
    }
    void read_member(Node at, const FieldWords& words, const WritableName& name) const
    {
        if (name.or_null && kind(at) == JsonKind::null) return;
        if (name.or_null && kind(at) != JsonKind::string) refuse_value(at, words.required);
        *name.place = find_named(at, name.kind);
    }
    void read_member(Node at, const FieldWords&, const WritableBits& bits) const
    {
        *bits.bits = static_cast<std::uint32_t>(whole(at, 4294967295.0));
    }
    void read_member(Node at, const FieldWords& words, const WritableDial& dial) const
    {
        Settings own;
        const std::string trouble = find_dial(words.key)->set(own, text_or_number(at));
        if (!trouble.empty()) refuse(at, trouble);
        const std::string value = dial_value(own, words.key);
        const double number = parse_number(value);  // of auto none: it stays 0
        if (auto* const* const text = std::get_if<std::string*>(&dial)) {
            **text = value;
        } else if (!std::isnan(number)) {
            if (auto* const* const whole = std::get_if<int*>(&dial))
                **whole = static_cast<int>(number);
            else
                *std::get<double*>(dial) = number;
        }
    }
    void read_member(Node at, const FieldWords&, const WritableFields& group) const
    {
        read_object(at, group);
    }
    void read_member(Node, const FieldWords&, ByHand) const { }

    void read_value(Node at, double& value) const { value = number(at); }
    void read_value(Node at, Vec3& value) const { value = vector(at); }
    void read_value(Node at, Quat& value) const { value = quaternion(at); }
    void read_value(Node at, Sym3& value) const { value = symmetric(at); }
    void read_value(Node at, bool& value) const { value = boolean(at); }
    void read_value(Node at, std::uint64_t& value) const
    {
        value = static_cast<std::uint64_t>(whole(at, kGreatestWhole));
    }
    void read_value(Node at, std::string& value) const { value = text(at); }
    template <class Value>
    void read_value(Node at, std::optional<Value>& value) const
    {
        read_value(at, value.emplace());
    }
    void read_value(Node at, std::vector<Vec3>& places) const
    {
        each(at, [&](Node place) { places.push_back(vector(place)); });
    }
    void read_value(Node at, std::array<std::optional<double>, 3>& axes) const
    {
        if (kind(at) != JsonKind::array || json_.size(at) != 3)
            refuse_value(at, "three numbers or nulls [x, y, z]");
        std::size_t axis = 0;
        each(at, [&](Node one) {
            std::optional<double>& value = axes[axis++];
            if (kind(one) == JsonKind::null) return;
            value = json_.number(need(one, JsonKind::number, "a number or null"));
        });
    }
    void read_value(Node at, Motion& motion) const
    {
        const std::string_view name = kind(at) == JsonKind::string ? text(at) : "";
        const auto* const found = std::find(std::begin(kMotions), std::end(kMotions), name);
        if (found == std::end(kMotions)) refuse_value(at, either_of(kMotions));
        motion = static_cast<Motion>(found - std::begin(kMotions));
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
            need_name(key);
            Material material;
            material.name = text(key);
            read_object(value, kMaterialFields, material);
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
        MaterialPairDescription pair;
        read_object(node, kPairFields, pair);
        const Node names = find(node, "materials");
        if (kind(names) != JsonKind::array || json_.size(names) != 2)
            refuse_value(names, kPairFields[0].required);
        pair.a = find_named(json_.first(names), Named::material);
        pair.b = find_named(json_.next(json_.first(names)), Named::material);
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
        std::vector<std::string_view> kinds;
        for (const ShapeName& kind : kShapeNames) kinds.push_back(kind.name);
        need_keys(node, kinds);
        if (json_.size(node) != 1)
            refuse(node, "wanted one kind of shape, one of " + either_of(kinds));
        const auto kind = std::find(kinds.begin(), kinds.end(), text(json_.first(node)));
        set_kind(static_cast<std::size_t>(kind - kinds.begin()), out.shape);
        const Node at = json_.first(node) + 1;
        std::visit([&](auto& shape) { read_stated(at, shape); }, out.shape);
    }

    /// The default of the kind of shape at a place of the list of kinds.
    template <class... Shapes>
    static void set_kind(std::size_t place, std::variant<Shapes...>& out)
    {
        const std::variant<Shapes...> kinds[] = {Shapes{}...};
        out = kinds[place];
    }

    template <class Shape>
    void read_stated(Node node, Shape& shape) const
    {
        read_object(node, fields_of(shape), shape);
        read_file_of(node, shape);
    }
    template <class Shape>
    void read_file_of(Node, Shape&) const
    { }

    void read_file_of(Node node, MeshShape& mesh) const
    {
        const Node file = find(node, "file");
        const FileContent content = read_named(file, kGreatestMeshFile);
        if (content.size > kGreatestMeshFile) refuse(file, "wanted a mesh file of at most 4 GiB");
        MeshFile read = read_mesh_file(content.bytes, mesh.file);
        for (Vec3& vertex : read.vertices) vertex *= mesh.scale;
        mesh.vertices = std::move(read.vertices);
        mesh.triangles = std::move(read.triangles);
    }

    void read_file_of(Node node, VoxelsShape& voxels) const
    {
        const Node file = find(node, "file");
        FileContent content = read_named(file, kGreatestMeshFile);
        if (content.size > kGreatestMeshFile) refuse(file, "wanted a .vdb file of at most 4 GiB");
        LevelSetResult read = read_level_set(std::move(content.bytes));
        if (!read.trouble.empty())
            refuse(file, "wanted a level set; " + in_quotes(voxels.file) + ' ' + read.trouble);
        voxels.level_set = std::move(read.level_set);
    }

    void read_stated(Node node, CompoundShape& compound) const
    {
        each(node, [&](Node at) {
            need_keys(at, kKeysOf<kPartFields, kPoseFields>);
            CompoundShape::Part& part = compound.parts.emplace_back();
            read_fields(at, kPartFields, part);
            read_fields(at, kPoseFields, part.pose);
        });
    }

    void read_body(Node node)
    {
        need_keys(node, kKeysOf<kBodyFields, kOwnBodyFields>);
        BodyDescription body;
        read_fields(node, kBodyFields, body);
        read_fields(node, kOwnBodyFields, body);
        if (!body.name.empty()) body_names_.emplace(body.name, scene_.bodies.size());
        scene_.bodies.push_back(std::move(body));
    }

    void read_instances(Node node)
    {
        need_keys(node, kKeysOf<kBodyFields, kInstancesFields>);
        Instances group;
        read_fields(node, kBodyFields, group.common);
        read_fields(node, kInstancesFields, group);
        if (const Node at = find(node, "sizes")) {
            if (kind(at) != JsonKind::string || json_.text(at) != "file")
                refuse_value(at, "\"file\"");
            group.own_sizes = true;
        }
        const Node file = find(node, "file");
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
