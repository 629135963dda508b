// Agreement: all methods say the same of whether two shapes touch, on pairs whose answer is known
// from how they were made, and on hulls from games, whose answer is what all say.
#include "cost/hard_cases/certified_pairs.hpp"
#include "narrowphase/alternatives/convex_methods.hpp"
#include "tests/support/polyhedra.hpp"
#include "tests/support/shared_data.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

namespace throng {
namespace {

constexpr MethodStart kStarts[] = {MethodStart::cached, MethodStart::cold, MethodStart::plain};

// Pairs here are a billionth of their size apart or deep, or more: none is too close to call. Yet a
// search may run out of rounds now and then. One that never says `touching` is a filter, and leaves
// to others what is near.
constexpr double kMayLeave = 1e-3;

struct Count {
    int asked = 0, said_touching = 0, undecided = 0, undecided_far = 0;
};

/// Asks all methods about pair after pair, and keeps count of who is undecided.
class Panel {
public:
    void ask(const ConvexPair& pair, std::vector<MethodMemory>& memories, int turn)
    {
        answers_.clear();
        memories.resize(convex_methods().size());
        for (std::size_t i = 0; i < convex_methods().size(); ++i) {
            const ConvexMethod& method = convex_methods()[i];
            if ((method.tells & tells_touch) == 0 || !method.serves(pair)) continue;
            const MethodStart start = kStarts[turn % 3];
            const MethodAnswer answer = method.ask(pair, 1e30, start, memories[i]);
            answers_.push_back({&method, answer.overlap, answer.separation});
        }
    }

    // All that decide say so; who does not is counted.
    void expect(bool touching, bool far, const std::string& where)
    {
        const OverlapState wrong = touching ? OverlapState::apart : OverlapState::touching;
        for (const Answer& one : answers_) {
            EXPECT_NE(one.overlap, wrong) << one.method->name << ", " << where;
            Count& count = counts_[one.method->name];
            const bool undecided = one.overlap == OverlapState::undecided;
            ++count.asked;
            count.said_touching += one.overlap == OverlapState::touching ? 1 : 0;
            count.undecided += undecided ? 1 : 0;
            count.undecided_far += undecided && far ? 1 : 0;
        }
    }

    // Those that decide agree; false where one that measures is within a hair of touching, where
    // rounding may speak.
    bool agree(double hair, const std::string& where)
    {
        bool any_apart = false, any_touching = false;
        for (const Answer& one : answers_) {
            const bool told = one.overlap == OverlapState::touching
                ? (one.method->tells & tells_depth) != 0
                : (one.method->tells & tells_distance) != 0;
            if (told && one.overlap != OverlapState::undecided && std::abs(one.separation) < hair)
                return false;
            any_apart = any_apart || one.overlap == OverlapState::apart;
            any_touching = any_touching || one.overlap == OverlapState::touching;
        }
        EXPECT_FALSE(any_apart && any_touching) << where << ":" << told();
        expect(any_touching, false, where);
        return true;
    }

    /// Whether any says of the last pair that it touches.
    bool touching() const
    {
        return std::any_of(answers_.begin(), answers_.end(),
                           [](const Answer& one) { return one.overlap == OverlapState::touching; });
    }

    void expect_few_undecided() const
    {
        for (const ConvexMethod& method : convex_methods()) {
            const auto found = counts_.find(method.name);
            if (found == counts_.end()) continue;
            const Count& count = found->second;
            const std::string says = std::string(method.name) + " is undecided of "
                + std::to_string(count.undecided) + " in " + std::to_string(count.asked)
                + " pairs, " + std::to_string(count.undecided_far) + " of them far apart";
            EXPECT_EQ(count.undecided_far, 0) << says;
            if (count.said_touching > 0) {
                EXPECT_LE(count.undecided, kMayLeave * count.asked) << says;
            }
        }
    }

private:
    struct Answer {
        const ConvexMethod* method;
        OverlapState overlap;
        double separation;
    };
    std::string told() const
    {
        std::string text;
        for (const Answer& one : answers_)
            text += " " + std::string(one.method->name) + " "
                + (one.overlap == OverlapState::apart          ? "apart"
                       : one.overlap == OverlapState::touching ? "touching"
                                                               : "undecided");
        return text;
    }

    std::vector<Answer> answers_;
    std::map<std::string_view, Count> counts_;
};

Hull box_hull(const Vec3& half) { return build_hull(corners_of(half)).hull; }

// A hundred thousand pairs, in parts that take about as long.
class AgreementOnRandomPairs : public testing::TestWithParam<int> { };

constexpr int kParts = 20, kShapes = 50, kPlacings = 100;

TEST_P(AgreementOnRandomPairs, AllMethodsSayWhatIsCertified)
{
    const auto seed = static_cast<std::uint64_t>(1000 + GetParam());
    Random random(seed);
    Panel panel;
    for (int i = 0; i < kShapes; ++i) {
        // Boxes are kept as boxes: methods may take them by ways of their own.
        Shapes shapes;
        std::array<ShapeRef, 2> refs;
        std::array<Hull, 2> hulls;
        for (std::size_t k = 0; k < 2; ++k) {
            if (random.below(2) == 0) {
                const double x = random.uniform(0.1, 1), y = random.uniform(0.1, 1);
                const Vec3 half(x, y, random.uniform(0.1, 1));
                shapes.boxes.push_back({half});
                hulls[k] = box_hull(half);
                refs[k] = {ShapeKind::box, static_cast<std::uint32_t>(shapes.boxes.size() - 1)};
            } else {
                hulls[k] = random_hull(random, 4 + static_cast<int>(random.below(16)));
                shapes.hulls.push_back(hulls[k]);
                refs[k] = {ShapeKind::hull, static_cast<std::uint32_t>(shapes.hulls.size() - 1)};
            }
        }
        ConvexPair pair(shapes, refs[0], refs[1], Pose{});
        std::vector<MethodMemory> memories;
        for (int k = 0; k < kPlacings; ++k) {
            const CertifiedPair certified = certified_pair(hulls[0], hulls[1], random);
            pair.place(certified.b_in_a);
            panel.ask(pair, memories, k);
            const bool far = !certified.touching
                && certified.separation >= kFarSeparation * certified_size(hulls[0], hulls[1]);
            panel.expect(certified.touching, far,
                         "seed " + std::to_string(seed) + ", shapes " + std::to_string(i)
                             + ", placing " + std::to_string(k));
        }
    }
    panel.expect_few_undecided();
}

INSTANTIATE_TEST_SUITE_P(Parts, AgreementOnRandomPairs, testing::Range(0, kParts));

// Hulls that games are made of, as build_hull() takes them.
std::vector<Hull> game_hulls(const std::filesystem::path& path, std::size_t most)
{
    std::ifstream file(path, std::ios::binary);
    std::vector<Hull> hulls;
    std::uint32_t count = 0;
    while (hulls.size() < most && file.read(reinterpret_cast<char*>(&count), sizeof count)) {
        std::vector<Vec3T<float>> read(count);
        file.read(reinterpret_cast<char*>(read.data()), static_cast<std::streamsize>(12) * count);
        std::vector<Vec3> points;
        for (const Vec3T<float>& point : read) points.push_back(point.cast<double>());
        HullResult result = build_hull(points);
        if (result.trouble.empty()) hulls.push_back(std::move(result.hull));
    }
    return hulls;
}

class AgreementOnHullsFromGames : public testing::TestWithParam<int> { };

constexpr int kGameParts = 5, kGamePairs = 1000;

// Faces of points in single precision lie off their planes: what goes by planes and what goes by
// vertices may differ by as much as build_hull() allows, of the size.
constexpr double kFacesStray = 1e-5;

// Each two hulls twice: the one somewhere about the rim of the other, and placed so that the answer
// is certain.
TEST_P(AgreementOnHullsFromGames, AllMethodsSayTheSame)
{
    const std::filesystem::path path = shared_data("hulls/game_hulls.bin");
    if (path.empty()) GTEST_SKIP() << "hulls/game_hulls.bin is not there; set THRONG_DATA";
    Shapes shapes;
    shapes.hulls = game_hulls(path, 1000);
    ASSERT_GT(shapes.hulls.size(), 100u);
    const auto count = static_cast<std::uint32_t>(shapes.hulls.size());
    Random random(static_cast<std::uint64_t>(2000 + GetParam()));
    Panel panel;
    int close = 0, touching = 0;
    for (int i = 0; i < kGamePairs; ++i) {
        const std::uint32_t first = random.below(count), second = random.below(count);
        const Hull& a = shapes.hulls[first];
        const Hull& b = shapes.hulls[second];
        const Quat turn = random_turn(random);
        const Vec3 way = random_turn(random) * Vec3::UnitX();
        // As far as both reach along the way between them, they are surely apart.
        const double speculative_margin = extent_of(a.vertices, {-a.center, Quat::Identity()})(way)
            + extent_of(b.vertices, {-(turn * b.center), turn})(-way);
        const Pose pose{a.center + random.uniform(0.5, 1.02) * speculative_margin * way
                            - turn * b.center,
                        turn};
        ConvexPair pair(shapes, {ShapeKind::hull, first}, {ShapeKind::hull, second}, pose);
        std::vector<MethodMemory> memories;
        panel.ask(pair, memories, i);
        const std::string where = "part " + std::to_string(GetParam()) + ", pair "
            + std::to_string(i) + ", hulls " + std::to_string(first) + " and "
            + std::to_string(second);
        close += panel.agree(1e-9 * certified_size(a, b), where) ? 0 : 1;
        touching += panel.touching() ? 1 : 0;

        const CertifiedPair certified = certified_pair(a, b, random);
        if (certified.separation < kFacesStray * certified_size(a, b)) continue;
        pair.place(certified.b_in_a);
        panel.ask(pair, memories, i + 1);
        panel.expect(certified.touching, false, where + ", certified");
    }
    EXPECT_LE(close, 5);
    EXPECT_GT(touching, kGamePairs / 10);
    EXPECT_LT(touching, kGamePairs * 9 / 10);
    panel.expect_few_undecided();
}

INSTANTIATE_TEST_SUITE_P(Parts, AgreementOnHullsFromGames, testing::Range(0, kGameParts));

// Four corners, each two of which are joined by an edge.
Hull random_plate(Random& random, double thickness)
{
    std::vector<Vec3> corners;
    for (int i = 0; i < 4; ++i)
        corners.emplace_back(random.uniform(-1, 1), thickness * random.uniform(-1, 1),
                             random.uniform(-1, 1));
    return build_hull(corners).hull;
}

// Where the box's corner is so far from the plate's rim; below 0, within it.
Pose beside_the_rim(const Hull& plate, Random& random, const Vec3& half, double clearance)
{
    const Vec3 &from = plate.vertices[random.below(2)], &to = plate.vertices[2 + random.below(2)];
    const Vec3 on_rim = from + (to - from) * random.uniform(0.1, 0.9);
    const Vec3 out = Vec3(on_rim - plate.center).normalized();
    // The corner that lies furthest back along the way out.
    const Quat turn = random_turn(random);
    Vec3 nearest = half;
    for (int k = 0; k < 3; ++k) nearest[k] = (turn.inverse() * out)[k] > 0 ? -half[k] : half[k];
    return {on_rim + clearance * out - turn * nearest, turn};
}

// The planes of a plate's two sides, put out by rounding, meet far beyond the rim between them.
TEST(Agreement, BesideTheSharpRimOfAPlateAllSayApart)
{
    Random random(3000);
    Panel panel;
    int apart = 0, touching = 0;
    for (int i = 0; i < 4000; ++i) {
        Shapes shapes;
        const double thickness = std::pow(10, random.uniform(-7, -3));
        shapes.hulls = {random_plate(random, thickness)};
        if (shapes.hulls[0].vertices.size() != 4) continue;
        const Vec3 half(0.3, 0.4, 0.5);
        shapes.boxes = {{half}};
        const double clearance = std::pow(10, random.uniform(-8, -5)) * (i % 4 == 0 ? -1 : 1);
        const Pose pose = beside_the_rim(shapes.hulls[0], random, half, clearance);
        const ConvexPair pair(shapes, {ShapeKind::hull, 0}, {ShapeKind::box, 0}, pose);
        std::vector<MethodMemory> memories;
        panel.ask(pair, memories, i);
        const std::string where = "seed 3000, pair " + std::to_string(i);
        if (!panel.agree(1e-9, where)) continue;
        (panel.touching() ? touching : apart) += 1;
    }
    EXPECT_GT(apart, 1000);
    EXPECT_GT(touching, 100);
}

}  // namespace
}  // namespace throng
