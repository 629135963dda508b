// Mass: volume, center and inertia of each shape, and of several put together.
#pragma once

#include "kernels/data/shapes.hpp"

#include <span>

namespace throng {

/// What a shape weighs and how it turns, of unit density. Multiply volume and inertia by density.
struct MassProperties {
    double volume = 0;
    Vec3 center = Vec3::Zero();
    Sym3 inertia;  // about the center, in the shape's axes
};

/// Some mass, placed: pose takes its axes to those of the whole.
struct PlacedMass {
    MassProperties mass;
    Pose pose;
};

/// All zero for what encloses nothing: a plane, a mesh with a rim. An inside-out mesh has a volume
/// below zero.
MassProperties mass_of(const Shapes& shapes, ShapeRef shape);
MassProperties mass_of(const Hull& hull);
MassProperties mass_of(const Mesh& mesh);

/// The same for a mesh that may have a rim: its holes are closed by cones to the middle of its box.
MassProperties mass_as_if_closed(const Mesh& mesh);

/// All parts as one, in the axes of the whole. Parts that overlap count twice.
MassProperties combine(std::span<const PlacedMass> parts);

}  // namespace throng
