#include "narrowphase/alternatives/convex_methods.hpp"

#include "narrowphase/alternatives/bounding_sphere.hpp"
#include "narrowphase/alternatives/chung_wang.hpp"
#include "narrowphase/alternatives/clip_volume.hpp"
#include "narrowphase/alternatives/containment.hpp"
#include "narrowphase/alternatives/k_dop.hpp"
#include "narrowphase/alternatives/query_sat.hpp"
#include "narrowphase/convex/query_gjk.hpp"

namespace throng {
namespace {

constexpr ConvexMethod kMethods[] = {
    {"containment", "vertices inside and edges through faces, as in the first textbooks",
     tells_touch, true, query_containment},
    {"clip_volume", "one polytope cut by the planes of the other, and what is left measured",
     tells_touch | tells_volume, true, query_clip_volume},
    {"sat", "every axis that could part two polytopes", tells_touch | tells_depth, true, query_sat},
    {"chung_wang", "the search for a direction that parts the two", tells_touch, false,
     query_chung_wang},
    {"gjk", "the distance by GJK, the depth by EPA", tells_touch | tells_distance | tells_depth,
     false, query_gjk},
    {"sphere", "filter: balls round the two", tells_touch, false, query_bounding_sphere},
    {"k_dop:6", "filter: slabs along the axes", tells_touch, false, query_k_dop<6>},
    {"k_dop:14", "filter: slabs along axes and cube's corners", tells_touch, false,
     query_k_dop<14>},
    {"k_dop:18", "filter: slabs along axes and cube's edges", tells_touch, false, query_k_dop<18>},
    {"k_dop:26", "filter: slabs along axes, corners and edges", tells_touch, false,
     query_k_dop<26>},
};

}  // namespace

std::span<const ConvexMethod> convex_methods() { return kMethods; }

const ConvexMethod* find_convex_method(std::string_view name)
{
    for (const ConvexMethod& method : kMethods)
        if (method.name == name) return &method;
    return nullptr;
}

}  // namespace throng
