// Scene builder: what a user states, made into the arrays that the step works on.
#include "cooking/repair/mesh_health.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "pipeline/world/body_mass.hpp"
#include "pipeline/world/force_builder.hpp"
#include "pipeline/world/grown_list.hpp"
#include "pipeline/world/world_state.hpp"
#include "scene/rules/scene_check.hpp"
#include "scene/rules/scene_rules.hpp"
#include "scene/shapes/solid_maker.hpp"
#include "scene/shapes/stated_hull.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace throng {

namespace {

template <class Shape>
ShapeRef append(std::vector<Shape>& shapes, ShapeKind kind, Shape shape)
{
    shapes.push_back(std::move(shape));
    return {kind, static_cast<std::uint32_t>(shapes.size() - 1)};
}

// What nobody finds before the shape is made.
[[noreturn]] void refuse_mesh(const std::string& name, const std::string& trouble)
{
    throw SceneRefused({{"shapes", name, "mesh", "file"},
                        "wanted a mesh that can be made into what collides; " + trouble});
}

int sides_of(MeshTree tree)
{
    constexpr int kSides[] = {6, 14, 18, 26};
    return kSides[static_cast<std::size_t>(tree)];
}

}  // namespace

void SceneBuilder::add_materials(const Scene& scene)
{
    auto& surfaces = state_.get<Surfaces>();
    const auto add_one = [&](const Material& material, const std::string& name) {
        surfaces.friction.push_back(material.friction);
        surfaces.restitution.push_back(material.restitution);
        surfaces.rolling_friction.push_back(material.rolling_friction);
        state_.material_names.push_back(name);
        density_.push_back(material.density);
        state_.material_density.push_back(material.density);
    };
    first_material_ = static_cast<std::uint32_t>(surfaces.friction.size());
    for (const Material& material : scene.materials) add_one(material, material.name);
    default_material_ = static_cast<std::uint32_t>(surfaces.friction.size());
    add_one(Material{}, "(default)");
    for (const MaterialPairDescription& pair : scene.pairs) {
        const std::uint32_t a = first_material_ + std::min(pair.a, pair.b);
        const std::uint32_t b = first_material_ + std::max(pair.a, pair.b);
        Surfaces::MaterialPair combined = surfaces.between(a, b);
        combined.friction = pair.friction.value_or(combined.friction);
        combined.restitution = pair.restitution.value_or(combined.restitution);
        surfaces.overrides.push_back({a, b, combined});
    }
    std::stable_sort(
        surfaces.overrides.begin(), surfaces.overrides.end(),
        [](const auto& x, const auto& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
}

PlacedShape SceneBuilder::add_shape(const Scene& scene, const ShapeDescription& description)
{
    auto& shapes = state_.get<Shapes>();
    const auto one = [&](ShapeRef shape) {
        return PlacedShape{{shape}, {Pose{}}, mass_of(shapes, shape)};
    };
    struct Maker {
        SceneBuilder& builder;
        Shapes& shapes;
        const Scene& scene;
        const std::string& name;
        decltype(one)& single;

        PlacedShape operator()(const SphereShape& s) const
        {
            return single(append(shapes.spheres, ShapeKind::sphere, Sphere{s.radius}));
        }
        PlacedShape operator()(const CapsuleShape& s) const
        {
            return single(
                append(shapes.capsules, ShapeKind::capsule, Capsule{s.radius, s.half_length}));
        }
        PlacedShape operator()(const CylinderShape& s) const
        {
            return single(
                append(shapes.cylinders, ShapeKind::cylinder, Cylinder{s.radius, s.half_length}));
        }
        PlacedShape operator()(const BoxShape& s) const
        {
            return single(append(shapes.boxes, ShapeKind::box, Box{s.half_extents}));
        }
        PlacedShape operator()(const PlaneShape& s) const
        {
            // Its frame is put on its surface, so that no great offset is left for float to hold.
            const Vec3 normal = s.normal.normalized();
            PlacedShape placed = single(append(shapes.planes, ShapeKind::plane, Plane{normal, 0}));
            placed.poses[0].position = normal * s.offset;
            return placed;
        }
        PlacedShape operator()(const HullShape& s) const
        {
            const std::shared_ptr<const HullResult> built = stated_hull(s);
            // Its way into the world ends here.
            forget_stated_hull(s);
            return single(append(shapes.hulls, ShapeKind::hull, built->hull));
        }
        PlacedShape operator()(const MeshShape& s) const
        {
            RepairedMesh result = mend_still(s.vertices, s.triangles);
            if (!result.trouble.empty()) refuse_mesh(name, result.trouble);
            for (const std::string& warning : result.warnings)
                builder.state_.warnings.push_back("shape " + name + ": " + warning);
            if (const int sides = sides_of(builder.state_.settings.mesh_tree); sides > 6)
                bound_by_k_dops(result.mesh, sides);
            return single(append(shapes.meshes, ShapeKind::mesh, std::move(result.mesh)));
        }
        PlacedShape operator()(const VoxelsShape& s) const { return builder.add_solid(name, s); }
        PlacedShape operator()(const CompoundShape& s) const
        {
            PlacedShape whole;
            std::vector<PlacedMass> masses;
            for (const CompoundShape::Part& part : s.parts) {
                const PlacedShape inner = builder.add_shape(scene, scene.shapes[part.shape]);
                for (std::size_t i = 0; i < inner.parts.size(); ++i) {
                    whole.parts.push_back(inner.parts[i]);
                    whole.poses.push_back(part.pose * inner.poses[i]);
                }
                masses.push_back({inner.mass, part.pose});
            }
            whole.mass = combine(masses);
            return whole;
        }
    };
    return std::visit(Maker{*this, shapes, scene, description.name, one}, description.shape);
}

PlacedShape
SceneBuilder::add_solid(const Scene& scene, const std::string& name, const MeshShape& mesh)
{
    MadeSolid made;
    state_.pool.run([&](std::size_t, std::size_t, std::size_t) {
        made = make_solid(mesh, state_.settings, scene.cache_folder);
    });
    return add_made(name, std::move(made));
}

PlacedShape SceneBuilder::add_solid(const std::string& name, const VoxelsShape& voxels)
{
    MadeSolid made;
    state_.pool.run(
        [&](std::size_t, std::size_t, std::size_t) { made = make_solid(*voxels.level_set); });
    return add_made(name, std::move(made));
}

PlacedShape SceneBuilder::add_made(const std::string& name, MadeSolid made)
{
    const std::string who = "shape " + name + ": ";
    if (!made.trouble.empty()) refuse_mesh(name, made.trouble);
    for (const std::string& warning : made.warnings) state_.warnings.push_back(who + warning);
    state_.solids.push_back(name + ": " + made.summary);
    PlacedShape placed;
    placed.mass = made.mass;
    auto& shapes = state_.get<Shapes>();
    if (Solid* const solid = std::get_if<Solid>(&made.shape))
        placed.parts.push_back(append(shapes.solids, ShapeKind::solid, std::move(*solid)));
    else
        for (Hull& hull : std::get<std::vector<Hull>>(made.shape))
            placed.parts.push_back(append(shapes.hulls, ShapeKind::hull, std::move(hull)));
    placed.poses.assign(placed.parts.size(), Pose{made.at, Quat::Identity()});
    return placed;
}

std::uint32_t SceneBuilder::take_body()
{
    if (!state_.free_bodies.empty()) {
        std::pop_heap(state_.free_bodies.begin(), state_.free_bodies.end(), std::greater<>());
        const std::uint32_t body = state_.free_bodies.back();
        state_.free_bodies.pop_back();
        return body;
    }
    state_.generation.push_back(0);
    return static_cast<std::uint32_t>(state_.generation.size() - 1);
}

std::uint32_t SceneBuilder::take_colliders(std::uint32_t count)
{
    auto& free = state_.free_colliders[count];
    if (count > 0 && !free.empty()) {
        const std::uint32_t first = free.back();
        free.pop_back();
        return first;
    }
    return static_cast<std::uint32_t>(state_.get<Colliders>().size());
}

void SceneBuilder::place_colliders(std::uint32_t body,
                                   const BodyDescription& stated,
                                   const PlacedShape* shape)
{
    auto& colliders = state_.get<Colliders>();
    auto& filter = state_.get<PairFilter>();
    const auto& shapes = state_.get<Shapes>();
    const auto count = static_cast<std::uint32_t>(shape == nullptr ? 0 : shape->parts.size());
    const std::uint32_t first = take_colliders(count);
    put(colliders.begin, body, first);
    put(colliders.count, body, count);
    colliders.compounds = colliders.compounds || count > 1;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t at = first + i;
        Pose local = shape->poses[i];
        local.position -= state_.center[body];
        put(colliders.body, at, body);
        put(colliders.shape, at, shape->parts[i]);
        put(colliders.local, at, local);
        put(colliders.material, at,
            stated.material == kNone ? default_material_ : first_material_ + stated.material);
        put(colliders.inner_extent, at, inner_extent(shapes, shape->parts[i]));
        put(colliders.outer_radius, at, 0.0);
        filter.resize(colliders.size());
        filter.body[at] = body;
        filter.group[at] = stated.group;
        filter.mask[at] = stated.mask;
    }
    put(colliders.shape_bits, body, std::uint8_t{0});
    put(state_.get<BodyStates>().radius, body, 0.0);
    state_.measure_colliders(body);
}

void SceneBuilder::weigh(std::uint32_t body,
                         const BodyDescription& stated,
                         const PlacedShape* shape)
{
    auto& masses = state_.get<Masses>();
    give_no_mass(body, masses);
    const Vec3 natural = shape == nullptr ? Vec3(Vec3::Zero()) : shape->mass.center;
    put(state_.center, body, stated.center.value_or(natural));
    if (stated.motion != Motion::dynamic) {
        // What only moves by itself turns about its own frame.
        state_.center[body] = stated.center.value_or(Vec3::Zero());
        return;
    }
    const double volume = shape == nullptr ? 0 : shape->mass.volume;
    const double density =
        density_[stated.material == kNone ? default_material_ - first_material_ : stated.material];
    const double mass = stated.mass.value_or(density * volume);
    if (stated.inertia) {
        masses.inertia[body] = *stated.inertia;
    } else if (volume > 0) {
        const Sym3 about_natural = scaled(shape->mass.inertia, mass / volume);
        masses.inertia[body] = shifted(about_natural, mass, state_.center[body] - natural);
    }
    state_forces(body, stated, state_.center[body], state_.get<Forces>());
    if (stated.pivot) {
        // The pivot takes the place of the center: it never moves, and all turning is about it.
        const Vec3 off = state_.center[body] - *stated.pivot;
        masses.inertia[body] = shifted(masses.inertia[body], mass, off);
        state_.center[body] = *stated.pivot;
    }
    give_mass(body, mass, masses.inertia[body], stated.lock_position || stated.pivot.has_value(),
              stated.lock_rotation, state_.settings.precision == Precision::double_, masses);
}

void SceneBuilder::note_requests(std::uint32_t body, const BodyDescription& stated)
{
    const std::string who =
        "body " + std::to_string(body) + (stated.name.empty() ? "" : " " + stated.name);
    Requests& requests = state_.requests;
    if (stated.fast) requests.ask(Effect::fast_motion, who);
}

BodyId SceneBuilder::add_body(const BodyDescription& stated, const PlacedShape* shape)
{
    const std::uint32_t body = take_body();
    weigh(body, stated, shape);
    place_colliders(body, stated, shape);
    Quat orientation = stated.orientation;
    orientation.coeffs() /= std::sqrt(orientation.squaredNorm());

    auto& poses = state_.get<Poses>();
    put(poses.position, body, Vec3(orientation * state_.center[body] + stated.position));
    put(poses.orientation, body, orientation);
    auto& velocities = state_.get<Velocities>();
    put(velocities.linear, body, stated.velocity);
    put(velocities.angular, body,
        stated.lock_rotation ? Vec3(Vec3::Zero()) : stated.angular_velocity);
    auto& states = state_.get<BodyStates>();
    const bool moves = stated.motion != Motion::static_;
    put(states.kind, body,
        !moves                                 ? BodyKind::static_
            : stated.motion == Motion::dynamic ? BodyKind::dynamic
                                               : BodyKind::kinematic);
    put(states.awake, body, std::uint8_t{moves});
    put(states.quarantined, body, std::uint8_t{0});
    put(states.sleep_time, body, 0.0);
    put(states.sleeping_island, body, kNoBody);
    put(state_.motion, body, stated.motion);
    if (!stated.name.empty()) put(state_.names, body, stated.name);
    if (stated.gravity_scale != 1 && stated.motion == Motion::dynamic) {
        state_.applied_forces[body] = {stated.force, stated.torque, stated.gravity_scale};
        state_.sum_forces(body);
    }
    if (stated.sensor) state_.make_sensor(body);
    if (stated.user_data != 0) put(state_.user_data, body, stated.user_data);

    put(states.fast, body, std::uint8_t{moves && stated.fast});
    state_.drive(body, stated.drive_velocity);
    note_requests(body, stated);
    state_.mark_changed(body);
    state_.changed.push_back(body);
    if (stated.motion == Motion::kinematic) state_.active_bodies_stale = true;
    if (stated.motion == Motion::dynamic) state_.woken.push_back(body);
    ++state_.alive;
    return {body, state_.generation[body]};
}

void SceneBuilder::make_room_for(ShapeKind kind, std::size_t count)
{
    auto& shapes = state_.get<Shapes>();
    const auto reserve = [&](auto& list) { list.reserve(list.size() + count); };
    if (kind == ShapeKind::sphere) reserve(shapes.spheres);
    if (kind == ShapeKind::capsule) reserve(shapes.capsules);
    if (kind == ShapeKind::cylinder) reserve(shapes.cylinders);
    if (kind == ShapeKind::box) reserve(shapes.boxes);
}

ShapeRef SceneBuilder::sized(ShapeKind kind, const double* sizes)
{
    auto& shapes = state_.get<Shapes>();
    switch (kind) {
    case ShapeKind::sphere:
        return append(shapes.spheres, kind, Sphere{sizes[0]});
    case ShapeKind::capsule:
        return append(shapes.capsules, kind, Capsule{sizes[0], sizes[1]});
    case ShapeKind::cylinder:
        return append(shapes.cylinders, kind, Cylinder{sizes[0], sizes[1]});
    case ShapeKind::box:
        return append(shapes.boxes, kind, Box{Vec3(sizes[0], sizes[1], sizes[2])});
    default:
        throw std::invalid_argument("instances: this shape has no sizes of its own");
    }
}

// Room for what a scene adds, and not for half as much again. A world that is added to again and
// again doubles it as any list does.
void SceneBuilder::grow_lists(std::size_t bodies)
{
    const auto reserve = [](std::size_t count, auto&... lists) {
        const auto one = [&](auto& list) {
            if (list.empty()) list.reserve(count);
        };
        (one(lists), ...);
    };
    auto& p = state_.get<Poses>();
    auto& v = state_.get<Velocities>();
    auto& m = state_.get<Masses>();
    auto& s = state_.get<BodyStates>();
    reserve(bodies, p.position, p.orientation, v.linear, v.angular, m.mass, m.inverse_mass,
            m.inertia, m.inverse_inertia, m.inertia_kind, m.gyroscopic_kind, m.gyroscopic_rate,
            m.symmetry_axis, s.kind, s.awake, s.quarantined, s.sleep_time, s.sleeping_island,
            s.radius, s.is_conveyor, s.fast, s.active_bodies.dynamic, state_.center,
            state_.generation, state_.motion);
    // Most bodies have one collider.
    auto& c = state_.get<Colliders>();
    auto& filter = state_.get<PairFilter>();
    reserve(bodies, c.body, c.shape, c.local, c.material, c.inner_extent, c.outer_radius, c.begin,
            c.count, c.shape_bits, filter.body, filter.group, filter.mask);
}

void SceneBuilder::add_forces(const Scene& scene, std::span<const BodyId> ids)
{
    auto& forces = state_.get<Forces>();
    std::vector<std::uint32_t> places;
    for (const BodyId id : ids) places.push_back(id.index);
    if (!scene.springs.empty()) {
        join_springs(scene.springs, places, state_.center, state_.get<BodyStates>(), forces);
    }
    state_.warn_of_substeps();
    if (state_.fields.add(scene, places, forces)) state_.wake_all();
}

std::vector<BodyId> SceneBuilder::add(const Scene& scene)
{
    grow_lists(scene.body_count());
    add_materials(scene);
    shapes_.reserve(scene.shapes.size());
    moving_.resize(scene.shapes.size());
    const ShapeUses uses = shape_uses(scene);
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const ShapeDescription& shape = scene.shapes[i];
        const auto* const mesh = std::get_if<MeshShape>(&shape.shape);
        const bool moves = mesh != nullptr && uses.dynamic[i];
        if (moves) moving_[i] = add_solid(scene, shape.name, *mesh);
        shapes_.push_back(moves && !uses.other[i] ? PlacedShape{} : add_shape(scene, shape));
    }
    const auto shape_of = [&](const BodyDescription& body) -> const PlacedShape* {
        if (body.shape == kNone) return nullptr;
        const PlacedShape& moving = moving_[body.shape];
        const bool apart = body.motion == Motion::dynamic && !moving.parts.empty();
        return apart ? &moving : &shapes_[body.shape];
    };
    std::vector<BodyId> ids;
    ids.reserve(scene.body_count());
    for (const BodyDescription& body : scene.bodies) ids.push_back(add_body(body, shape_of(body)));
    for (const Instances& group : scene.instances) {
        BodyDescription body = group.common;
        const PlacedShape* const shared = shape_of(body);
        if (group.own_sizes) make_room_for(shared->parts[0].kind, group.count());
        for (std::size_t i = 0; i < group.count(); ++i) {
            const double* r = group.records.data() + i * group.stride();
            body.position = Vec3(r[0], r[1], r[2]);
            body.orientation = Quat(r[3], r[4], r[5], r[6]);
            body.velocity = Vec3(r[7], r[8], r[9]);
            body.angular_velocity = Vec3(r[10], r[11], r[12]);
            if (!group.own_sizes) {
                ids.push_back(add_body(body, shared));
                continue;
            }
            const ShapeRef own = sized(shared->parts[0].kind, r + 13);
            const PlacedShape shape{{own}, {Pose{}}, mass_of(state_.get<Shapes>(), own)};
            ids.push_back(add_body(body, &shape));
        }
    }
    add_forces(scene, ids);
    if (!state_.sensors.empty()) state_.call_sensors();
    state_.effects_stale = true;
    // Springs turn bodies that were there before, or not as they came.
    if (!scene.springs.empty()) state_.census_stale = true;
    return ids;
}

}  // namespace throng
