// Queries: every answer against all bodies asked in turn by distances written down afresh.
#include "tests/support/dice.hpp"
#include "throng/throng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <stdexcept>

namespace throng::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Distance to a shape in its own frame: exact outside, below 0 inside.
using Distance = std::function<double(const Vec3&)>;

double to_flat_box(const Vec3& point, const Vec3& half)
{
    const Vec3 over = point.cwiseAbs() - half;
    return over.maxCoeff() <= 0 ? over.maxCoeff() : over.cwiseMax(0).norm();
}

// Corners at 0.8 on the axes. A face is what is left of the sum of coordinates once each has given
// up the same amount, but none more than it has.
double to_octahedron(const Vec3& point)
{
    constexpr double kSize = 0.8;
    Vec3 at = point.cwiseAbs();
    if (at.sum() <= kSize) return (at.sum() - kSize) / std::sqrt(3.0);
    std::sort(at.begin(), at.end(), std::greater<>());
    double given = 0, sum = 0;
    for (int i = 0; i < 3; ++i) {
        sum += at[i];
        if (at[i] > (sum - kSize) / (i + 1)) given = (sum - kSize) / (i + 1);
    }
    return at.cwiseMin(given).norm();
}

enum Kind : std::uint32_t { ball, pill, can, crate, pair, gem, floor_, slab };

// A slab is a mesh: a rectangle in z = 0, of two triangles. A pair is two balls on a stick.
Distance distance_of(Kind kind)
{
    switch (kind) {
    case ball:
        return [](const Vec3& p) { return p.norm() - 0.5; };
    case pill:
        return [](const Vec3& p) {
            return std::hypot(p.x(), p.y(), std::max(0.0, std::abs(p.z()) - 0.6)) - 0.3;
        };
    case can:
        return [](const Vec3& p) {
            const double side = std::hypot(p.x(), p.y()) - 0.4, top = std::abs(p.z()) - 0.5;
            return side > 0 && top > 0 ? std::hypot(side, top) : std::max(side, top);
        };
    case crate:
        return [](const Vec3& p) { return to_flat_box(p, {0.5, 0.4, 0.3}); };
    case pair:
        return [](const Vec3& p) {
            return std::min((p - Vec3(0, 0, 1)).norm(), (p + Vec3(0, 0, 1)).norm()) - 0.5;
        };
    case gem:
        return to_octahedron;
    case floor_:
        return [](const Vec3& p) { return p.z(); };
    default:
        return [](const Vec3& p) { return to_flat_box(p, {2, 1.5, 0}); };
    }
}

void add_shapes(Scene& scene)
{
    MeshShape mesh;
    mesh.vertices = {{-2, -1.5, 0}, {2, -1.5, 0}, {2, 1.5, 0}, {-2, 1.5, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    CompoundShape balls;
    balls.parts = {{0, {Vec3(0, 0, 1), Quat::Identity()}}, {0, {Vec3(0, 0, -1), Quat::Identity()}}};
    HullShape gem_shape;
    for (int i = 0; i < 6; ++i)
        gem_shape.points.push_back(Vec3::Unit(i / 2) * (i % 2 ? 0.8 : -0.8));
    scene.shapes = {{"ball", SphereShape{0.5}},
                    {"pill", CapsuleShape{0.3, 0.6}},
                    {"can", CylinderShape{0.4, 0.5}},
                    {"crate", BoxShape{Vec3(0.5, 0.4, 0.3)}},
                    {"pair", balls},
                    {"gem", gem_shape},
                    {"floor", PlaneShape{}},
                    {"slab", mesh}};
}

BodyDescription body_of(Kind kind, const Vec3& position, const Quat& turn = Quat::Identity())
{
    BodyDescription body;
    body.shape = kind;
    body.position = position;
    body.orientation = turn;
    if (kind == floor_ || kind == slab) body.motion = Motion::static_;
    return body;
}

// A world strewn with bodies, and the same as distances.
struct Strewn {
    Scene scene;
    std::vector<Kind> kind;

    Strewn(std::uint64_t seed, const Vec3& middle, std::size_t count)
    {
        Dice dice(seed);
        add_shapes(scene);
        for (std::size_t i = 0; i < count; ++i) {
            const auto next = static_cast<Kind>(i % 8);
            kind.push_back(i == 0 ? floor_ : next == floor_ ? crate : next);
            BodyDescription body = body_of(kind.back(), middle + dice.point(6), dice.turn());
            if (i == 0) body.position.z() = middle.z() - 7;
            if (i == 0) body.orientation = Quat::Identity();
            if (i % 5 == 0) body.motion = Motion::static_;
            body.group = 1u << (i % 3);
            scene.bodies.push_back(body);
        }
    }

    double distance(std::size_t body, const Vec3& point, std::uint32_t mask = ~0u) const
    {
        const BodyDescription& at = scene.bodies[body];
        if ((at.group & mask) == 0) return kInfinity;
        return distance_of(kind[body])(at.orientation.conjugate() * (point - at.position));
    }
    double distance(const Vec3& point, std::uint32_t mask) const
    {
        double least = kInfinity;
        for (std::size_t i = 0; i < kind.size(); ++i)
            least = std::min(least, distance(i, point, mask));
        return least;
    }
};

RayQuery random_ray(Dice& dice, const Vec3& middle, int i)
{
    RayQuery ray;
    ray.origin = middle + dice.point(i % 3 == 0 ? 20 : 6);
    ray.direction = (middle + dice.point(6) - ray.origin) * std::pow(10.0, dice.between(-9, 9));
    if (i % 4 == 0) ray.max_distance = dice.between(0, 10);
    if (i % 5 == 0) ray.mask = 1u << (i % 3);
    return ray;
}

TEST(Queries, RaysAgreeWithAMarchThroughAllBodies)
{
    for (const double far : {0.0, 1e6}) {
        const Vec3 middle = Vec3(1, -2, 0.5) * far;
        const Strewn strewn(5, middle, 60);
        const World world(strewn.scene);
        const std::vector<BodyId> ids = world.bodies();
        Dice dice(6);
        std::vector<RayQuery> rays;
        for (int i = 0; i < 1500; ++i) rays.push_back(random_ray(dice, middle, i));
        std::vector<RayHit> hits(rays.size());
        std::vector<std::uint8_t> blocked(rays.size());
        Queries queries(world);
        queries.cast_rays(rays, hits);
        queries.find_blocked(rays, blocked);
        const double close = 1e-9 + far * 1e-14;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Vec3 along = rays[i].direction.normalized();
            const double end = std::min(rays[i].max_distance, 60.0);
            // A slab has no inside: stepping by distances comes to rest on it all the same.
            double at = 0, closest = kInfinity;
            bool met = false;
            for (int step = 0; step < 3000 && at <= end && !met; ++step) {
                const double left = strewn.distance(rays[i].origin + along * at, rays[i].mask);
                closest = std::min(closest, left);
                met = left < close;
                if (!met) at += left;
            }
            SCOPED_TRACE("ray " + std::to_string(i) + " of seed 6, far " + std::to_string(far));
            EXPECT_EQ(blocked[i] != 0, hits[i].hit);
            if (hits[i].hit && hits[i].distance > 60) continue;
            if (met != hits[i].hit) {
                EXPECT_LT(closest, 1e-5) << "no mere graze";
                continue;
            }
            if (!met) continue;
            const double flat = std::max(1e-3, std::abs(hits[i].normal.dot(along)));
            ASSERT_NEAR(hits[i].distance, at, 4 * close / flat);
            ASSERT_NEAR(hits[i].normal.norm(), 1, 1e-12);
            ASSERT_LE(hits[i].normal.dot(along), 1e-12);
            ASSERT_LT((hits[i].point - rays[i].origin - along * hits[i].distance).norm(), close);
            const auto body = std::find(ids.begin(), ids.end(), hits[i].body) - ids.begin();
            ASSERT_LT(std::abs(hits[i].distance > 0
                                   ? strewn.distance(static_cast<std::size_t>(body), hits[i].point)
                                   : 0),
                      2 * close);
        }
    }
}

TEST(Queries, NearestAgreesWithTheLeastOfAllDistances)
{
    const Strewn strewn(8, Vec3::Zero(), 60);
    const World world(strewn.scene);
    const std::vector<BodyId> ids = world.bodies();
    Dice dice(9);
    std::vector<PointQuery> points;
    for (int i = 0; i < 2000; ++i) {
        PointQuery point;
        point.point = dice.point(i % 3 == 0 ? 100 : i % 31 == 0 ? 1e7 : 7);
        if (i % 4 == 0) point.max_distance = dice.between(0, 3);
        if (i % 5 == 0) point.mask = 1u << (i % 3);
        points.push_back(point);
    }
    std::vector<NearestHit> nearest(points.size());
    Queries(world).find_nearest(points, nearest);
    for (std::size_t i = 0; i < points.size(); ++i) {
        SCOPED_TRACE("point " + std::to_string(i) + " of seed 9");
        const Vec3& point = points[i].point;
        const double wanted = std::max(0.0, strewn.distance(point, points[i].mask));
        const double close = 1e-12 * (10 + point.norm());
        if (std::abs(wanted - points[i].max_distance) < close) continue;
        ASSERT_EQ(nearest[i].found, wanted <= points[i].max_distance);
        if (!nearest[i].found) continue;
        ASSERT_NEAR(nearest[i].distance, wanted, close);
        ASSERT_NEAR((nearest[i].point - point).norm(), wanted, close);
        const auto body = std::find(ids.begin(), ids.end(), nearest[i].body) - ids.begin();
        const double off = strewn.distance(static_cast<std::size_t>(body), nearest[i].point);
        ASSERT_LT(wanted > 0 ? std::abs(off) : off, close);
    }
}

// Points of a shape, 7 a side, as a share of its sizes.
std::vector<Vec3> points_within(const QueryShape& shape)
{
    const auto* box = std::get_if<BoxShape>(&shape);
    const auto* pill = std::get_if<CapsuleShape>(&shape);
    const auto* can = std::get_if<CylinderShape>(&shape);
    std::vector<Vec3> points;
    for (int i = 0; i < 343; ++i) {
        Vec3 at = Vec3(i % 7, i / 7 % 7, i / 49) / 3 - Vec3::Ones();
        if (box) {
            points.push_back(at.cwiseProduct(box->half_extents));
            continue;
        }
        // The cube is drawn in to a ball, or to a disk at each height.
        const double speculative_margin = can ? at.head<2>().norm() : at.norm();
        const double widest = can ? at.head<2>().cwiseAbs().maxCoeff() : at.cwiseAbs().maxCoeff();
        const double by = speculative_margin > 0 ? widest / speculative_margin : 0;
        if (can) {
            points.emplace_back(at.x() * by * can->radius, at.y() * by * can->radius,
                                at.z() * can->half_length);
            continue;
        }
        at *= by;
        const double radius = pill ? pill->radius : std::get<SphereShape>(shape).radius;
        for (const double end : {-1.0, 0.0, 1.0})
            points.push_back(at * radius + Vec3(0, 0, pill ? end * pill->half_length : 0));
    }
    return points;
}

bool runs_through_slab(const std::vector<Vec3>& points,
                       const BodyDescription& body,
                       const Pose& pose)
{
    std::vector<Vec3> seen;
    for (const Vec3& point : points)
        seen.push_back(body.orientation.conjugate() * (pose * point - body.position));
    for (const Vec3& a : seen)
        for (const Vec3& b : {seen.front(), seen[seen.size() / 2], seen.back()}) {
            if (!(a.z() < 0 && b.z() > 0)) continue;
            const Vec3 at = a + (b - a) * (a.z() / (a.z() - b.z()));
            if (std::abs(at.x()) < 2 && std::abs(at.y()) < 1.5) return true;
        }
    return false;
}

TEST(Queries, OverlapsAgreeWithPointsWithinTheShape)
{
    const Strewn strewn(12, Vec3::Zero(), 150);
    const World world(strewn.scene);
    const std::vector<BodyId> ids = world.bodies();
    Dice dice(13);
    const std::vector<QueryShape> kinds_asked = {SphereShape{0.6}, SphereShape{0.0},
                                                 CapsuleShape{0.3, 0.7}, CylinderShape{0.5, 0.4},
                                                 BoxShape{Vec3(0.7, 0.2, 0.5)}};
    std::vector<ShapeQuery> asked;
    for (int i = 0; i < 200; ++i)
        asked.push_back({kinds_asked[static_cast<std::size_t>(i) % kinds_asked.size()],
                         {dice.point(5), dice.turn()},
                         i % 5 == 0 ? 1u << (i % 3) : ~0u});
    const auto found = Queries(world).find_overlaps(asked);
    constexpr double kApart = 0.2;
    int disputed = 0, overlaps = 0;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        const auto& bodies = found[i];
        ASSERT_TRUE(std::is_sorted(bodies.begin(), bodies.end(),
                                   [](BodyId a, BodyId b) { return a.index < b.index; }));
        ASSERT_EQ(std::adjacent_find(bodies.begin(), bodies.end()), bodies.end());
        const std::vector<Vec3> points = points_within(asked[i].shape);
        for (std::size_t body = 0; body < ids.size(); ++body) {
            // None of the shapes is larger than 1.5 m.
            if (strewn.distance(body, asked[i].pose.position) > 1.5) {
                ASSERT_EQ(std::find(bodies.begin(), bodies.end(), ids[body]), bodies.end());
                continue;
            }
            double least = kInfinity;
            for (const Vec3& point : points)
                least =
                    std::min(least, strewn.distance(body, asked[i].pose * point, asked[i].mask));
            // A slab has no inside, but a line between two points may run through it.
            if (least < kApart && strewn.kind[body] == slab
                && runs_through_slab(points, strewn.scene.bodies[body], asked[i].pose))
                least = -1;
            const bool in = std::find(bodies.begin(), bodies.end(), ids[body]) != bodies.end();
            overlaps += in ? 1 : 0;
            SCOPED_TRACE("shape " + std::to_string(i) + ", body " + std::to_string(body));
            // Every point of a shape has one of those tried this near.
            ASSERT_TRUE(in || least >= 0);
            ASSERT_TRUE(!in || least <= kApart);
            disputed += least >= 0 && least <= kApart ? 1 : 0;
        }
    }
    EXPECT_GT(overlaps, 80);
    EXPECT_LT(disputed, overlaps);
}

// Balls from 1 mm to 100 m, some far from all others: searches that go on for many rounds.
TEST(Queries, FindAmongAllSizesWhatTheFormulaOfABallFinds)
{
    Dice dice(31);
    Scene scene;
    std::vector<double> radius;
    for (std::uint32_t i = 0; i < 1500; ++i) {
        radius.push_back(std::pow(10.0, dice.between(-3, 2)));
        scene.shapes.push_back({"", SphereShape{radius.back()}});
        BodyDescription body;
        body.shape = i;
        body.position = dice.point(i % 50 == 0 ? 1e5 : 500);
        scene.bodies.push_back(body);
    }
    const World world(scene);
    std::vector<RayQuery> rays;
    std::vector<PointQuery> points;
    for (std::size_t i = 0; i < 1000; ++i) {
        RayQuery& ray = rays.emplace_back();
        ray.origin = dice.point(i % 3 == 0 ? 2e5 : 600);
        const std::size_t aim = i * 7 % radius.size();
        ray.direction = scene.bodies[aim].position + dice.point(1.2 * radius[aim]) - ray.origin;
        if (i % 4 == 0) ray.max_distance = dice.between(0, 2e3);
        points.push_back({ray.origin, ray.max_distance});
    }
    std::vector<RayHit> hits(rays.size());
    std::vector<NearestHit> nearest(points.size());
    Queries queries(world);
    queries.cast_rays(rays, hits);
    queries.find_nearest(points, nearest);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE("question " + std::to_string(i) + " of seed 31");
        const Vec3 along = rays[i].direction.normalized();
        double first = kInfinity, least = kInfinity, graze = kInfinity;
        for (std::size_t k = 0; k < radius.size(); ++k) {
            const Vec3 to = scene.bodies[k].position - rays[i].origin;
            const double over = std::max(0.0, to.norm() - radius[k]);
            if (over <= rays[i].max_distance) least = std::min(least, over);
            const double beside = to.cross(along).norm();
            graze = std::min(graze, std::abs(beside - radius[k]));
            if (beside > radius[k]) continue;
            const double half = std::sqrt(radius[k] * radius[k] - beside * beside);
            const double enter = std::max(0.0, to.dot(along) - half);
            if (to.dot(along) + half >= 0 && enter <= rays[i].max_distance)
                first = std::min(first, enter);
        }
        ASSERT_EQ(nearest[i].found, least < kInfinity);
        ASSERT_NEAR(nearest[i].found ? nearest[i].distance : 0, nearest[i].found ? least : 0, 1e-9);
        if (graze < 1e-8) continue;
        ASSERT_EQ(hits[i].hit, first < kInfinity);
        ASSERT_NEAR(hits[i].hit ? hits[i].distance : 0, hits[i].hit ? first : 0, 1e-6);
    }
}

TEST(Queries, AnswersDoNotDependOnThreads)
{
    const Strewn strewn(15, Vec3::Zero(), 200);
    Dice dice(16);
    std::vector<RayQuery> rays;
    for (int i = 0; i < 3000; ++i) rays.push_back(random_ray(dice, Vec3::Zero(), i));
    std::vector<std::vector<double>> numbers;
    for (const int threads : {1, 3}) {
        const World world(strewn.scene, threads);
        Queries queries(world);
        std::vector<RayHit> hits(rays.size());
        queries.cast_rays(rays, hits);
        std::vector<PointQuery> points;
        std::vector<ShapeQuery> shapes;
        for (const RayQuery& ray : rays) {
            points.push_back({ray.origin, ray.max_distance, ray.mask});
            shapes.push_back(
                {BoxShape{Vec3(1, 0.2, 0.3)}, {ray.origin, Quat::Identity()}, ray.mask});
        }
        std::vector<NearestHit> nearest(points.size());
        queries.find_nearest(points, nearest);
        auto& list = numbers.emplace_back();
        for (const RayHit& hit : hits)
            list.insert(list.end(),
                        {double(hit.body.index), hit.distance, hit.normal.x(), hit.normal.y(),
                         hit.point.z(), double(hit.part)});
        for (const NearestHit& hit : nearest)
            list.insert(list.end(), {double(hit.body.index), hit.distance, hit.point.x()});
        for (const auto& bodies : queries.find_overlaps(shapes))
            for (const BodyId body : bodies) list.push_back(body.index);
    }
    ASSERT_EQ(numbers[0].size(), numbers[1].size());
    EXPECT_EQ(std::memcmp(numbers[0].data(), numbers[1].data(), numbers[0].size() * sizeof(double)),
              0);
}

World world_of(std::vector<BodyDescription> bodies)
{
    Scene scene;
    add_shapes(scene);
    scene.bodies = std::move(bodies);
    return World(scene);
}

TEST(Queries, OfEqualsTheSmallerIdAnswers)
{
    const Vec3 at(1, 2, 3);
    const World world = world_of({body_of(can, at + Vec3(9, 0, 0)), body_of(ball, at),
                                  body_of(ball, at), body_of(ball, at)});
    Queries queries(world);
    EXPECT_EQ(queries.cast_ray({at + Vec3(0, 5, 0), -Vec3::UnitY()}).body.index, 1u);
    EXPECT_EQ(queries.cast_ray({at, -Vec3::UnitY()}).body.index, 1u);
    EXPECT_EQ(queries.find_nearest({at + Vec3(0, 5, 0)}).body.index, 1u);
    EXPECT_EQ(queries.find_nearest({at}).body.index, 1u);
    EXPECT_EQ(queries.find_overlaps({SphereShape{0.1}, {at, Quat::Identity()}}).size(), 3u);
}

TEST(Queries, NamesThePartOfACompoundAndTheBodyOnce)
{
    const World world = world_of({body_of(pair, Vec3::Zero())});
    Queries queries(world);
    EXPECT_EQ(queries.cast_ray({Vec3(0, 0, 5), -Vec3::UnitZ()}).part, 0u);
    EXPECT_EQ(queries.cast_ray({Vec3(0, 0, -5), Vec3::UnitZ()}).part, 1u);
    EXPECT_EQ(queries.find_nearest({Vec3(0, 0, -5)}).part, 1u);
    EXPECT_EQ(queries.find_overlaps({SphereShape{3}, Pose{}}).size(), 1u);
}

TEST(Queries, BeginningInsideHitsAtNoDistanceAgainstTheDirection)
{
    const World world = world_of({body_of(crate, Vec3(4, 0, 0), Quat(0.6, 0, 0.8, 0))});
    const RayHit hit = Queries(world).cast_ray({Vec3(4.1, 0, 0), Vec3(0, 3, 4)});
    ASSERT_TRUE(hit.hit);
    EXPECT_EQ(hit.distance, 0);
    EXPECT_EQ(hit.point, Vec3(4.1, 0, 0));
    EXPECT_LT((hit.normal - Vec3(0, -0.6, -0.8)).norm(), 1e-14);
}

TEST(Queries, SleepingAndStaticBodiesAreFoundAndRemovedOnesAreNot)
{
    World world = world_of({body_of(floor_, Vec3::Zero()), body_of(crate, Vec3(0, 0, 0.3)),
                            body_of(slab, Vec3(10, 0, 1))});
    const std::vector<BodyId> ids = world.bodies();
    for (int i = 0; i < 600 && world.awake(ids[1]); ++i) world.step();
    ASSERT_FALSE(world.awake(ids[1]));
    Queries asleep(world);
    const RayQuery down{Vec3(0, 0, 5), -Vec3::UnitZ()};
    EXPECT_EQ(asleep.cast_ray(down).body, ids[1]);
    EXPECT_NEAR(asleep.cast_ray(down).distance, 4.4, 1e-3);
    EXPECT_EQ(asleep.cast_ray({Vec3(10, 0, 5), -Vec3::UnitZ()}).body, ids[2]);
    world.remove(std::span(&ids[1], 1));
    Queries after(world);
    EXPECT_EQ(after.cast_ray(down).body, ids[0]);
    EXPECT_EQ(after.cast_ray(down).distance, 5);
    EXPECT_TRUE(
        after.find_overlaps({SphereShape{0.1}, {Vec3(0, 0, 0.3), Quat::Identity()}}).empty());

    // The place is taken again: by another body, of another generation.
    Scene more;
    add_shapes(more);
    more.bodies = {body_of(ball, Vec3(0, 0, 2))};
    const BodyId added = world.add(more).front();
    ASSERT_EQ(added.index, ids[1].index);
    EXPECT_EQ(Queries(world).cast_ray(down).body, added);
    EXPECT_EQ(after.cast_ray(down).body, added) << "answers for the world as it is";
}

// Heaps that fall, sleep and are stirred up; bodies come, go and are moved between steps.
void go_on(World& world, int step)
{
    const std::vector<BodyId> ids = world.bodies();
    if (step % 40 == 10) {
        Scene more;
        add_shapes(more);
        for (int i = 0; i < 30; ++i)
            more.bodies.push_back(
                body_of(i % 2 == 0 ? ball : pair, Vec3(0.9 * (i % 6) - 2, 0.9 * (i / 6) - 2, 4)));
        world.add(more);
    }
    if (step % 40 == 25) world.remove(std::span(&ids[ids.size() / 3], 7));
    if (step % 15 == 5) world.set_pose(ids[ids.size() / 2], {Vec3(1, 1, 6), Quat::Identity()});
    if (step % 60 == 50) world.set_velocity(ids.back(), Vec3(3, 1, 4), Vec3(0, 5, 0));
    world.step(step % 7 == 3 ? 2 : 1);
}

World heaps()
{
    std::vector<BodyDescription> bodies = {body_of(floor_, Vec3::Zero()),
                                           body_of(slab, Vec3(9, 0, 1))};
    for (int i = 0; i < 300; ++i)
        bodies.push_back(body_of(std::array{ball, crate, pill}[std::size_t(i % 3)],
                                 Vec3(1.6 * (i % 10) - 8, 1.6 * (i / 10 % 10) - 8, 0.6 + i / 100)));
    return world_of(bodies);
}

TEST(Queries, AskedAgainAndAgainTheyAnswerAsWhenAskedOnce)
{
    Dice dice(7);
    World asked_often = heaps();
    Queries often(asked_often);
    int step = 0;
    for (const int until : {1, 12, 30, 90, 150, 240}) {
        for (; step < until; ++step) {
            go_on(asked_often, step);
            static_cast<void>(often.cast_ray({Vec3(0, 0, 9), -Vec3::UnitZ()}));
        }
        World asked_once = heaps();
        for (int k = 0; k < until; ++k) go_on(asked_once, k);
        Queries once(asked_once);
        for (int i = 0; i < 300; ++i) {
            const Vec3 from(dice.between(-9, 9), dice.between(-9, 9), dice.between(0, 6));
            const RayQuery ray{from, Vec3(dice.between(-1, 1), dice.between(-1, 1), -0.3)};
            const RayHit a = often.cast_ray(ray), b = once.cast_ray(ray);
            ASSERT_EQ(a.body, b.body) << "step " << until;
            ASSERT_EQ(a.distance, b.distance);
            ASSERT_EQ(a.part, b.part);
            ASSERT_EQ(often.find_nearest({from}).distance, once.find_nearest({from}).distance);
            const ShapeQuery region{SphereShape{0.7}, {from, Quat::Identity()}};
            ASSERT_EQ(often.find_overlaps(region), once.find_overlaps(region));
        }
    }
}

TEST(Queries, AnEmptyWorldHasNoAnswers)
{
    const World world;
    Queries queries(world);
    EXPECT_FALSE(queries.cast_ray({}).hit);
    EXPECT_FALSE(queries.blocked({}));
    EXPECT_FALSE(queries.find_nearest(PointQuery{}).found);
    EXPECT_TRUE(queries.find_overlaps({SphereShape{1}, Pose{}}).empty());
}

TEST(Queries, FromFarAwayBodiesAreStillMet)
{
    const World world = world_of({body_of(crate, Vec3::Zero()), body_of(slab, Vec3(0, 0, -3))});
    Queries queries(world);
    for (const double far : {1e3, 1e5, 1e7}) {
        const RayHit hit = queries.cast_ray({Vec3(0, 0, far), -Vec3::UnitZ()});
        EXPECT_EQ(hit.body.index, 0u);
        EXPECT_DOUBLE_EQ(hit.distance, far - 0.3);
        EXPECT_EQ(hit.normal, Vec3::UnitZ());
        const RayHit beside = queries.cast_ray({Vec3(1.5, 0, far), -Vec3::UnitZ()});
        EXPECT_EQ(beside.body.index, 1u);
        EXPECT_DOUBLE_EQ(beside.distance, far + 3);
        EXPECT_NEAR(queries.find_nearest({Vec3(0, 0, far)}).distance, far - 0.3, far * 1e-15);
        EXPECT_FALSE(queries.blocked({Vec3(0, 0, far), Vec3::UnitZ()}));
        EXPECT_FALSE(queries.blocked({Vec3(0, 0, far), -Vec3::UnitZ(), far - 1}));
    }
}

template <class Ask>
std::string refusal(const Ask& ask)
{
    try {
        ask();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return {};
}

TEST(Queries, RefusesWhatIsNoQuestionAndSaysWhich)
{
    const World world = world_of({body_of(ball, Vec3::Zero())});
    Queries queries(world);
    const double nan = std::nan("");
    std::vector<RayQuery> rays(3);
    std::vector<RayHit> hits(3);
    const auto refused = [&](const RayQuery& ray) {
        rays[1] = ray;
        return refusal([&] { queries.cast_rays(rays, hits); });
    };
    EXPECT_NE(refused({Vec3::Zero(), Vec3::Zero()}).find("cast_rays: question 1: direction"),
              std::string::npos);
    EXPECT_NE(refused({Vec3::Zero(), Vec3(0, nan, 1)}).find("direction"), std::string::npos);
    EXPECT_NE(refused({Vec3(kInfinity, 0, 0), Vec3::UnitX()}).find("origin"), std::string::npos);
    EXPECT_NE(refused({Vec3::Zero(), Vec3::UnitX(), -1}).find("max_distance"), std::string::npos);
    EXPECT_NE(refused({Vec3::Zero(), Vec3::UnitX(), nan}).find("max_distance"), std::string::npos);
    EXPECT_EQ(refused({Vec3::Zero(), Vec3::UnitX() * 1e-310}), "");
    EXPECT_EQ(refused({Vec3::Zero(), Vec3::UnitX() * 1e300}), "");
    EXPECT_NE(
        refusal([&] { queries.cast_rays(rays, std::span(hits).first(2)); }).find("room for 2"),
        std::string::npos);
    EXPECT_NE(refusal([&] { queries.find_nearest({Vec3(0, 0, nan)}); }).find("point"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                  queries.find_overlaps({SphereShape{-1}, Pose{}});
              }).find("sizes"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                  queries.find_overlaps({SphereShape{1}, {Vec3::Zero(), Quat(2, 0, 0, 0)}});
              }).find("unit quaternion"),
              std::string::npos);
}

}  // namespace
}  // namespace throng::test
