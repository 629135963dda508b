// Sweep: every width against the scalar one to the last bit, the scalar one against the textbook,
// and what no visit may do.
#include "tests/kernels/solve/random_contacts.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace throng {
namespace {

using testing::BlockCase;
using testing::BlockWish;
using testing::random_block;

// A body as a textbook has it.
struct PlainBody {
    Vec3 velocity, spin, moved;
    Mat3 turn;
    double inverse_mass = 0;
    Mat3 inverse_inertia;
    bool written = false;

    template <class Real>
    PlainBody(const SolverBody<Real>& body, bool may_write) : written(may_write)
    {
        const auto vec = [](const Real* from) {
            return Vec3(double{from[0]}, double{from[1]}, double{from[2]});
        };
        velocity = vec(body.motion);
        spin = vec(body.motion + 4);
        moved = vec(body.drift);
        turn = Quat(double{body.drift[7]}, double{body.drift[4]}, double{body.drift[5]},
                    double{body.drift[6]})
                   .toRotationMatrix();
        inverse_mass = double{body.inertia[0]};
        inverse_inertia =
            Sym3{double{body.inertia[1]}, double{body.inertia[2]}, double{body.inertia[3]},
                 double{body.inertia[4]}, double{body.inertia[5]}, double{body.inertia[6]}}
                .matrix();
    }
    Vec3 velocity_at(const Vec3& arm) const { return velocity + spin.cross(arm); }
    void push(const Vec3& impulse, const Vec3& arm)
    {
        velocity += inverse_mass * impulse;
        spin += inverse_inertia * arm.cross(impulse);
    }
    void twist(const Vec3& impulse) { spin += inverse_inertia * impulse; }
};

struct PlainVisit {
    double substep = 0, push_limit = 0;
    bool push = false, grips = true, rolls = false;
    int normal_sweeps = 1;
};

// One contact, solved by the formulas of the textbook in double, everything computed afresh.
class PlainContact {
public:
    template <class Real>
    PlainContact(const Contact<Real>& contact,
                 const ContactTerms<Real>& terms,
                 const PlainBody& body_a,
                 const PlainBody& body_b)
        : a(body_a), b(body_b), normal(contact.normal.template cast<double>()),
          friction_impulse(contact.friction.template cast<double>()),
          rolling_impulse(contact.rolling.template cast<double>()), twist_impulse(contact.twist),
          friction(terms.friction), restitution(terms.restitution), rolling(terms.rolling_friction),
          bias_rate(terms.softness.bias_rate), impulse_scale(terms.softness.impulse_scale),
          deep(terms.deep)
    {
        for (int k = 0; k < contact.count; ++k) {
            const auto& from = contact.points[static_cast<std::size_t>(k)];
            Point point;
            point.arm_a = from.from_a.template cast<double>();
            point.arm_b = from.from_b.template cast<double>();
            point.separation = from.separation;
            point.impulse = from.impulse;
            point.approach = normal.dot(b.velocity_at(point.arm_b) - a.velocity_at(point.arm_a));
            center_a += point.arm_a / contact.count;
            center_b += point.arm_b / contact.count;
            points.push_back(point);
        }
    }

    void warm_start(const PlainVisit& visit)
    {
        for (const Point& point : points) apply(point.impulse * normal, point.arm_a, point.arm_b);
        if (!visit.grips) return;
        apply(friction_impulse, center_a, center_b);
        twist(twist_impulse * normal);
        if (visit.rolls) twist(rolling_impulse);
    }

    void sweep(const PlainVisit& visit)
    {
        // Aims are those of the visit's beginning; friction comes before the last round of pushes.
        int overlapping = 0;
        for (Point& point : points) overlapping += separation_of(point) < 0 ? 1 : 0;
        for (Point& point : points) aim(point, visit, overlapping);
        for (int i = 1; i < visit.normal_sweeps; ++i)
            for (Point& point : points) push(point);
        if (visit.grips) hold(visit);
        for (Point& point : points) push(point);
    }

    void hold(const PlainVisit& visit)
    {
        double total = 0, lever = 0;
        for (const Point& point : points) {
            total += point.impulse;
            lever += point.impulse * (point.arm_a - center_a).norm();
        }
        const Mat3 turning = a.inverse_inertia + b.inverse_inertia;
        if (visit.rolls) {
            const Vec3 before = rolling_impulse;
            rolling_impulse -= (b.spin - a.spin) / turning.trace();
            const double most = rolling * total;
            if (rolling_impulse.norm() > most) rolling_impulse *= most / rolling_impulse.norm();
            twist(rolling_impulse - before);
        }
        if (points.size() > 1 && turning.trace() > 0) {
            const double before = twist_impulse;
            const double mass = 1 / normal.dot(turning * normal);
            twist_impulse -= mass * normal.dot(b.spin - a.spin);
            twist_impulse = std::clamp(twist_impulse, -friction * lever, friction * lever);
            twist((twist_impulse - before) * normal);
        }
        grip(friction * total);
    }

    void restitute(double threshold)
    {
        for (Point& point : points) {
            if (!(point.approach < -threshold) || point.greatest <= 0 || restitution <= 0) continue;
            const double speed =
                normal.dot(b.velocity_at(point.arm_b) - a.velocity_at(point.arm_a));
            const double before = point.impulse;
            point.impulse =
                std::max(0.0, before - mass_of(point) * (speed + restitution * point.approach));
            apply((point.impulse - before) * normal, point.arm_a, point.arm_b);
        }
    }

    struct Point {
        Vec3 arm_a, arm_b;
        double separation = 0, impulse = 0, approach = 0, greatest = 0, bias = 0, leak = 0;
    };
    PlainBody a, b;
    Vec3 normal;
    std::vector<Point> points;
    Vec3 center_a = Vec3::Zero(), center_b = Vec3::Zero();
    Vec3 friction_impulse, rolling_impulse;
    double twist_impulse;

private:
    void apply(const Vec3& impulse, const Vec3& arm_a, const Vec3& arm_b)
    {
        a.push(-impulse, arm_a);
        b.push(impulse, arm_b);
    }
    void twist(const Vec3& impulse)
    {
        a.twist(-impulse);
        b.twist(impulse);
    }
    // What answers an impulse p at the arms with velocity: the matrix of the textbook.
    Mat3 response(const Vec3& arm_a, const Vec3& arm_b) const
    {
        const auto cross = [](const Vec3& v) {
            Mat3 m;
            m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
            return m;
        };
        return (a.inverse_mass + b.inverse_mass) * Mat3::Identity()
            - cross(arm_a) * a.inverse_inertia * cross(arm_a)
            - cross(arm_b) * b.inverse_inertia * cross(arm_b);
    }
    double mass_of(const Point& point) const
    {
        return 1 / normal.dot(response(point.arm_a, point.arm_b) * normal);
    }
    double separation_of(const Point& point) const
    {
        const Vec3 moved_a = a.moved + a.turn * point.arm_a - point.arm_a;
        const Vec3 moved_b = b.moved + b.turn * point.arm_b - point.arm_b;
        return point.separation + normal.dot(moved_b - moved_a);
    }
    void aim(Point& point, const PlainVisit& visit, int overlapping) const
    {
        const double separation = separation_of(point);
        point.leak = 0;
        point.bias = separation > 0 ? separation / visit.substep : 0;
        if (separation > 0 || !visit.push) return;
        // Three points share a load: they may go three times as deep before they turn rigid.
        const double turns_rigid = deep * (overlapping >= 3 ? 3 : 1);
        const double depth = deep > 0 ? -separation / turns_rigid : 0;
        point.leak = impulse_scale * std::clamp(2 - depth, 0.0, 1.0);
        point.bias = std::max(bias_rate * separation, -visit.push_limit);
    }
    void push(Point& point)
    {
        const double speed = normal.dot(b.velocity_at(point.arm_b) - a.velocity_at(point.arm_a));
        const double before = point.impulse;
        point.impulse = std::max(0.0,
                                 before - mass_of(point) * (1 - point.leak) * (speed + point.bias)
                                     - point.leak * before);
        point.greatest = std::max(point.greatest, point.impulse);
        apply((point.impulse - before) * normal, point.arm_a, point.arm_b);
    }
    void grip(double most)
    {
        // Two axes across the normal, any two.
        const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
        Eigen::Matrix<double, 3, 2> plane;
        plane << u, v;
        const Eigen::Matrix2d k = plane.transpose() * response(center_a, center_b) * plane;
        const Eigen::Vector2d slip =
            plane.transpose() * (b.velocity_at(center_b) - a.velocity_at(center_a));
        const Eigen::Vector2d before = plane.transpose() * friction_impulse;
        Eigen::Vector2d after = before - k.inverse() * slip;
        if (after.norm() > most) {
            const double stiffest =
                Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(k).eigenvalues()[1];
            after = before - slip / stiffest;
            if (after.norm() > most) after *= most / after.norm();
        }
        friction_impulse = plane * after;
        apply(plane * (after - before), center_a, center_b);
    }

    double friction, restitution, rolling, bias_rate, impulse_scale, deep;
};

template <class Real>
Visit<Real> random_visit(std::mt19937& random)
{
    Visit<Real> visit;
    visit.inverse_substep = 240;
    visit.push_limit = 3;
    visit.push = random() % 2 == 0;
    visit.turns = random() % 4 != 0;
    visit.grips = random() % 4 != 0;
    visit.rolls = random() % 2 == 0;
    visit.normal_sweeps = 1 + static_cast<int>(random() % 3);
    return visit;
}

// A substep's worth of visits.
template <class Real>
void run_all(const SolveKernels<Real>& kernels, BlockCase<Real>& made, const Visit<Real>& visit)
{
    kernels.warm_start(&made.block, 1, made.bodies.data(), visit);
    kernels.sweep(&made.block, 1, made.bodies.data(), visit);
    Visit<Real> relax = visit;
    relax.push = !visit.push;
    kernels.sweep(&made.block, 1, made.bodies.data(), relax);
    kernels.restitute(&made.block, 1, made.bodies.data(), Real(0.5), visit);
}

template <class Real>
bool same_bits(const BlockCase<Real>& x, const BlockCase<Real>& y)
{
    const auto tail = [](const ContactBlock<Real>& block) {
        return reinterpret_cast<const char*>(&block.normal);
    };
    const auto size =
        static_cast<std::size_t>(reinterpret_cast<const char*>(&x.block + 1) - tail(x.block));
    return std::memcmp(tail(x.block), tail(y.block), size) == 0
        && std::memcmp(x.bodies.data(), y.bodies.data(), x.bodies.size() * sizeof(SolverBody<Real>))
        == 0;
}

template <class Real>
void check_widths()
{
    const SolveKernels<Real>& scalar = *solve_kernels_of<Real>("scalar");
    EXPECT_EQ(scalar.lanes, 1);
    for (const char* width : {"avx2", "avx512"}) {
        const SolveKernels<Real>* const wide = solve_kernels_of<Real>(width);
        if (wide == nullptr) {
            std::printf("this machine has no %s\n", width);
            continue;
        }
        EXPECT_EQ(wide->lanes, (width == std::string("avx2") ? 32 : 64) / int(sizeof(Real)));
        for (unsigned seed = 0; seed < 100; ++seed)
            for (int lanes = 1; lanes <= kBlock; ++lanes)
                for (int points = 1; points <= 4; ++points) {
                    std::mt19937 random(seed * 100 + static_cast<unsigned>(4 * lanes + points));
                    const BlockWish wish{.lanes = lanes, .points = points};
                    BlockCase<Real> narrow = random_block<Real>(random, wish);
                    BlockCase<Real> broad = narrow;
                    const Visit<Real> visit = random_visit<Real>(random);
                    run_all(scalar, narrow, visit);
                    run_all(*wide, broad, visit);
                    ASSERT_TRUE(same_bits(narrow, broad))
                        << width << ", seed " << seed << ", " << lanes << " lanes, " << points
                        << " points";
                }
    }
}

TEST(Sweep, EveryWidthGivesTheSameBits)
{
    check_widths<float>();
    check_widths<double>();
}

TEST(Sweep, UnknownWidthsAreNotThere)
{
    EXPECT_EQ(solve_kernels_of<float>("mmx"), nullptr);
    EXPECT_EQ(solve_kernels_of<double>(""), nullptr);
    EXPECT_NE(solve_kernels_of<float>("scalar"), nullptr);
}

// The block and the textbook after the same visits.
template <class Real>
void check_against_textbook(double tolerance, bool turns)
{
    const SolveKernels<Real>& kernels = *solve_kernels_of<Real>("scalar");
    for (unsigned seed = 0; seed < 600; ++seed) {
        std::mt19937 random(seed);
        BlockWish wish{.lanes = 1 + static_cast<int>(seed % 16), .points = 1 + int(seed / 16 % 4)};
        BlockCase<Real> made = random_block<Real>(random, wish);
        if (!turns)
            for (auto& body : made.bodies) {
                for (int k = 4; k < 7; ++k) body.motion[k] = body.drift[k] = 0;
                for (int k = 1; k < 7; ++k) body.inertia[k] = 0;
                body.drift[7] = 1;
            }
        for (int lane = 0; lane < wish.lanes && !turns; ++lane) {
            const auto at = static_cast<std::size_t>(lane);
            // Nothing turns, so nothing may be held from turning.
            made.contacts[at].twist = 0;
            made.contacts[at].rolling.setZero();
            fill_lane(made.block, lane, made.contacts[at],
                      made.bodies[static_cast<std::size_t>(made.block.a[at])],
                      made.bodies[static_cast<std::size_t>(made.block.b[at])], made.terms[at]);
        }
        Visit<Real> visit = random_visit<Real>(random);
        visit.turns = turns;
        if (!turns) visit.rolls = false;
        PlainVisit plain{1 / 240.0, 3, visit.push, visit.grips, visit.rolls, visit.normal_sweeps};
        std::vector<PlainContact> wanted;
        for (int lane = 0; lane < wish.lanes; ++lane) {
            const auto at = static_cast<std::size_t>(lane);
            PlainContact contact(made.contacts[at], made.terms[at],
                                 PlainBody(made.bodies[static_cast<std::size_t>(made.block.a[at])],
                                           (made.block.writes_a >> lane & 1) != 0),
                                 PlainBody(made.bodies[static_cast<std::size_t>(made.block.b[at])],
                                           (made.block.writes_b >> lane & 1) != 0));
            contact.warm_start(plain);
            contact.sweep(plain);
            PlainVisit relax = plain;
            relax.push = !plain.push;
            contact.sweep(relax);
            contact.restitute(0.5);
            wanted.push_back(contact);
        }
        run_all(kernels, made, visit);
        for (int lane = 0; lane < wish.lanes; ++lane) {
            const auto at = static_cast<std::size_t>(lane);
            const PlainContact& plain_contact = wanted[at];
            const auto expect_body = [&](std::int32_t slot, const PlainBody& body) {
                if (!body.written) return;
                const PlainBody got(made.bodies[static_cast<std::size_t>(slot)], true);
                EXPECT_LE((got.velocity - body.velocity).norm(), tolerance);
                EXPECT_LE((got.spin - body.spin).norm(), 10 * tolerance);
            };
            expect_body(made.block.a[at], plain_contact.a);
            expect_body(made.block.b[at], plain_contact.b);
            Contact<Real> stored = made.contacts[at];
            store_impulses(made.block, lane, stored);
            double got_total = 0, wanted_total = 0;
            for (std::size_t k = 0; k < plain_contact.points.size(); ++k) {
                got_total += double{stored.points[k].impulse};
                wanted_total += plain_contact.points[k].impulse;
                // What cannot turn does not care which of its points bears what.
                if (!turns) continue;
                EXPECT_NEAR(double{stored.points[k].impulse}, plain_contact.points[k].impulse,
                            tolerance);
            }
            EXPECT_NEAR(got_total, wanted_total, 4 * tolerance);
            const Vec3 friction = stored.friction.template cast<double>();
            EXPECT_LE((friction - plain_contact.friction_impulse).norm(), tolerance);
            EXPECT_NEAR(double{stored.twist}, plain_contact.twist_impulse, tolerance);
            if (::testing::Test::HasFailure()) FAIL() << "seed " << seed << " lane " << lane;
        }
    }
}

TEST(Sweep, AgreesWithTheTextbook)
{
    check_against_textbook<double>(1e-12, true);
    check_against_textbook<double>(1e-12, false);
    check_against_textbook<float>(5e-4, true);
    check_against_textbook<float>(5e-4, false);
}

struct Momentum {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

// Of all bodies that have mass, about the origin.
template <class Real>
Momentum momentum_of(const BlockCase<Real>& made)
{
    Momentum sum;
    for (std::size_t i = 0; i < made.bodies.size(); ++i) {
        const PlainBody body(made.bodies[i], false);
        if (body.inverse_mass <= 0) continue;
        const Vec3 linear = body.velocity / body.inverse_mass;
        sum.linear += linear;
        sum.angular += made.positions[i].cross(linear) + body.inverse_inertia.inverse() * body.spin;
    }
    return sum;
}

template <class Real>
void check_momentum(double tolerance)
{
    for (unsigned seed = 0; seed < 300; ++seed) {
        std::mt19937 random(seed);
        BlockCase<Real> made = random_block<Real>(random, {.still = false});
        Visit<Real> visit = random_visit<Real>(random);
        visit.turns = true;
        const Momentum before = momentum_of(made);
        run_all(*solve_kernels_of<Real>("scalar"), made, visit);
        const Momentum after = momentum_of(made);
        ASSERT_LE((after.linear - before.linear).norm(), tolerance) << "seed " << seed;
        ASSERT_LE((after.angular - before.angular).norm(), tolerance) << "seed " << seed;
    }
}

TEST(Sweep, KeepsLinearAndAngularMomentum)
{
    check_momentum<float>(1e-3);
    check_momentum<double>(1e-12);
}

template <class Real>
void check_limits()
{
    const Real slack = 1 + 8 * std::numeric_limits<Real>::epsilon();
    for (unsigned seed = 0; seed < 500; ++seed) {
        std::mt19937 random(seed);
        BlockCase<Real> made = random_block<Real>(random, {});
        const BlockCase<Real> before = made;
        Visit<Real> visit = random_visit<Real>(random);
        visit.grips = visit.turns = visit.rolls = true;
        // With one round, friction goes by the normal impulses as they were.
        visit.normal_sweeps = 1;
        solve_kernels<Real>().sweep(&made.block, 1, made.bodies.data(), visit);
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            Real total = 0, lever = 0;
            for (int k = 0; k < made.block.points; ++k) {
                ASSERT_GE(made.block.point[k].impulse.at[lane], 0) << "seed " << seed;
                const Real impulse = before.block.point[k].impulse.at[lane];
                total += impulse;
                lever += impulse * made.block.reach[k].at[lane];
            }
            const Real friction = made.block.friction.at[lane];
            const Real f = std::hypot(made.block.friction_impulse[0].at[lane],
                                      made.block.friction_impulse[1].at[lane]);
            ASSERT_LE(f, friction * total * slack) << "seed " << seed;
            if (made.block.points > 1) {
                ASSERT_LE(std::abs(made.block.twist_impulse.at[lane]), friction * lever * slack);
            }
            const Vec3T<Real> rolling(made.block.rolling_impulse[0].at[lane],
                                      made.block.rolling_impulse[1].at[lane],
                                      made.block.rolling_impulse[2].at[lane]);
            ASSERT_LE(rolling.norm(), made.block.rolling.at[lane] * total * slack);
        }
    }
}

TEST(Sweep, ContactsNeverPullAndFrictionStaysInItsCone)
{
    check_limits<float>();
    check_limits<double>();
}

template <class Real>
void check_untouched()
{
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const int lanes = static_cast<int>(seed % kBlock);
        BlockCase<Real> made = random_block<Real>(random, {.lanes = lanes});
        const BlockCase<Real> before = made;
        run_all(solve_kernels<Real>(), made, random_visit<Real>(random));
        std::vector<bool> written(made.bodies.size(), false);
        for (int lane = 0; lane < kBlock; ++lane) {
            const auto at = static_cast<std::size_t>(lane);
            if ((made.block.writes_a >> lane & 1) != 0)
                written[static_cast<std::size_t>(made.block.a[at])] = true;
            if ((made.block.writes_b >> lane & 1) != 0)
                written[static_cast<std::size_t>(made.block.b[at])] = true;
        }
        ASSERT_FALSE(written[0]);
        ASSERT_FALSE(written[2 * kBlock + 1]);
        for (std::size_t i = 0; i < made.bodies.size(); ++i)
            ASSERT_TRUE(written[i]
                        || std::memcmp(&made.bodies[i], &before.bodies[i], sizeof made.bodies[i])
                            == 0)
                << "seed " << seed << " body " << i;
        for (int lane = lanes; lane < kBlock; ++lane) {
            const auto at = static_cast<std::size_t>(lane);
            ASSERT_EQ(made.block.point[0].impulse.at[at], 0);
            ASSERT_EQ(made.block.friction_impulse[0].at[at], 0);
            ASSERT_EQ(made.block.twist_impulse.at[at], 0);
        }
    }
}

TEST(Sweep, WritesNoBodyThatStandsStillOrMovesByItselfOrBelongsToNoLane)
{
    check_untouched<float>();
    check_untouched<double>();
}

// A ball of 2 kg that meets a still body along z, at a speed.
BlockCase<double> falling_ball(double speed, double restitution)
{
    BlockCase<double> made;
    std::memset(static_cast<void*>(&made.block), 0, sizeof(made.block));
    made.block.points = 1;
    made.block.writes_b = 1;
    SolverBody<double> still = {};
    still.drift[7] = 1;
    SolverBody<double> ball = still;
    ball.motion[2] = -speed;
    ball.inertia[0] = 0.5;
    for (int k = 1; k < 4; ++k) ball.inertia[k] = 5;
    made.bodies = {still, ball};
    made.block.b[0] = 1;
    Contact<double> contact;
    contact.count = 1;
    contact.points[0].from_a.setZero();
    contact.points[0].from_b = Vec3(0, 0, -0.1);
    contact.points[0].separation = 0;
    for (int lane = 1; lane < kBlock; ++lane) clear_lane(made.block, lane, 0);
    fill_lane(made.block, 0, contact, made.bodies[0], made.bodies[1],
              {0.5, restitution, 0.0, softness<double>(40, 10, 1.0 / 240), 0});
    return made;
}

TEST(Sweep, AVisitThatDoesNotPushStopsABallDead)
{
    for (const double speed : {0.1, 3.0, 1000.0}) {
        BlockCase<double> made = falling_ball(speed, 0);
        Visit<double> visit;
        visit.inverse_substep = 240;
        solve_kernels<double>().sweep(&made.block, 1, made.bodies.data(), visit);
        EXPECT_NEAR(made.bodies[1].motion[2], 0, 1e-13 * speed);
        EXPECT_NEAR(made.block.point[0].impulse.at[0], 2 * speed, 1e-13 * speed);
    }
}

TEST(Sweep, ABallLeavesWithItsShareOfTheSpeedItCameWith)
{
    for (const double share : {0.25, 0.5, 1.0}) {
        BlockCase<double> made = falling_ball(3, share);
        Visit<double> visit;
        visit.inverse_substep = 240;
        const auto& kernels = solve_kernels<double>();
        kernels.sweep(&made.block, 1, made.bodies.data(), visit);
        kernels.restitute(&made.block, 1, made.bodies.data(), 0.5, visit);
        EXPECT_NEAR(made.bodies[1].motion[2], 3 * share, 1e-12);
    }
}

TEST(Sweep, ABallThatCameSlowlyOrNeverTouchedDoesNotBounce)
{
    Visit<double> visit;
    visit.inverse_substep = 240;
    const auto& kernels = solve_kernels<double>();
    BlockCase<double> slow = falling_ball(0.4, 1);
    kernels.sweep(&slow.block, 1, slow.bodies.data(), visit);
    kernels.restitute(&slow.block, 1, slow.bodies.data(), 0.5, visit);
    EXPECT_NEAR(slow.bodies[1].motion[2], 0, 1e-13);
    BlockCase<double> far = falling_ball(3, 1);
    far.block.point[0].gap.at[0] += 1;
    kernels.sweep(&far.block, 1, far.bodies.data(), visit);
    kernels.restitute(&far.block, 1, far.bodies.data(), 0.5, visit);
    EXPECT_EQ(far.bodies[1].motion[2], -3);
}

// Sizes from a micrometre to a thousand kilometres: the same numbers, in other units.
TEST(Sweep, FrictionHoldsItsConeAtEverySizeInFloat)
{
    for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        const double mass = 1000 * size * size * size;
        BlockCase<float> made;
        std::memset(static_cast<void*>(&made.block), 0, sizeof(made.block));
        made.block.points = 1;
        made.block.writes_b = 1;
        SolverBody<float> still = {};
        still.drift[7] = 1;
        SolverBody<float> box = still;
        // It slides across at a meter a second and presses with a tenth of that.
        box.motion[0] = 1;
        box.motion[2] = -0.1f;
        box.inertia[0] = static_cast<float>(1 / mass);
        made.bodies = {still, box};
        made.block.b[0] = 1;
        Contact<float> contact;
        contact.count = 1;
        contact.points[0].from_a.setZero();
        contact.points[0].from_b.setZero();
        for (int lane = 1; lane < kBlock; ++lane) clear_lane(made.block, lane, 0);
        fill_lane(made.block, 0, contact, made.bodies[0], made.bodies[1], {0.5f, 0, 0, {}, 0});
        Visit<float> visit;
        visit.inverse_substep = 240;
        solve_kernels<float>().sweep(&made.block, 1, made.bodies.data(), visit);
        EXPECT_NEAR(made.bodies[1].motion[2], 0, 1e-6) << size << " m";
        EXPECT_NEAR(made.bodies[1].motion[0], 0.95, 1e-6) << size << " m slides";

        made.bodies[1].motion[0] = 0.02f;
        made.bodies[1].motion[2] = -0.1f;
        for (auto& impulse : made.block.friction_impulse) impulse.at[0] = 0;
        made.block.point[0].impulse.at[0] = 0;
        solve_kernels<float>().sweep(&made.block, 1, made.bodies.data(), visit);
        EXPECT_NEAR(made.bodies[1].motion[0], 0, 1e-7) << size << " m sticks";
    }
}

}  // namespace
}  // namespace throng
