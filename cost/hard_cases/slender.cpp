// Slender: H31, a needle and a plate a million times longer than thick, against a cube.
//
// Answer: in four times the digits. Asked for to a millionth of the thickness, which is 1e-12 of
// the length.
#include "cost/hard_cases/certified_pairs.hpp"
#include "cost/hard_cases/convex_judge.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/random.hpp"

namespace throng {

namespace {

constexpr int kPoses = 1000;
constexpr double kThickness = 1e-3;  // m

}  // namespace

void case_slender(CaseBench& bench)
{
    MethodTally tally;
    for (const auto& [name, half] :
         {std::pair("needle 2000 x 0.001 x 0.001 m", Vec3(1000, kThickness / 2, kThickness / 2)),
          std::pair("plate 1000 x 1000 x 0.001 m", Vec3(500, 500, kThickness / 2))}) {
        Random random(31);
        for (int i = 0; i < kPoses; ++i) {
            // Some point of the thin one meets some point about as far out as the cube's corners.
            Pose pose{Vec3::Zero(), random_turn(random)};
            Vec3 met = half, place = Vec3::Zero();
            for (int axis = 0; axis < 3; ++axis) met[axis] *= random.uniform(-1, 1);
            for (int axis = 0; axis < 3; ++axis) place[axis] = random.uniform(-0.8, 0.8);
            pose.position = place - pose.orientation * met;
            KnownPair pair = known_boxes(Vec3::Constant(0.5), Pose{}, half, pose);
            pair.size = kThickness;
            judge(bench, tally, pair, name, {.decided_beyond = 1e-6, .value = 1e-6});
        }
    }
    tally.report(bench);
}

}  // namespace throng
