// Convex query: what each of throng's methods has to say of two convex shapes.
//
// For those who want to compare methods, or to ask one pair without a world. Every method answers
// for itself, says what it can tell, and none answers through another; known_methods() lists them.
#pragma once

#include "throng/scene.hpp"
#include "throng/settings.hpp"

#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace throng {

/// A method by its name, and what its answers are good for.
///
///   touch           whether two shapes touch; a filter may be undecided of those that do
///   distance        of shapes that are apart, with a normal and the nearest points
///   depth           of shapes that touch, with a normal
///   volume          of what two share, with its surface and center
///   polytopes_only  boxes and hulls are all that it serves
struct MethodDescription {
    std::string_view name, about;
    bool touch = false, distance = false, depth = false, volume = false;
    bool polytopes_only = false;
};

/// All methods, the plainest first.
std::vector<MethodDescription> known_methods();

enum class QueryVerdict : std::uint8_t {
    refused,    // the question makes no sense; `trouble` says why, nothing else is filled in
    apart,      // no point is shared
    touching,   // some point is
    undecided,  // the method has come to the end of what it can tell
};

/// What a method has to say. Of the numbers those are good that its description names.
///
///   separation  m: apart, the distance; touching, minus the least distance by which one has to be
///               moved for the two to part
///   normal      unit, in a's axes, from a to b: apart, of a plane that parts them; touching, the
///               direction of that least move
///   on_a, on_b  in a's frame: the points of the two that are nearest
///   volume, surface, center   m3, m2, and m in a's frame, of what the two share
///   rounds      support points asked for, planes cut by or axes looked at
///   cut_short   the method came to the bound of its rounds; the answer is the best so far
struct ConvexAnswer {
    QueryVerdict verdict = QueryVerdict::refused;
    std::string trouble;
    double separation = 0;
    Vec3 normal = Vec3::UnitZ();
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
    double volume = 0, surface = 0;
    Vec3 center = Vec3::Zero();
    int rounds = 0;
    bool cut_short = false;
};

/// The pose of b as a sees it, from those the world knows. What two poses far from the origin have
/// lost to rounding stays lost; nothing is lost beyond that.
Pose seen_from(const Pose& a, const Pose& b);

/// Two convex shapes to ask about, as often as one likes and however placed. Asking in the order of
/// a motion is what cached starts are for. One thread at a time.
class ConvexQuery {
public:
    /// Spheres, capsules, cylinders, boxes and hulls, as a scene states them. Of others, and of
    /// those that a scene would refuse, trouble() says what is wrong.
    ConvexQuery(const ShapeDescription& a, const ShapeDescription& b);
    ~ConvexQuery();
    ConvexQuery(ConvexQuery&&) noexcept;
    ConvexQuery& operator=(ConvexQuery&&) noexcept;

    /// Empty, or what is wrong with the shapes: every question is then refused for that.
    const std::string& trouble() const;

    /// Asks a method. Never throws for what it is asked: an unknown method, a shape that the method
    /// does not serve, a pose that is not finite or not of unit length within 1e-6, and a reach
    /// below 0 are refused.
    ///
    ///   start           from what the method remembers of the last question, from nothing, or
    ///                   without its accelerations
    ///   max_separation  m, of shapes further apart only the verdict has to be good
    ConvexAnswer ask(std::string_view method,
                     const Pose& b_in_a,
                     MethodStart start = MethodStart::cached,
                     double max_separation = std::numeric_limits<double>::infinity());

    /// Asks the trees of k-DOPs round the faces of two boxes or hulls, built at the first question:
    /// a filter, which is undecided of what it cannot part. Others are refused, and so is a k other
    /// than 6, 14, 18 and 26.
    ConvexAnswer ask_trees(const Pose& b_in_a, int k);

    /// Whether a step of throng would see the two touch, by `auto` and in its number type, from
    /// nothing remembered; refused as ask() does. Touching, the separation and the normal are those
    /// of the deepest point of contact, and the surface is what the points of contact span: a face
    /// leads where another way out is shorter by little.
    ConvexAnswer touch(const Pose& b_in_a, Precision precision) const;

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
