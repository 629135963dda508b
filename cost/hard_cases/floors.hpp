// Floors: one level floor of whatever kind a scene may have.
#pragma once

#include "cost/hard_cases/hard_cases.hpp"

#include <span>

namespace throng {

enum class Floor : std::uint8_t { plane, box, mesh, hull, grid, tiles };
/// Of one piece, and those with the grid.
inline constexpr Floor kFloors[] = {Floor::plane, Floor::box, Floor::mesh, Floor::hull};
inline constexpr Floor kFloorsAndGrid[] = {Floor::plane, Floor::box, Floor::mesh, Floor::hull,
                                           Floor::grid};
const char* name_of(Floor floor);

/// How large a floor is.
///
///   wide    m, half of its sides; of no use to a plane
///   thick   m, half of it
///   cells   of a grid's side, or tiles of a side
///   height  m, of the grid's corners at most, above the floor
struct FloorSize {
    double wide = 0, thick = 0;
    int cells = 1;
    double height = 0;
};

/// Makes a static floor whose top is level with the frame's z = 0. A mesh is two triangles, a grid
/// is many, with corners as high as chance has it; tiles are boxes that are bodies of their own.
void put_floor(SceneParts& parts,
               std::uint32_t material,
               Floor floor,
               const Pose& frame,
               const FloorSize& size);

/// m, the height of the lowest of a body's points.
double lowest_of(std::span<const Vec3> points, const Pose& pose);

}  // namespace throng
