// Scene rules: the parts of the scene check, and the limits they hold numbers to.
//
// Limits leave room for what a step makes of a number: masses and moments stay inside float, with
// their inverses, and distances inside what squares and cubes of them can hold.
#pragma once

#include "kernels/geometry/mass.hpp"
#include "scene/rules/scene_check.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace throng {

inline constexpr double kGreatestLength = 1e15;  // m, of places and sizes; m/s and rad/s too
inline constexpr double kLeastLength = 1e-12;
inline constexpr double kGreatestMass = 1e30, kLeastMass = 1e-30;      // kg
inline constexpr double kGreatestMoment = 1e37, kLeastMoment = 1e-37;  // kg m2
inline constexpr double kGreatestNumber = 1e30;  // forces, stiffnesses and other factors
inline constexpr double kUnitTolerance = 1e-6;   // a direction may be off by this much

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
    /// The number lies between limits, or trouble says `wanted WHAT, not NUMBER`.
    void need_range(double number, double least, double greatest, std::string_view what) const;
    /// Each of the numbers, with its place.
    void
    need_range(const Vec3& numbers, double least, double greatest, std::string_view what) const;
    /// A place, in m.
    void need_place(const Vec3& place) const;
    void need_unit(const Quat& orientation) const;

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
