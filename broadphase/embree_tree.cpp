#include "broadphase/embree_tree.hpp"

#include "broadphase/layered_finder.hpp"
#include "kernels/parallel/race_notes.hpp"

#include <embree3/rtcore.h>

#ifndef THRONG_PLAIN_THREADS
#include <tbb/task_arena.h>
#endif

#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>

namespace throng {
namespace {

// A tree does not mind sizes that differ; only what would make floats useless stands aside.
constexpr double kAsideRatio = 1e6;

// One device for the program, opened at first use and never closed, since trees may outlive any
// static object. A thread count in its settings would bound oneTBB everywhere, so it is given none;
// the plain-threads build, which has no use for oneTBB, keeps Embree on the calling thread.
RTCDevice device()
{
#ifdef THRONG_PLAIN_THREADS
    constexpr const char* kSettings = "threads=1";
#else
    constexpr const char* kSettings = nullptr;
#endif
    // NOLINTNEXTLINE(misc-misplaced-const): the handle stays, the device may change
    static const RTCDevice only = rtcNewDevice(kSettings);
    if (only == nullptr) throw std::runtime_error("embree: no device; is the processor supported?");
    return only;
}

void throw_if_failed(const char* doing)
{
    if (rtcGetDeviceError(device()) != RTC_ERROR_NONE)
        throw std::runtime_error(std::string("embree: failed while ") + doing);
}

// While a thread waits inside Embree it takes no other work of the step.
template <class Body>
void isolated(const Body& body)
{
#ifdef THRONG_PLAIN_THREADS
    body();
#else
    tbb::this_task_arena::isolate(body);
#endif
}

// Embree builds its trees by itself, of memory that the race checker sees it take and nobody pass
// on: for that alone it is kept on one thread.
template <class Body>
void build_isolated(const Body& body)
{
#ifndef THRONG_PLAIN_THREADS
    if (kChecksRaces) {
        tbb::task_arena(1).execute(body);
        return;
    }
#endif
    isolated(body);
}

float rounded_down(double value)
{
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) <= value ? nearest : std::nextafter(nearest, -HUGE_VALF);
}
float rounded_up(double value) { return -rounded_down(-value); }

// A box as Embree sees it: floats about the origin, never smaller than the box.
void write_bounds(const Box3& box, const Vec3& origin, double margin, RTCBounds& bounds)
{
    // Subtraction rounds by at most this; half of it would do.
    const auto slack = [&](double side, int axis) {
        return margin + 4e-16 * (std::abs(side) + std::abs(origin[axis]));
    };
    const auto lower = [&](int axis) {
        return rounded_down(box.lower[axis] - origin[axis] - slack(box.lower[axis], axis));
    };
    const auto upper = [&](int axis) {
        return rounded_up(box.upper[axis] - origin[axis] + slack(box.upper[axis], axis));
    };
    bounds.lower_x = lower(0);
    bounds.lower_y = lower(1);
    bounds.lower_z = lower(2);
    bounds.upper_x = upper(0);
    bounds.upper_y = upper(1);
    bounds.upper_z = upper(2);
}

// Lists for callbacks that Embree runs on threads of its choosing. A thread goes to the list it
// used last and finds it free but for rare coincidence; the lists are sorted later, so it does not
// matter who wrote where.
class CallbackLists {
public:
    template <class Body>
    void with_list(const Body& body)
    {
        static std::atomic<unsigned> threads{0};
        thread_local const unsigned mine = threads++;
        unsigned at = mine % kLists;
        while (lists_[at].busy.test_and_set(std::memory_order_acquire)) at = (at + 1) % kLists;
        body(lists_[at].found);
        lists_[at].busy.clear(std::memory_order_release);
    }
    void move_to(std::vector<PairKey>& pairs)
    {
        for (List& list : lists_) {
            pairs.insert(pairs.end(), list.found.begin(), list.found.end());
            list.found.clear();
        }
    }

private:
    static constexpr unsigned kLists = 64;
    struct alignas(64) List {
        std::atomic_flag busy = ATOMIC_FLAG_INIT;
        std::vector<PairKey> found;
    };
    std::array<List, kLists> lists_;
};

}  // namespace

struct EmbreeBoxes::Inside {
    RTCScene scene = nullptr;
    RTCGeometry geometry = nullptr;
    std::span<const Box3> boxes;  // while building
    Vec3 origin = Vec3::Zero();
    double margin = 0;
    std::size_t count = 0;
    CallbackLists lists;

    Inside();
    ~Inside()
    {
        rtcReleaseScene(scene);
        rtcReleaseGeometry(geometry);
    }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
};

namespace {

// What a collision callback needs to know.
struct Collision {
    const EmbreeBoxes::Accept& accept;
    CallbackLists& lists;
    bool with_itself;
    TaskNotes notes = {};

    static void report(void* self, RTCCollision* collisions, unsigned count)
    {
        const auto& my = *static_cast<const Collision*>(self);
        const TaskNotes::Run run(my.notes);
        my.lists.with_list([&](std::vector<PairKey>& found) {
            for (unsigned i = 0; i < count; ++i) {
                const unsigned a = collisions[i].primID0, b = collisions[i].primID1;
                // Within one scene each pair comes both ways round.
                if (my.with_itself && a >= b) continue;
                PairKey key = 0;
                if (my.accept(a, b, key)) found.push_back(key);
            }
        });
    }
};

// Carries a list to the callback, which notes each box and lets the ray pass on.
struct RayContext {
    RTCIntersectContext embree;
    std::vector<std::uint32_t>* places;

    static void note(const RTCIntersectFunctionNArguments* arguments)
    {
        if (arguments->valid[0] != 0)
            reinterpret_cast<RayContext*>(arguments->context)->places->push_back(arguments->primID);
    }
};

}  // namespace

EmbreeBoxes::Inside::Inside()
{
    scene = rtcNewScene(device());
    geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
    throw_if_failed("making a scene");
    // Morton order: builds five times faster than a better tree that collides hardly faster.
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* arguments) {
            const auto& my = *static_cast<const Inside*>(arguments->geometryUserPtr);
            write_bounds(my.boxes[arguments->primID], my.origin, my.margin, *arguments->bounds_o);
        },
        nullptr);
    rtcSetGeometryIntersectFunction(geometry, &RayContext::note);
    rtcAttachGeometry(scene, geometry);
}

EmbreeBoxes::EmbreeBoxes() = default;
EmbreeBoxes::~EmbreeBoxes() = default;
EmbreeBoxes::EmbreeBoxes(EmbreeBoxes&&) noexcept = default;
EmbreeBoxes& EmbreeBoxes::operator=(EmbreeBoxes&&) noexcept = default;

void EmbreeBoxes::build(std::span<const Box3> boxes, const Vec3& origin, double margin)
{
    if (inside_ == nullptr) {
        if (boxes.empty()) return;
        inside_ = std::make_unique<Inside>();
    }
    inside_->count = boxes.size();
    inside_->origin = origin;
    inside_->margin = margin;
    if (boxes.empty()) return;  // never asked: Embree would call that an error
    inside_->boxes = boxes;
    rtcSetGeometryUserPrimitiveCount(inside_->geometry, static_cast<unsigned>(boxes.size()));
    rtcCommitGeometry(inside_->geometry);
    build_isolated([&] { rtcCommitScene(inside_->scene); });
    inside_->boxes = {};
    throw_if_failed("building a tree");
}

bool EmbreeBoxes::empty() const { return inside_ == nullptr || inside_->count == 0; }

void EmbreeBoxes::collide(const EmbreeBoxes& other,
                          const Accept& accept,
                          std::vector<PairKey>& keys)
{
    if (empty() || other.empty()) return;
    {
        Collision collision{accept, inside_->lists, this == &other};
        isolated([&] {
            rtcCollide(inside_->scene, other.inside_->scene, &Collision::report, &collision);
        });
    }
    throw_if_failed("looking for pairs");
    inside_->lists.move_to(keys);
}

void EmbreeBoxes::along(const Vec3& from,
                        const Vec3& direction,
                        double length,
                        std::vector<std::uint32_t>& places) const
{
    if (empty()) return;
    RayContext context{};
    rtcInitIntersectContext(&context.embree);
    context.places = &places;
    const Vec3T<float> start = (from - inside_->origin).cast<float>();
    const Vec3T<float> ahead = direction.cast<float>();
    RTCRayHit ray{};
    ray.ray.org_x = start.x();
    ray.ray.org_y = start.y();
    ray.ray.org_z = start.z();
    ray.ray.dir_x = ahead.x();
    ray.ray.dir_y = ahead.y();
    ray.ray.dir_z = ahead.z();
    ray.ray.tfar = rounded_up(length);
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(inside_->scene, &context.embree, &ray);
}

namespace {

// Boxes of colliders in a tree.
class EmbreeIndex {
public:
    void
    build(const std::vector<std::uint32_t>& ids, std::span<const Box3> boxes, const Vec3& origin)
    {
        ids_ = ids;
        boxes_.clear();
        for (const std::uint32_t id : ids) boxes_.push_back(boxes[id]);
        tree_.build(boxes_, origin, 0);
    }
    void join(const PairRule& rule, std::vector<PairKey>& pairs)
    {
        find_overlaps(*this, rule, pairs);
    }

    void find_overlaps(const EmbreeIndex& other, const PairRule& rule, std::vector<PairKey>& pairs)
    {
        // Embree tests floats, and whole leaves at a time: what counts is tested here.
        const auto accept = [&](std::uint32_t at_a, std::uint32_t at_b, PairKey& key) {
            const std::uint32_t a = ids_[at_a], b = other.ids_[at_b];
            key = pair_key(a, b);
            return a != b && boxes_[at_a].overlaps(other.boxes_[at_b]) && rule.wants(a, b);
        };
        tree_.collide(other.tree_, accept, pairs);
    }

private:
    EmbreeBoxes tree_;
    std::vector<Box3> boxes_;
    std::vector<std::uint32_t> ids_;
};

}  // namespace

struct EmbreeTree::Inside {
    LayeredFinder<EmbreeIndex> finder{kAsideRatio};
};

EmbreeTree::EmbreeTree() : inside_(std::make_unique<Inside>()) { }
EmbreeTree::~EmbreeTree() = default;
EmbreeTree::EmbreeTree(EmbreeTree&&) noexcept = default;
EmbreeTree& EmbreeTree::operator=(EmbreeTree&&) noexcept = default;

void EmbreeTree::find(const OverlapQuery& query, std::vector<PairKey>& pairs)
{
    inside_->finder.find(query, pairs);
}

}  // namespace throng
