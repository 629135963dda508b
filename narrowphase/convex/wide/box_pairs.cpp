#include "narrowphase/convex/wide/box_pairs.hpp"

#include "kernels/check.hpp"
#include "narrowphase/manifold/edge_on_edge.hpp"
#include "narrowphase/manifold/edge_over_face.hpp"

#include <algorithm>

namespace throng {

namespace {

// Pairs that go through the steps together: 16 kB of them, so that they are still near by when the
// last step asks for them.
constexpr std::size_t kTogether = 256;

// The kernels write manifolds as plain numbers.
static_assert(sizeof(LocalManifold<float>) == kManifoldNumbers * sizeof(float));
static_assert(sizeof(LocalManifold<float>::Point) == 5 * sizeof(float));
static_assert(offsetof(LocalManifold<float>, points) == 3 * sizeof(float));
static_assert(offsetof(LocalManifold<float>, count) == 23 * sizeof(float));

// Hands a pair and its manifold to what holds edges: half extents, b's axes and center, margin.
using HoldEdges = void (*)(const Vec3T<float>&,
                           const Vec3T<float>&,
                           const Mat3T<float>&,
                           const Vec3T<float>&,
                           float,
                           LocalManifold<float>&);

void hold_edges(const BoxPair& pair, LocalManifold<float>& manifold, HoldEdges hold)
{
    using Numbers = Eigen::Map<const Vec3T<float>>;
    const QuatT<float> turn(pair.place[7], pair.place[4], pair.place[5], pair.place[6]);
    hold(Numbers(pair.size), Numbers(pair.size + 4), turn.toRotationMatrix(), Numbers(pair.place),
         pair.place[3], manifold);
}

}  // namespace

void collide_boxes(const BoxKernels& kernels,
                   std::span<const BoxPair> pairs,
                   std::span<LocalManifold<float>> manifolds)
{
    THRONG_CHECK(pairs.size() == manifolds.size(), "as many manifolds as pairs");
    for (std::size_t begin = 0; begin < pairs.size(); begin += kTogether) {
        const std::size_t count = std::min(kTogether, pairs.size() - begin);
        BoxAxes face_room[kTogether], edge_room[kTogether];
        BoxList faces{face_room, 0}, edges{edge_room, 0};
        for (std::size_t i = 0; i < count; ++i) manifolds[begin + i].count = 0;
        const BoxPair* const from = pairs.data() + begin;
        auto* const to = reinterpret_cast<float*>(manifolds.data() + begin);
        kernels.part(from, static_cast<std::int32_t>(count), faces, edges);
        kernels.clip(from, faces, edges, to);
        kernels.cross(from, edges, to);
        for (std::int32_t k = 0; k < faces.count; ++k) {
            const auto i = begin + static_cast<std::size_t>(faces.at[k].pair);
            hold_edges(pairs[i], manifolds[i], meet_edge_on_edge<float>);
        }
        for (std::int32_t k = 0; k < edges.count; ++k) {
            const auto i = begin + static_cast<std::size_t>(edges.at[k].pair);
            if (manifolds[i].count > 0)
                hold_edges(pairs[i], manifolds[i], lay_edge_over_face<float>);
        }
    }
}

void collide_boxes(std::span<const BoxPair> pairs, std::span<LocalManifold<float>> manifolds)
{
    collide_boxes(box_kernels(), pairs, manifolds);
}

}  // namespace throng
