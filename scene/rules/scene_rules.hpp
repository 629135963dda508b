// Scene rules: the parts of the scene check, and what refuses a part of a scene.
#pragma once

#include "kernels/geometry/mass.hpp"
#include "scene/bound_field.hpp"
#include "scene/rules/scene_check.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace throng {

/// A part of a scene, and a way to refuse it: throws SceneTrouble.
///
/// Points at the part it was made from, which has to outlive it; only trouble costs a path.
class SceneChecker {
public:
    SceneChecker() = default;  // the whole scene

    SceneChecker at(std::string_view key) const& { return {this, key, 0}; }
    SceneChecker at(std::size_t index) const& { return {this, {}, index}; }
    SceneChecker at(std::string_view key) const&& = delete;
    SceneChecker at(std::size_t index) const&& = delete;
    /// By name where there is one.
    SceneChecker at(std::string_view name, std::size_t index) const& { return {this, name, index}; }

    ScenePath path() const;
    [[noreturn]] void refuse(std::string_view wanted) const;
    void need(bool good, std::string_view wanted) const
    {
        if (!good) refuse(wanted);
    }
    /// The number lies in the range, or trouble says `wanted WHAT, not NUMBER`.
    void need_range(double number, const Range& range) const;
    /// Each of the numbers, with its place.
    void need_range(const Vec3& numbers, const Range& range) const;
    void need_unit(const Quat& orientation) const;

    /// What the fields of an object say of its members, each by itself.
    template <class Object>
    void need_fields(const Object& object, Fields<Object> fields) const
    {
        need_fields(bound(object, fields));
    }
    void need_fields(const BoundFields& fields) const;

private:
    SceneChecker(const SceneChecker* whole, std::string_view key, std::size_t index)
        : whole_(whole), key_(key), index_(index)
    { }

    const SceneChecker* whole_ = nullptr;
    std::string_view key_;  // empty: by index
    std::size_t index_ = 0;
};

inline constexpr std::string_view kWantedUnitQuaternion =
    "wanted a quaternion [w, x, y, z] of unit length";

bool is_unit(const Quat& orientation);

/// [shapes] whether some body with the shape is dynamic, and whether some is not.
struct ShapeUses {
    std::vector<bool> dynamic, other;
};
ShapeUses shape_uses(const Scene& scene);

/// Checks all shapes; answers what each weighs at unit density.
std::vector<MassProperties> check_shapes(const Scene& scene);

/// Checks all bodies and instances.
void check_bodies(const Scene& scene, std::span<const MassProperties> masses);

}  // namespace throng
