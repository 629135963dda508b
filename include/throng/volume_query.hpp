// Volume query: what two closed shapes share, by each way that can tell.
//
// For those who want to compare ways, or to ask one pair without a world; known_volume_ways() lists
// them. Shapes need not be convex, and none of the ways fills holes but the one that says so.
#pragma once

#include "throng/scene.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace throng {

/// A way by its name, and what its answers are good for. All tell volume and center.
///
///   pushes      tells normal and depth too
///   converges   its error falls with the resolution; an exact way does not look at that
///   flat_only   serves what has flat faces alone: boxes, hulls and meshes
struct VolumeWayDescription {
    std::string_view name, about;
    bool pushes = false, converges = false, flat_only = false;
};

/// All ways, the plainest first.
std::vector<VolumeWayDescription> known_volume_ways();

/// What a way has to say, in a's frame.
///
///   trouble  empty, or why the question was refused; nothing else is filled in
///   volume   m3; 0 where they share none
///   center   m, of what they share
///   normal   unit: the way in which moving b lessens the volume fastest; 0 where no surface says
///   depth    m, the longest stretch along the normal that lies in both
struct VolumeAnswer {
    std::string trouble;
    double volume = 0;
    Vec3 center = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double depth = 0;
};

/// Two closed shapes to ask about, as often as one likes and however placed. One thread at a time.
class VolumeQuery {
public:
    /// Spheres, capsules, cylinders, boxes, hulls and meshes that are closed and turned outward. Of
    /// others, and of those that a scene would refuse, trouble() says what is wrong.
    VolumeQuery(const ShapeDescription& a, const ShapeDescription& b);
    ~VolumeQuery();
    VolumeQuery(VolumeQuery&&) noexcept;
    VolumeQuery& operator=(VolumeQuery&&) noexcept;

    /// Empty, or what is wrong with the shapes: every question is then refused for that.
    const std::string& trouble() const;

    /// Asks a way. Never throws for what it is asked: an unknown way, a shape that it does not
    /// serve, a bad pose, and a question that would take too long or too much memory are refused,
    /// with the limit named.
    ///
    ///   resolution  rays or cells along the longest side of what the bounds of the two share
    VolumeAnswer ask(std::string_view way, const Pose& b_in_a, int resolution = 128);

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
