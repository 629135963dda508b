// Sensors: bodies that report who overlaps them, and touch nothing.
//
// Filters let a sensor touch nobody, so no stage of the step knows of any. After each step those
// that overlap are found among the live boxes that questions are asked about; and who went further
// than his smallest half extent is looked for along his way, so that nobody is too fast to be
// sensed.
#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/ccd/time_of_impact.hpp"
#include "pipeline/events/parts_order.hpp"
#include "pipeline/queries/query_scene.hpp"
#include "pipeline/world/world_state.hpp"

#include <algorithm>
#include <stdexcept>

namespace throng {

namespace {

constexpr std::size_t kSensors = 16;  // a block

// Where a body was as the step began.
struct Start {
    std::uint32_t body = 0;
    Pose pose;
};

class Sensing : public SensorWatch {
public:
    explicit Sensing(WorldState& state) : state_(state)
    {
        if (state.queries == nullptr) state.queries = std::make_shared<QueryScene>(state);
    }

    void before_step() override
    {
        starts_.clear();
        if (state_.sensors.empty()) return;
        const ActiveBodies& active = state_.get<BodyStates>().active_bodies;
        const auto& poses = state_.get<Poses>();
        for (const auto* const bodies : {&active.dynamic, &active.kinematic})
            for (const std::uint32_t body : *bodies)
                if (state_.get<Colliders>().count[body] > 0)
                    starts_.push_back({body, poses.at(body)});
        std::sort(starts_.begin(), starts_.end(),
                  [](const Start& a, const Start& b) { return a.body < b.body; });
    }

    void after_step() override
    {
        if (state_.sensors.empty() && inside_.empty()) return;
        list_sensors();
        std::vector<TouchingParts> now = overlapping();
        std::vector<TouchingParts> begun, ended;
        std::set_difference(now.begin(), now.end(), inside_.begin(), inside_.end(),
                            std::back_inserter(begun), comes_before);
        std::set_difference(inside_.begin(), inside_.end(), now.begin(), now.end(),
                            std::back_inserter(ended), comes_before);
        const std::vector<TouchingParts> through = gone_through(now);
        begun.insert(begun.end(), through.begin(), through.end());
        ended.insert(ended.end(), through.begin(), through.end());
        for (auto* const list : {&begun, &ended})
            std::sort(list->begin(), list->end(), comes_before);
        inside_ = std::move(now);
        const std::uint64_t step = state_.report.step + 1;
        for (const TouchingParts& parts : begun) state_.events.sensed.push_back({parts, step});
        for (const TouchingParts& parts : ended) state_.events.left.push_back({parts, step});
    }

    std::vector<BodyId> inside(BodyId sensor) const override
    {
        std::vector<BodyId> found;
        for (const TouchingParts& parts : inside_)
            if (parts.a == sensor && (found.empty() || found.back() != parts.b))
                found.push_back(parts.b);
        return found;
    }

private:
    struct Sensor {
        std::uint32_t collider = 0, body = 0;
        BodyFilter filter;
    };

    void list_sensors()
    {
        sensors_.clear();
        const auto& colliders = state_.get<Colliders>();
        for (const auto& [body, filter] : state_.sensors)
            for (std::uint32_t k = 0; k < colliders.count[body]; ++k)
                sensors_.push_back({colliders.begin[body] + k, body, filter});
    }

    Box3 box_of(std::uint32_t collider) const
    {
        return shape_bounds(state_.get<Shapes>(), state_.get<Colliders>().shape[collider],
                            state_.queries->placed(collider));
    }

    // Whether a sensor looks for a collider at all: what stands still is not found by what does.
    bool looks_for(const Sensor& sensor, std::uint32_t collider) const
    {
        const auto& colliders = state_.get<Colliders>();
        const auto& states = state_.get<BodyStates>();
        const auto& filter = state_.get<PairFilter>();
        const std::uint32_t body = colliders.body[collider];
        return body != kNoBody && body != sensor.body
            && (filter.group[collider] & sensor.filter.mask) != 0
            && (sensor.filter.group & filter.mask[collider]) != 0
            && (states.kind[body] != BodyKind::static_
                || states.kind[sensor.body] != BodyKind::static_);
    }

    // Ascending.
    std::vector<TouchingParts> overlapping()
    {
        QueryScene& scene = *state_.queries;
        const auto& shapes = state_.get<Shapes>();
        scene.refresh();
        std::vector<Box3> regions(sensors_.size());
        for (std::size_t i = 0; i < sensors_.size(); ++i) regions[i] = box_of(sensors_[i].collider);
        std::vector<TouchingParts> found;
        BlockLists<TouchingParts> of_block;
        of_block.start(block_count(sensors_.size(), kSensors));
        state_.pool.run([&](std::size_t, std::size_t, std::size_t) {
            scene.find_near(regions, candidates_);
            for_each_block(sensors_.size(), kSensors, [&](auto begin, auto end, auto block) {
                for (std::size_t i = begin; i < end; ++i) {
                    const ShapeRef shape = state_.get<Colliders>().shape[sensors_[i].collider];
                    const Pose at = scene.placed(sensors_[i].collider);
                    const auto try_one = [&](std::uint32_t collider) {
                        if (looks_for(sensors_[i], collider)
                            && scene.overlaps(shapes, shape, at, collider))
                            of_block[block].push_back(
                                state_.parts_of(sensors_[i].collider, collider));
                    };
                    for (const std::uint32_t plane : scene.planes()) try_one(plane);
                    for (const std::uint32_t collider : candidates_.of(i)) try_one(collider);
                }
            });
        });
        of_block.append_to(found);
        std::sort(found.begin(), found.end(), comes_before);
        return found;
    }

    // By the straightest way from where it was to where it is.
    RigidTrajectory way_of(std::uint32_t body) const
    {
        const Pose now = state_.get<Poses>().at(body);
        const auto at =
            std::lower_bound(starts_.begin(), starts_.end(), body,
                             [](const Start& a, std::uint32_t b) { return a.body < b; });
        if (at == starts_.end() || at->body != body) return {now};
        return trajectory_between(at->pose, now,
                                  state_.get<Velocities>().angular[body] * state_.settings.dt);
    }

    // Colliders of those who went so far that they may have gone through a sensor.
    std::vector<std::uint32_t> far_travelled() const
    {
        const auto& colliders = state_.get<Colliders>();
        std::vector<std::uint32_t> found;
        for (const auto& [body, pose] : starts_) {
            const double moved = (state_.get<Poses>().position[body] - pose.position).norm();
            for (std::uint32_t k = 0; k < colliders.count[body]; ++k)
                if (const std::uint32_t at = colliders.begin[body] + k;
                    colliders.shape[at].kind != ShapeKind::plane
                    && moved > colliders.inner_extent[at])
                    found.push_back(at);
        }
        return found;
    }

    // Who is inside neither as the step begins nor as it ends, but was in between.
    std::vector<TouchingParts> gone_through(const std::vector<TouchingParts>& now) const
    {
        std::vector<TouchingParts> found;
        const std::vector<std::uint32_t> far = far_travelled();
        if (far.empty()) return found;
        std::vector<Box3> boxes(sensors_.size());
        for (std::size_t i = 0; i < sensors_.size(); ++i)
            boxes[i] = box_of_way(sensors_[i].collider, way_of(sensors_[i].body));
        const auto inside = [](const std::vector<TouchingParts>& list, const TouchingParts& parts) {
            return std::binary_search(list.begin(), list.end(), parts, comes_before);
        };
        for (const std::uint32_t at : far) {
            const RigidTrajectory way = way_of(state_.get<Colliders>().body[at]);
            const Box3 box = box_of_way(at, way);
            for (std::size_t i = 0; i < sensors_.size(); ++i) {
                if (!boxes[i].overlaps(box) || !looks_for(sensors_[i], at)) continue;
                const TouchingParts parts = state_.parts_of(sensors_[i].collider, at);
                if (!inside(now, parts) && !inside(inside_, parts) && meets(sensors_[i], at, way))
                    found.push_back(parts);
            }
        }
        return found;
    }

    bool meets(const Sensor& sensor, std::uint32_t collider, const RigidTrajectory& way) const
    {
        constexpr double kTolerance = 1e-6;  // of the smaller's size
        const auto& colliders = state_.get<Colliders>();
        const auto& shapes = state_.get<Shapes>();
        const MovingShape a{colliders.shape[sensor.collider], way_of(sensor.body),
                            colliders.local[sensor.collider]};
        const MovingShape b{colliders.shape[collider], way, colliders.local[collider]};
        const ImpactRule rule =
            impact_rule(ToiMethod::newton, kTolerance * impact_size(shapes, a.shape, b.shape));
        return time_of_impact(shapes, a, b, 0, 1, rule).state != ToiState::separated;
    }

    Box3 box_of_way(std::uint32_t collider, const RigidTrajectory& way) const
    {
        const auto& colliders = state_.get<Colliders>();
        const Pose begin = way.begin * colliders.local[collider];
        Box3 box = joined(shape_bounds(state_.get<Shapes>(), colliders.shape[collider], begin),
                          box_of(collider));
        if (const double angle = way.angle(); angle > 0) {
            const double beyond = beyond_ends(angle) * colliders.outer_radius[collider];
            box.lower.array() -= beyond;
            box.upper.array() += beyond;
        }
        return box;
    }

    WorldState& state_;
    std::vector<Sensor> sensors_;
    std::vector<Start> starts_;          // by body
    std::vector<TouchingParts> inside_;  // ascending; a is the sensor
    Candidates candidates_;
};

}  // namespace

void WorldState::call_sensors()
{
    const bool any = listening.sensors && !sensors.empty();
    std::string& cause = requests.first[static_cast<std::size_t>(Effect::sensors)];
    cause = any ? called(sensors.begin()->first) : "";
    if (any && sensing == nullptr) sensing = std::make_unique<Sensing>(*this);
    // Who is inside last ceases to be as the last sensor goes, in the next step.
    if (!listening.sensors) sensing = nullptr;
    effects_stale = causes_stale = true;
}

void World::set_sensor(BodyId body, bool sensor)
{
    const Door::Entry entry(state_->door, "set_sensor");
    WorldState& state = *state_;
    const std::uint32_t at = state.place_of(body, "set_sensor");
    const auto found = state.sensors.find(at);
    if (sensor == (found != state.sensors.end())) return;
    const auto& colliders = state.get<Colliders>();
    for (std::uint32_t k = 0; sensor && k < colliders.count[at]; ++k) {
        const ShapeKind kind = colliders.shape[colliders.begin[at] + k].kind;
        if (kind == ShapeKind::plane || kind == ShapeKind::mesh || kind == ShapeKind::solid)
            throw std::invalid_argument("set_sensor: " + state.called(at)
                                        + ": wanted a body of convex shapes of finite size");
    }
    if (sensor && colliders.count[at] == 0)
        throw std::invalid_argument("set_sensor: " + state.called(at)
                                    + ": wanted a body with a shape");
    state.begin_change(at);
    if (sensor)
        state.make_sensor(at);
    else
        state.set_filter(at, found->second);
    if (!sensor) state.sensors.erase(at);
    state.mark_changed(at);
    state.call_sensors();
}

bool World::sensor(BodyId body) const
{
    return state_->sensors.contains(state_->place_of(body, "sensor"));
}

std::vector<BodyId> World::sensed(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "sensed");
    if (!state_->sensors.contains(at))
        throw std::invalid_argument("sensed: " + state_->called(at) + ": wanted a sensor");
    if (state_->sensing == nullptr)
        throw std::invalid_argument("sensed: nobody listens to sensors; listen() to them first");
    return state_->sensing->inside(body);
}

}  // namespace throng
