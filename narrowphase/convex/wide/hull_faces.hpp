// Hull faces: how well the faces of one polytope part it from another, for the hull kernels.
#pragma once

#include "narrowphase/convex/wide/hull_lanes.hpp"

namespace throng::THRONG_LANES {

constexpr float kNever = -3e38F;
// Cosine below which an edge's normal is no stand-in for a face's: a fiftieth of a radian.
constexpr float kAlike = 0.9998F;
constexpr float kAlikeAngle = 0.0201F;

struct FaceAxis {
    float separation = kNever;
    int face = 0;
};

// What bounds how well an axis can part the two: the ball inside the other shape, and some of its
// points, the first of them the nearest to self.
struct Bound {
    int points = 0;
    F3 point[3];                                  // in self's frame
    float inner = 0;                              // radius of the ball about the other's center
    alignas(64) float center_beyond[kWideFaces];  // how far they are beyond each face of self
    alignas(64) float point_beyond[3][kWideFaces];
};

// How far a point is beyond each face; whole groups.
inline void look_beyond(const WidePolytope& self, F3 point, float* beyond)
{
    const float *nx = self.nx(), *ny = self.ny(), *nz = self.nz(), *offset = self.offset();
    const L x = point.x, y = point.y, z = point.z;
    for (int i = 0, count = self.faces; i < count; i += L::kWidth) {
        const L along = x * L::load(nx + i) + y * L::load(ny + i) + z * L::load(nz + i);
        (along - L::load(offset + i)).store(beyond + i);
    }
}

inline float separation_of(const Side& side, int face)
{
    const F3 normal = normal_of(side.self, face);
    const float beyond = dot(side.center, normal) - side.self.offset()[face];
    return beyond + lowest(side.other, side.to_other(normal));
}

inline int furthest_face(const WidePolytope& self, const float* beyond)
{
    L top = L::load(beyond);
    for (int i = L::kWidth; i < self.faces; i += L::kWidth) top = max(top, L::load(beyond + i));
    const float most_beyond = -least_of(-top);
    for (int i = 0; i < self.faces; i += L::kWidth) {
        const unsigned there = bits_of(!(L::load(beyond + i) < L(most_beyond)));
        if (there != 0) return i + __builtin_ctz(there);
    }
    return 0;
}

// Whether any face's normal is all but this one.
inline bool has_alike(const WidePolytope& self, F3 normal)
{
    const L x = normal.x, y = normal.y, z = normal.z;
    L like = 0.0F;
    for (int i = 0; i < self.faces; i += L::kWidth)
        like = max(like,
                   x * L::load(self.nx() + i) + y * L::load(self.ny() + i)
                       + z * L::load(self.nz() + i));
    return -least_of(-like) > kAlike - 1e-5F;
}

// The best face of self, if it reaches `floor`; ties go to the first. Stops at any that is out of
// reach.
inline void improve_face(const Side& side,
                         const Bound& bound,
                         float floor,
                         float speculative_margin,
                         float noise,
                         FaceAxis& best)
{
    float limit = most(floor, best.separation) - noise;
    for (int i = 0; i < side.self.faces; i += L::kWidth) {
        const L by_center = L::load(bound.center_beyond + i) - L(bound.inner);
        L at_most = min(by_center, L::load(bound.point_beyond[0] + i));
        for (int n = 1; n < bound.points; ++n)
            at_most = min(at_most, L::load(bound.point_beyond[n] + i));
        for (unsigned there = bits_of(at_most > L(limit)); there != 0; there &= there - 1) {
            const int face = i + __builtin_ctz(there);
            if (face == best.face && best.separation > kNever) continue;
            const float separation = separation_of(side, face);
            if (separation < best.separation || (separation == best.separation && face > best.face))
                continue;
            best = {separation, face};
            if (separation > speculative_margin) return;
            limit = most(floor, separation) - noise;
        }
    }
}

// A point of self's face: the one under a point if that is over the face, else one towards it.
inline F3 point_under(const WidePolytope& self, int face, F3 point)
{
    const int begin = self.face_begin()[face], corners = self.face_begin()[face + 1] - begin;
    F3 middle{0, 0, 0};
    for (int i = 0; i < corners; ++i) middle = middle + vertex_of(self, self.corners()[begin + i]);
    middle = middle * (1 / static_cast<float>(corners));
    const F3 normal = normal_of(self, face);
    const F3 under = point - normal * (dot(normal, point) - self.offset()[face]);
    float part = 1;
    for (int i = 0; i < corners; ++i) {
        const Wall wall = wall_of(self, face, i);
        const float inside = wall.beyond(middle), beyond = wall.beyond(under);
        if (beyond > 0 && inside < 0) part = least(part, inside / (inside - beyond));
    }
    return middle + (under - middle) * part;
}

}  // namespace throng::THRONG_LANES
