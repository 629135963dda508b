// Field: one key of a scene file, and the member of a scene that it stands for.
#pragma once

#include "throng/scene.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace throng {

/// What a number has to lie between, and the words for it: `a mass above 0 kg`. Without words, any.
struct Range {
    double least = 0, greatest = 0;
    std::string_view wanted{};
};

/// What has a name that others refer to.
enum class Named : std::uint8_t { shape, material, body };

/// One of them by its name, kept as its place in the scene.
template <class Object>
struct NameOf {
    std::uint32_t Object::*place;
    Named kind;
    bool or_null = false;  // null is kNone: no collision, or the world
};

/// 32 bits, as a whole number.
template <class Object>
struct Bits {
    std::uint32_t Object::*bits;
};

/// The value of a dial of the same name, for this object alone; 0 or empty for the scene's own.
template <class Object>
struct OfDial {
    std::variant<double Object::*, int Object::*, std::string Object::*> value;
};

template <class Object>
struct Field;

/// Some members under one key.
template <class Object>
struct Group {
    std::span<const Field<Object>> fields;
};

/// No single member: the reader and the writer know it. `schema` is its type.
struct ByHand {
    std::string_view schema;
};

template <class Object>
using Member = std::variant<double Object::*,
                            std::optional<double> Object::*,
                            Vec3 Object::*,
                            std::optional<Vec3> Object::*,
                            std::vector<Vec3> Object::*,
                            std::optional<Sym3> Object::*,
                            Quat Object::*,
                            bool Object::*,
                            std::uint64_t Object::*,
                            std::string Object::*,
                            Motion Object::*,
                            std::array<std::optional<double>, 3> Object::*,
                            NameOf<Object>,
                            Bits<Object>,
                            OfDial<Object>,
                            Group<Object>,
                            ByHand>;

/// What a field says, whatever object it is of.
struct FieldWords {
    std::string_view key;
    std::string_view unit;      // empty where it has none, or its parts have their own
    std::string_view meaning;   // of the schema and of docs/scene.md
    Range range;                // of its numbers
    std::string_view required;  // what is asked for where it is missing; empty: may be left out
    std::string_view left_out;  // what then holds, in words, where that is no plain value
};

template <class Object>
struct Field : FieldWords {
    constexpr Field(std::string_view key,
                    std::string_view unit,
                    std::string_view meaning,
                    Member<Object> of,
                    Range range = {},
                    std::string_view required = {},
                    std::string_view left_out = {})
        : FieldWords{key, unit, meaning, range, required, left_out}, member(of)
    { }

    Member<Object> member;
};

/// A table of them, beside an object that it is of.
template <class Object>
using Fields = std::type_identity_t<std::span<const Field<Object>>>;

}  // namespace throng
