// Contact patches: what is grouped, what of it is kept, and that it is kept from step to step.
#include "narrowphase/manifold/contact_patches.hpp"

#include "tests/narrowphase/small_solids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

namespace throng::test {
namespace {

constexpr double kReach = 0.02, kDeep = 0.08;

// Touches along a ring about z; their normals lean out of its axis by `lean` (0: along it).
std::vector<ContactCandidate> ring(std::uint32_t count, double lean)
{
    std::vector<ContactCandidate> candidates;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        const Vec3 out(std::cos(angle), std::sin(angle), 0);
        const Vec3 normal = std::cos(lean) * Vec3::UnitZ() + std::sin(lean) * out;
        candidates.push_back({out, normal, -1e-3, i});
    }
    return candidates;
}

std::vector<ContactCandidate> grid(int side, const Vec3& normal, std::uint32_t feature)
{
    std::vector<ContactCandidate> candidates;
    const Vec3 across = normal.unitOrthogonal(), up = normal.cross(across);
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k)
            candidates.push_back(
                {normal + (2.0 * i / (side - 1) - 1) * across + (2.0 * k / (side - 1) - 1) * up,
                 normal, -1e-3, feature++});
    return candidates;
}

// Groups that lean apart by more than the angle that one takes in, of normals that agree.
std::vector<ContactCandidate> clusters(Dice& dice)
{
    std::vector<ContactCandidate> candidates;
    for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(-0.8, 0, -0.6)})
        for (int i = 0; i < 12; ++i) {
            const Vec3 normal = (axis + dice.point(0.06)).normalized();
            const auto feature = static_cast<std::uint32_t>(candidates.size());
            candidates.push_back(
                {axis + dice.point(0.3), normal, dice.between(-0.01, 0.019), feature});
        }
    return candidates;
}

std::vector<PartManifold> patches(std::vector<ContactCandidate> candidates,
                                  double speculative_margin = kReach)
{
    std::vector<PartManifold> out;
    EXPECT_EQ(make_patches(candidates, speculative_margin, 1.0, kDeep, out), 0U);
    return out;
}

std::vector<std::uint32_t> features(const LocalManifold<double>& manifold)
{
    std::vector<std::uint32_t> all;
    for (int k = 0; k < manifold.count; ++k)
        all.push_back(manifold.points[static_cast<std::size_t>(k)].feature);
    return all;
}

// Every bit of it.
bool same(const std::vector<PartManifold>& a, const std::vector<PartManifold>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
        bool alike = x.part == y.part && x.manifold.normal == y.manifold.normal
            && x.manifold.count == y.manifold.count;
        for (std::size_t k = 0; alike && k < static_cast<std::size_t>(x.manifold.count); ++k) {
            const auto &p = x.manifold.points[k], &q = y.manifold.points[k];
            alike =
                p.position == q.position && p.separation == q.separation && p.feature == q.feature;
        }
        return alike;
    });
}

bool same_points(const std::vector<PartManifold>& a, const std::vector<PartManifold>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
        return x.part == y.part && features(x.manifold) == features(y.manifold);
    });
}

double spanned(const LocalManifold<double>& m)
{
    const auto& p = m.points;
    const auto quad = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
        const Vec3 area = (p[c].position - p[a].position).cross(p[d].position - p[b].position);
        return std::abs(area.dot(m.normal)) / 2;
    };
    return std::max({quad(0, 1, 2, 3), quad(0, 2, 1, 3), quad(0, 1, 3, 2)});
}

TEST(ContactPatches, NothingMakesNothing)
{
    EXPECT_TRUE(patches({}).empty());
    EXPECT_TRUE(patches({{Vec3::Zero(), Vec3::UnitZ(), 2 * kReach, 1}}).empty());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(patches({{Vec3::Zero(), Vec3::UnitZ(), nan, 1},
                         {Vec3::Zero(), Vec3::Constant(nan), 0, 2},
                         {Vec3(nan, 0, 0), Vec3::UnitZ(), 0, 3}})
                    .empty());
}

TEST(ContactPatches, ARingOnAFloorIsOneManifoldThatSpansIt)
{
    for (const std::uint32_t count : {5U, 24U, 25U, 64U, 400U}) {
        const auto found = patches(ring(count, 0));
        ASSERT_EQ(found.size(), 1U) << count;
        ASSERT_EQ(found[0].manifold.count, 4);
        EXPECT_LT((found[0].manifold.normal - Vec3::UnitZ()).norm(), 1e-14);
        // A square in the circle has 2; any four of five corners span 1.72.
        EXPECT_GT(spanned(found[0].manifold), count == 5 ? 1.7 : 1.9) << count;
    }
}

TEST(ContactPatches, AFaceOnAFaceIsOneManifoldOfFourCorners)
{
    const auto found = patches(grid(9, Vec3(2, -1, 2) / 3, 0));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_GT(spanned(found[0].manifold), 3.9);
}

// Pushed out at its deepest side alone, who is deep all over would turn, and go in at the other.
TEST(ContactPatches, WhatIsDeepIsSpannedThoughItLeans)
{
    for (const double depth : {0.01, 0.5}) {
        auto leaning = grid(9, Vec3::UnitZ(), 0);
        for (ContactCandidate& candidate : leaning)
            candidate.separation = -depth + 0.1 * candidate.position.x();
        const auto found = patches(leaning, 0.2);
        ASSERT_EQ(found.size(), 1U);
        if (depth < 0.1)
            EXPECT_LT(spanned(found[0].manifold), 2.5) << depth;
        else
            EXPECT_GT(spanned(found[0].manifold), 3.9) << depth;
    }
}

TEST(ContactPatches, OppositeSidesAreNotJoined)
{
    std::vector<ContactCandidate> candidates = grid(4, Vec3::UnitX(), 0);
    for (const ContactCandidate& candidate : grid(4, -Vec3::UnitX(), 100))
        candidates.push_back(candidate);
    const auto found = patches(candidates);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found[0].manifold.normal.dot(found[1].manifold.normal), -1, 1e-14);
}

TEST(ContactPatches, NormalsOfAPatchAreWithin8DegreesOfItsOwn)
{
    Dice dice(61);
    std::size_t alone = 0;
    for (int i = 0; i < 200; ++i) {
        std::vector<ContactCandidate> candidates;
        for (std::uint32_t k = 0; k < 60; ++k) {
            // Within 57 degrees of one direction: few enough groups for all to be kept.
            const Vec3 normal = (dice.point(1).normalized() + 1.2 * Vec3::UnitZ()).normalized();
            candidates.push_back({dice.point(1), normal, dice.between(-0.01, kReach), k});
        }
        for (const PartManifold& patch : patches(candidates))
            for (std::size_t k = 0; k < static_cast<std::size_t>(patch.manifold.count); ++k) {
                const auto& point = patch.manifold.points[k];
                const ContactCandidate& candidate = candidates[point.feature];
                const double along = patch.manifold.normal.dot(candidate.normal);
                alone += patch.manifold.normal == candidate.normal ? 1 : 0;
                ASSERT_GT(along, std::cos(8.1 * std::numbers::pi / 180)) << "seed 61, set " << i;
                ASSERT_EQ(point.separation, candidate.separation * along);
                ASSERT_EQ(point.position, candidate.position);
            }
    }
    EXPECT_GT(alone, 200U);
}

// Where an end stops going by its group's normal nothing jumps.
TEST(ContactPatches, AnEndThatLeansMoreAndMoreTakesItsOwnNormalSmoothly)
{
    Vec3 before = Vec3::UnitZ();
    for (int i = 0; i <= 250; ++i) {
        const double lean = 0.001 * i;
        // Enough that look up for the group to look up whatever the one does.
        std::vector<ContactCandidate> candidates = grid(30, Vec3::UnitZ(), 1);
        const Vec3 normal(std::sin(lean), 0, std::cos(lean));
        candidates.push_back({Vec3(5, 0, 1), normal, -1e-3, 0});
        for (const PartManifold& patch : patches(candidates)) {
            const std::vector<std::uint32_t> held = features(patch.manifold);
            if (std::find(held.begin(), held.end(), 0U) == held.end()) continue;
            // A step leans by 0.001; in four degrees the normal makes up for twelve.
            EXPECT_LT((patch.manifold.normal - before).norm(), 0.006) << lean;
            before = patch.manifold.normal;
            if (lean > 0.22) {
                EXPECT_EQ(patch.manifold.normal, normal);
            }
        }
    }
    EXPECT_GT(before.x(), 0.24);
}

// A bolt in its nut: the flanks touch all round, and let it turn as its thread runs.
TEST(ContactPatches, AFlankAllRoundDoesNotStopAScrew)
{
    constexpr double kLead = 0.08;  // rise over the way round
    std::vector<ContactCandidate> candidates;
    for (std::uint32_t i = 0; i < 400; ++i) {
        const double angle = 8 * std::numbers::pi * i / 400;
        const Vec3 out(std::cos(angle), std::sin(angle), 0), round(-out.y(), out.x(), 0);
        const Vec3 normal = Vec3(Vec3::UnitZ() - kLead * round + out / std::sqrt(3)).normalized();
        candidates.push_back({out + kLead * angle * Vec3::UnitZ(), normal, 0, i});
    }
    std::size_t points = 0, exact = 0;
    for (const PartManifold& patch : patches(candidates))
        for (std::size_t k = 0; k < static_cast<std::size_t>(patch.manifold.count); ++k) {
            const Vec3 moves =
                Vec3::UnitZ().cross(patch.manifold.points[k].position) + kLead * Vec3::UnitZ();
            EXPECT_NEAR(patch.manifold.normal.dot(moves), 0,
                        std::sin(8.1 * std::numbers::pi / 180));
            exact += std::abs(patch.manifold.normal.dot(moves)) < 1e-14 ? 1 : 0;
            ++points;
        }
    EXPECT_GE(points, 8U);
    EXPECT_GT(2 * exact, points);
}

TEST(ContactPatches, TheDeepestOfEachGroupIsKept)
{
    Dice dice(62);
    for (int i = 0; i < 200; ++i) {
        const std::vector<ContactCandidate> candidates = clusters(dice);
        const auto found = patches(candidates);
        ASSERT_EQ(found.size(), 4U);
        for (const PartManifold& patch : found) {
            const Vec3& normal = patch.manifold.normal;
            double deepest = kReach, kept = kReach;
            for (const ContactCandidate& candidate : candidates)
                if (candidate.normal.dot(normal) > 0.9)
                    deepest =
                        std::min(deepest, candidate.separation * candidate.normal.dot(normal));
            for (std::size_t k = 0; k < static_cast<std::size_t>(patch.manifold.count); ++k)
                kept = std::min(kept, patch.manifold.points[k].separation);
            // A step of depth and what reduce_to_four() lets pass.
            ASSERT_LE(kept, deepest + 1.1e-4) << "seed 62, set " << i;
        }
    }
}

// A plate that comes down aslant: its high end is the first to touch once it turns fast enough.
TEST(ContactPatches, AGreatReachKeepsWhatIsFarApartYet)
{
    std::vector<ContactCandidate> candidates = grid(9, Vec3::UnitZ(), 0);
    for (ContactCandidate& candidate : candidates)
        candidate.separation = 0.1 * (candidate.position.x() + 1);
    const auto furthest = [](const std::vector<PartManifold>& found) {
        double most = 0;
        for (const PartManifold& patch : found)
            for (std::size_t k = 0; k < static_cast<std::size_t>(patch.manifold.count); ++k)
                most = std::max(most, patch.manifold.points[k].separation);
        return most;
    };
    EXPECT_EQ(furthest(patches(candidates, 0.5)), 0.2);
    EXPECT_EQ(furthest(patches(candidates, 0.05)), 0);
}

TEST(ContactPatches, TheOrderOfTouchesDoesNotMatter)
{
    Dice dice(63);
    for (int i = 0; i < 100; ++i) {
        std::vector<ContactCandidate> candidates = clusters(dice);
        for (int k = 0; k < 40; ++k)
            candidates.push_back({dice.point(1), dice.point(1).normalized(),
                                  dice.between(-0.01, kReach), dice.below(60)});
        std::vector<PartManifold> first, second;
        std::vector<ContactCandidate> shuffled = candidates;
        dice.shuffle(shuffled);
        const std::size_t left_out = make_patches(candidates, kReach, 1, kDeep, first);
        ASSERT_EQ(make_patches(shuffled, kReach, 1, kDeep, second), left_out);
        ASSERT_TRUE(same(first, second)) << "seed 63, set " << i;
        ASSERT_LE(first.size(), kMostManifolds);
        for (std::size_t k = 1; k < first.size(); ++k) ASSERT_LT(first[k - 1].part, first[k].part);
    }
}

TEST(ContactPatches, AFrameTurnedByRightAnglesTurnsTheGroups)
{
    Dice dice(64);
    Mat3 turn;
    turn << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    for (int i = 0; i < 100; ++i) {
        const std::vector<ContactCandidate> candidates = clusters(dice);
        std::vector<ContactCandidate> turned = candidates;
        for (ContactCandidate& candidate : turned) {
            candidate.position = turn * candidate.position + Vec3(3, 4, 5);
            candidate.normal = turn * candidate.normal;
        }
        const auto before = patches(candidates), after = patches(turned);
        ASSERT_EQ(before.size(), after.size());
        for (const PartManifold& patch : before)
            ASSERT_TRUE(std::any_of(
                after.begin(), after.end(),
                [&](const PartManifold& other) {
                    return (turn * patch.manifold.normal - other.manifold.normal).norm() < 1e-14;
                }))
                << "seed 64, set " << i;
    }
}

// What has many equals to choose from: rings of even and odd counts, grids, and both at once.
TEST(ContactPatches, TremblingKeepsPointsAndNames)
{
    std::vector<std::vector<ContactCandidate>> sets;
    for (const std::uint32_t count : {7U, 24U, 25U, 48U}) {
        sets.push_back(ring(count, 0));
        sets.push_back(ring(count, 0.2));
        sets.push_back(ring(count, std::numbers::pi / 2));
    }
    for (const int side : {3, 4, 9}) sets.push_back(grid(side, Vec3::UnitZ(), 0));
    sets.push_back(grid(8, Vec3(0, 1, 1).normalized(), 0));
    for (const ContactCandidate& candidate : grid(5, -Vec3::UnitY(), 200))
        sets.back().push_back(candidate);

    Dice dice(65);
    for (std::size_t s = 0; s < sets.size(); ++s) {
        const auto still = patches(sets[s]);
        for (int i = 0; i < 50; ++i) {
            std::vector<ContactCandidate> trembling = sets[s];
            for (ContactCandidate& candidate : trembling) {
                candidate.position += dice.point(1e-6);
                candidate.normal = (candidate.normal + dice.point(1e-6)).normalized();
                candidate.separation += dice.between(-1e-6, 1e-6);
            }
            ASSERT_TRUE(same_points(still, patches(trembling))) << "seed 65, set " << s;
        }
    }
}

TEST(ContactPatches, ANewPatchLeavesTheOthersTheirNames)
{
    std::vector<ContactCandidate> candidates = grid(4, Vec3::UnitZ(), 0);
    const auto before = patches(candidates);
    for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0)})
        for (const ContactCandidate& candidate : grid(4, normal, 100))
            candidates.push_back(candidate);
    const auto after = patches(candidates);
    ASSERT_EQ(after.size(), 5U);
    EXPECT_TRUE(std::any_of(after.begin(), after.end(), [&](const PartManifold& patch) {
        return patch.part == before[0].part
            && features(patch.manifold) == features(before[0].manifold);
    }));
}

TEST(ContactPatches, WhatIsTooManyJoinsOrIsLeftOutAndCounted)
{
    // Twenty-six directions 35 degrees apart or more: the axes and halfway between two of them,
    // deep, and halfway between three of them, shallow.
    std::vector<ContactCandidate> candidates;
    std::size_t overlapping = 0;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const int odd = std::abs(x) + std::abs(y) + std::abs(z);
                if (odd == 0) continue;
                const Vec3 normal = Vec3(x, y, z).normalized();
                const auto feature = static_cast<std::uint32_t>(candidates.size());
                const double separation = odd < 3 ? -0.01 : 0.001 * x;
                overlapping += separation < 0 ? 1 : 0;
                candidates.push_back({normal, normal, separation, feature});
            }
    std::vector<PartManifold> out;
    const std::size_t left_out = make_patches(candidates, kReach, 1, kDeep, out);
    // One that joins others may keep its normal to itself.
    ASSERT_GE(out.size(), kMostPatches);
    ASSERT_LE(out.size(), candidates.size());
    std::set<std::uint32_t> held;
    for (const PartManifold& patch : out)
        for (const std::uint32_t feature : features(patch.manifold)) held.insert(feature);
    // Of those left out only what overlaps counts; a shallow one that joined others may be behind
    // them.
    EXPECT_LE(left_out, overlapping);
    EXPECT_GE(held.size() + left_out, kMostPatches);
    for (const ContactCandidate& candidate : candidates) {
        EXPECT_TRUE(candidate.separation > -0.01 || held.count(candidate.feature) == 1);
    }
}

// How far the touch furthest from any point that is kept is from the nearest of them.
double least_covered(const std::vector<ContactCandidate>& candidates,
                     const std::vector<PartManifold>& found)
{
    double furthest = 0;
    for (const ContactCandidate& candidate : candidates) {
        double nearest = 10;
        for (const PartManifold& patch : found)
            for (std::size_t k = 0; k < static_cast<std::size_t>(patch.manifold.count); ++k)
                nearest = std::min(nearest,
                                   (patch.manifold.points[k].position - candidate.position).norm());
        furthest = std::max(furthest, nearest);
    }
    return furthest;
}

// A shaft in its hole touches all round.
TEST(ContactPatches, OfAFastBodyHeldAllRoundPlacesBetweenTheEndsAreKeptToo)
{
    const std::vector<ContactCandidate> shaft = ring(400, std::numbers::pi / 2);
    // Three hundredths of size, and what places are told apart by.
    EXPECT_LE(least_covered(shaft, patches(shaft, 0.2)), 0.035);
    const std::vector<PartManifold> fast = patches(shaft, 0.2);
    for (std::size_t k = 1; k < fast.size(); ++k) EXPECT_LT(fast[k - 1].part, fast[k].part);
    EXPECT_LE(fast.size(), kMostManifolds);
    // Slow, four of each group are enough.
    EXPECT_GT(least_covered(shaft, patches(shaft)), 0.05);
}

TEST(ContactPatches, OfAFastBodyThatIsNotHeldFromOppositeSidesFourOfAGroupAreKept)
{
    // Their normals are 107 degrees apart at most.
    const std::vector<ContactCandidate> bowl = ring(400, 0.93);
    EXPECT_GT(least_covered(bowl, patches(bowl, 0.2)), 0.05);
    // Two faces that look at one another do not bend.
    std::vector<ContactCandidate> faces = grid(20, Vec3::UnitZ(), 0);
    for (const ContactCandidate& candidate : grid(20, -Vec3::UnitZ(), 400))
        faces.push_back(candidate);
    EXPECT_EQ(patches(faces, 0.2).size(), 2U);
}

}  // namespace
}  // namespace throng::test
