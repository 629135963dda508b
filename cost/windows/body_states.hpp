// Body states: where the moving bodies of a world are, and how they go on.
#pragma once

#include "throng/world.hpp"

#include <vector>

namespace throng {

/// Of one body.
///
///   counts   it is dynamic and sound: errors are taken over such
struct BodyState {
    BodyId body;
    bool counts = false;
    Pose pose;
    Vec3 center = Vec3::Zero();                         // m, of mass
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  // m/s, rad/s
};

/// Of all bodies that are not static, by index.
using BodyStates = std::vector<BodyState>;

BodyStates states_of(const World& world);

/// Puts the bodies of a world, made of the same scene, where the states say.
void put_states(World& world, const BodyStates& states);

/// Whether every number of them is one.
bool all_finite(const BodyStates& states);

}  // namespace throng
