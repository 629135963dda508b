#include "narrowphase/convex/wide/box_pairs.hpp"

#include "kernels/check.hpp"
#include "narrowphase/manifold/edge_on_edge.hpp"

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

void meet_edge_on_edge(const BoxPair& pair, LocalManifold<float>& manifold)
{
    using Numbers = Eigen::Map<const Vec3T<float>>;
    const QuatT<float> turn(pair.place[7], pair.place[4], pair.place[5], pair.place[6]);
    meet_edge_on_edge<float>(Numbers(pair.size), Numbers(pair.size + 4), turn.toRotationMatrix(),
                             Numbers(pair.place), pair.place[3], manifold);
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
            meet_edge_on_edge(pairs[i], manifolds[i]);
        }
    }
}

void collide_boxes(std::span<const BoxPair> pairs, std::span<LocalManifold<float>> manifolds)
{
    collide_boxes(box_kernels(), pairs, manifolds);
}

}  // namespace throng
