#include "scene/files/scene_schema.hpp"

#include "scene/bound_field.hpp"
#include "scene/files/json.hpp"
#include "scene/files/json_writer.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"

namespace throng {
namespace {

constexpr std::string_view kAbout =
    "A scene of rigid bodies. SI units, radians, quaternions [w, x, y, z] that turn body axes into "
    "world axes. Files named in a scene are found relative to it. Beyond this schema: keys are "
    "given once, numbers fit a double, names refer to what exists, hulls enclose a volume, moments "
    "of inertia belong to some body, and nesting is at most 64 levels. Of each key `unit` says in "
    "what it is counted, `default` what it is where it is left out, and `leftOut` the same in "
    "words; of a dial `values` says what may be set.";

// Types, each as members of an object.

std::string reference(std::string_view name)
{
    return "\"$ref\": \"#/$defs/" + std::string(name) + '"';
}

std::string type(std::string_view name) { return "\"type\": \"" + std::string(name) + '"'; }

std::string list_of(const std::string& items, std::size_t count)
{
    const std::string number = std::to_string(count);
    return type("array") + ", \"items\": {" + items + "}, \"minItems\": " + number
        + ", \"maxItems\": " + number;
}

/// One item more.
void add(std::string& list, const std::string& item, const std::string& between = ", ")
{
    if (!list.empty()) list += between;
    list += item;
}

/// Limits of nature; those of the step are not told.
std::string number_type(const Range& range)
{
    std::string text = type("number");
    if (range.wanted.empty()) return text;
    if (range.least == 0) text += ", \"minimum\": 0";
    if (range.least > 0) text += ", \"exclusiveMinimum\": 0";
    if (range.greatest < kGreatestLength) text += ", \"maximum\": " + number_text(range.greatest);
    return text;
}

std::string member_of(const BoundField& field);

/// The type of what a member of a scene holds.
struct TypeOf {
    const FieldWords& words;

    std::string operator()(const double*) const { return number_type(words.range); }
    std::string operator()(const std::optional<double>*) const { return number_type(words.range); }
    std::string operator()(const Vec3*) const
    {
        return words.range.least > 0 ? list_of(number_type(words.range), 3) : reference("vector");
    }
    std::string operator()(const std::optional<Vec3>*) const { return reference("vector"); }
    std::string operator()(const std::vector<Vec3>*) const
    {
        return type("array") + ", \"items\": {" + reference("vector") + "}, \"minItems\": 4";
    }
    std::string operator()(const std::optional<Sym3>*) const { return list_of(type("number"), 6); }
    std::string operator()(const Quat*) const { return reference("quaternion"); }
    std::string operator()(const bool*) const { return type("boolean"); }
    std::string operator()(const std::uint64_t*) const
    {
        return type("integer") + ", \"minimum\": 0, \"maximum\": 9007199254740992";
    }
    std::string operator()(const std::string*) const
    {
        return type("string") + (words.required.empty() ? "" : ", \"minLength\": 1");
    }
    std::string operator()(const Motion*) const
    {
        std::string names;
        for (const std::string_view motion : kMotions) add(names, json_string(motion));
        return "\"enum\": [" + names + ']';
    }
    std::string operator()(const std::array<std::optional<double>, 3>*) const
    {
        return list_of(R"("type": ["number", "null"])", 3);
    }
    std::string operator()(const BoundName& name) const
    {
        return name.or_null ? R"("type": ["string", "null"])" : type("string");
    }
    std::string operator()(const BoundBits&) const { return reference("bits"); }
    std::string operator()(const BoundDial&) const
    {
        return reference("settings/properties/" + std::string(words.key));
    }
    std::string operator()(const BoundFields& group) const
    {
        std::string properties;
        for (const BoundField& one : group) add(properties, member_of(one));
        return type("object") + ", \"additionalProperties\": false, \"properties\": {" + properties
            + '}';
    }
    std::string operator()(ByHand by_hand) const { return std::string(by_hand.schema); }
};

/// What a member is where the file does not say, as JSON; empty where that is no value.
struct DefaultOf {
    template <class Value>
    std::string operator()(const Value* standard) const
    {
        return json_text(*standard);
    }
    template <class Value>
    std::string operator()(const std::optional<Value>*) const
    {
        return {};
    }
    std::string operator()(const BoundBits& bits) const { return std::to_string(*bits.bits); }
    template <class Other>
    std::string operator()(const Other&) const
    {
        return {};
    }
};

/// The key and all that is to be said of it; the field is bound to what nothing was said of.
std::string member_of(const BoundField& field)
{
    const FieldWords& words = *field.words;
    std::string text = json_string(words.key) + ": {" + std::visit(TypeOf{words}, field.place)
        + ", \"description\": " + json_string(words.meaning);
    if (!words.unit.empty()) text += ", \"unit\": " + json_string(words.unit);
    if (!words.left_out.empty()) text += ", \"leftOut\": " + json_string(words.left_out);
    const std::string standard = std::visit(DefaultOf{}, field.place);
    if (words.required.empty() && words.left_out.empty() && !standard.empty())
        text += ", \"default\": " + standard;
    return text + '}';
}

/// Members of an object type, put together a line at a time.
class ObjectType {
public:
    ObjectType(std::string_view description, const std::string& indent) : indent_(indent)
    {
        if (!description.empty()) say("\"description\": " + json_string(description));
    }
    ObjectType& say(const std::string& member)
    {
        add(text_, indent_ + "  " + member, ",\n");
        return *this;
    }
    ObjectType& has(const BoundFields& fields)
    {
        for (const BoundField& field : fields) {
            property(member_of(field));
            const FieldWords& words = *field.words;
            if (!words.required.empty()) add(required_, json_string(words.key));
        }
        return *this;
    }
    template <class Object, std::size_t count>
    ObjectType& has(const Field<Object> (&fields)[count])
    {
        const Object standard{};
        return has(bound(standard, Fields<Object>(fields)));
    }
    ObjectType& property(const std::string& member)
    {
        add(properties_, indent_ + "    " + member, ",\n");
        return *this;
    }
    /// `closed`: other keys are refused here, and not by what refers to it.
    std::string text(bool closed = true)
    {
        if (!required_.empty()) say("\"required\": [" + required_ + ']');
        if (closed) say("\"additionalProperties\": false");
        say("\"properties\": {\n" + properties_ + '\n' + indent_ + "  }");
        return "{\n" + text_ + '\n' + indent_ + '}';
    }

private:
    std::string indent_, text_, required_, properties_;
};

template <class Object, std::size_t count>
std::string object_of(const Field<Object> (&fields)[count], const std::string& indent)
{
    return ObjectType("", indent).say(type("object")).has(fields).text();
}

template <class... Shapes>
std::string shape_types(const std::variant<Shapes...>&, const std::string& indent)
{
    ObjectType shape("", indent);
    shape.say(type("object")).say("\"minProperties\": 1").say("\"maxProperties\": 1");
    std::size_t place = 0;
    const auto add_kind = [&](const auto& stated) {
        const ShapeName& kind = kShapeNames[place++];
        std::string text;
        if constexpr (std::is_same_v<decltype(stated), const CompoundShape&>)
            text = "{\"description\": " + json_string(kind.meaning) + ", " + type("array")
                + ", \"minItems\": 1, \"items\": {" + reference("part") + "}}";
        else
            text = ObjectType(kind.meaning, indent + "    ")
                       .say(type("object"))
                       .has(bound(stated, fields_of(stated)))
                       .text();
        shape.property(json_string(kind.name) + ": " + text);
    };
    (add_kind(Shapes{}), ...);
    return shape.text();
}

std::string dial_types(const std::string& indent)
{
    ObjectType settings("Dials: what trades accuracy for time. Values that a build does not offer "
                        "are refused by name.",
                        indent);
    settings.say(type("object"));
    for (const Dial& dial : dials()) {
        std::string choices;
        for (const Choice& choice : dial.choices) add(choices, json_string(choice.text));
        std::string text = json_string(dial.name) + ": {";
        text += choices.empty() ? R"("type": ["number", "string"])" : "\"enum\": [" + choices + ']';
        text += ", \"description\": " + json_string(dial.trades);
        if (choices.empty()) text += ", \"values\": " + json_string(dial.values);
        if (!dial.unit.empty()) text += ", \"unit\": " + json_string(dial.unit);
        text += ", \"default\": " + json_dial_value(dial.default_value);
        settings.property(text + '}');
    }
    return settings.text();
}

}  // namespace

std::string scene_schema()
{
    ObjectType scene("", "");
    scene.say(R"("$schema": "https://json-schema.org/draft/2020-12/schema")")
        .say("\"title\": \"throng scene\"")
        .say("\"description\": " + json_string(kAbout))
        .say(type("object"))
        .has(kSceneFields);

    const std::string in = "    ";
    ObjectType body("", in), instances("", in), part("", in),
        shared("What a body states, and what all of a group of instances share.", in);
    shared.say(type("object")).has(kBodyFields);
    body.say(reference("shared")).has(kOwnBodyFields).say("\"unevaluatedProperties\": false");
    instances.say(reference("shared"))
        .has(kInstancesFields)
        .say("\"unevaluatedProperties\": false");
    part.say(type("object")).has(kPartFields).has(kPoseFields);

    std::string types;
    const auto define = [&](std::string_view name, const std::string& text) {
        add(types, in + json_string(name) + ": " + text, ",\n");
    };
    define("vector", "{\"description\": \"[x, y, z]\", " + list_of(type("number"), 3) + '}');
    define("quaternion",
           "{\"description\": \"[w, x, y, z], within 1e-6 of unit length\", "
               + list_of(type("number"), 4) + '}');
    define(
        "bits",
        R"({"description": "32 bits as a whole number", "type": "integer", "minimum": 0, "maximum": 4294967295})");
    define("material", object_of(kMaterialFields, in));
    define("pair", object_of(kPairFields, in));
    define("shape", shape_types(ShapeDescription{}.shape, in));
    define("part", part.text());
    define("shared", shared.text(false));
    define("body", body.text(false));
    define("instances", instances.text(false));
    define("spring", object_of(kSpringFields, in));
    define("attractor", object_of(kAttractorFields, in));
    define("settings", dial_types(in));
    scene.say("\"$defs\": {\n" + types + "\n  }");
    return scene.text() + '\n';
}

}  // namespace throng
