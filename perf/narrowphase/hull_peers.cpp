#include "perf/narrowphase/hull_peers.hpp"

#include <cmath>

#ifdef THRONG_BULLET
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#endif
#ifdef THRONG_CCD
#include <ccd/ccd.h>
#include <ccd/quat.h>
#endif

namespace throng::perf {
namespace {

#ifdef THRONG_BULLET

// btGjkPairDetector with its own depth solver, hulls without margin.
class BulletPeer : public HullPeer {
public:
    explicit BulletPeer(std::span<const HullsMoving> pairs)
    {
        name = "bullet";
        for (const HullsMoving& pair : pairs) pairs_.push_back(std::make_unique<Pair>(pair));
    }

    double ask(std::size_t pair, std::size_t step, double speculative_margin, bool warm) override
    {
        Pair& asked = *pairs_[pair];
        if (!warm) asked.detector.setCachedSeparatingAxis({0, 1, 0});
        btGjkPairDetector::ClosestPointInput input;
        input.m_transformA.setIdentity();
        input.m_transformB = asked.poses[step];
        input.m_maximumDistanceSquared =
            static_cast<btScalar>(std::min(speculative_margin * speculative_margin, 1e18));
        btPointCollector found;
        asked.detector.getClosestPoints(input, found, nullptr);
        return found.m_hasResult ? found.m_distance : 1e9;
    }

private:
    struct Pair {
        explicit Pair(const HullsMoving& pair)
            : a(shape_of(*pair.a)), b(shape_of(*pair.b)),
              detector(a.get(), b.get(), &simplex, &depths)
        {
            for (const Pose& pose : pair.b_in_a) {
                const auto number = [](double x) { return static_cast<btScalar>(x); };
                const Quat& q = pose.orientation;
                const Vec3& at = pose.position;
                poses.push_back(btTransform(
                    btQuaternion(number(q.x()), number(q.y()), number(q.z()), number(q.w())),
                    btVector3(number(at.x()), number(at.y()), number(at.z()))));
            }
        }
        static std::unique_ptr<btConvexHullShape> shape_of(const Hull& hull)
        {
            auto shape = std::make_unique<btConvexHullShape>();
            for (const Vec3& vertex : hull.vertices)
                shape->addPoint({static_cast<btScalar>(vertex.x()),
                                 static_cast<btScalar>(vertex.y()),
                                 static_cast<btScalar>(vertex.z())},
                                false);
            shape->recalcLocalAabb();
            shape->setMargin(0);
            return shape;
        }

        std::unique_ptr<btConvexHullShape> a, b;
        btVoronoiSimplexSolver simplex;
        btGjkEpaPenetrationDepthSolver depths;
        btGjkPairDetector detector;
        std::vector<btTransform> poses;
    };
    std::vector<std::unique_ptr<Pair>> pairs_;
};

#endif
#ifdef THRONG_CCD

// libccd, which measures no distance: whether they touch, and the depth where they do.
class CcdPeer : public HullPeer {
public:
    CcdPeer(std::span<const HullsMoving> pairs, Question question)
        : depth_(question == Question::depth)
    {
        name = "ccd";
        CCD_INIT(&ccd_);
        ccd_.support1 = furthest;
        ccd_.support2 = furthest;
        ccd_.max_iterations = 128;
        ccd_.epa_tolerance = 1e-9;
        for (const HullsMoving& pair : pairs) {
            std::vector<Placed> placed;
            for (const Pose& pose : pair.b_in_a)
                placed.push_back({pair.b, pose.orientation.toRotationMatrix(), pose.position});
            b_.push_back(std::move(placed));
            a_.push_back({pair.a, Mat3::Identity(), Vec3::Zero()});
        }
    }

    double ask(std::size_t pair, std::size_t step, double, bool) override
    {
        if (!depth_) return ccdGJKIntersect(&a_[pair], &b_[pair][step], &ccd_) ? 0 : 1e9;
        ccd_real_t depth = 0;
        ccd_vec3_t direction, place;
        const int apart =
            ccdGJKPenetration(&a_[pair], &b_[pair][step], &ccd_, &depth, &direction, &place);
        return apart ? 1e9 : -depth;
    }

private:
    struct Placed {
        const Hull* hull;
        Mat3 turn;
        Vec3 shift;
    };
    static void furthest(const void* shape, const ccd_vec3_t* along, ccd_vec3_t* found)
    {
        const Placed& placed = *static_cast<const Placed*>(shape);
        const Vec3 local = placed.turn.transpose() * Vec3(along->v[0], along->v[1], along->v[2]);
        const Vec3* best = placed.hull->vertices.data();
        double most = local.dot(*best);
        for (const Vec3& vertex : placed.hull->vertices) {
            const double height = local.dot(vertex);
            if (!(height > most)) continue;
            most = height;
            best = &vertex;
        }
        const Vec3 point = placed.turn * *best + placed.shift;
        ccdVec3Set(found, point.x(), point.y(), point.z());
    }

    bool depth_;
    ccd_t ccd_;
    std::vector<Placed> a_;
    std::vector<std::vector<Placed>> b_;
};

#endif

}  // namespace

std::vector<std::unique_ptr<HullPeer>>
make_hull_peers([[maybe_unused]] std::span<const HullsMoving> pairs,
                [[maybe_unused]] Question question)
{
    std::vector<std::unique_ptr<HullPeer>> peers;
#ifdef THRONG_BULLET
    peers.push_back(std::make_unique<BulletPeer>(pairs));
#endif
#ifdef THRONG_CCD
    if (question != Question::distance) peers.push_back(std::make_unique<CcdPeer>(pairs, question));
#endif
    return peers;
}

}  // namespace throng::perf
