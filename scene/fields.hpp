// Fields: every key of a scene file, once.
//
// The reader, the writer, the rules and the schema go through these tables: a new key is a member
// in throng/scene.hpp and a row here.
#pragma once

#include "scene/field.hpp"
#include "scene/limits.hpp"

namespace throng {

inline constexpr Range kPlaces{-kGreatestLength, kGreatestLength, "a place in m"};
inline constexpr Range kLengths{kLeastLength, kGreatestLength, "a length above 0 m"};
inline constexpr Range kVelocities{-kGreatestLength, kGreatestLength, "a velocity in m/s"};
inline constexpr Range kSpins{-kGreatestLength, kGreatestLength, "a velocity in rad/s"};
inline constexpr Range kFrictions{0, kGreatestNumber, "a friction of at least 0"};
inline constexpr Range kRestitutions{0, 1, "a restitution from 0 to 1"};

// A row a key: how it is called, its unit, what it means; the member and its range; what is asked
// for where it is missing; what holds where it is left out.
// clang-format off

inline constexpr Field<Material> kMaterialFields[] = {
    {"density", "kg/m3", "Makes the mass of bodies that state none.",
        &Material::density, {kLeastMass, kGreatestMass, "a density above 0 kg/m3"}},
    {"friction", "1", "Coulomb's coefficient; two materials meet with the geometric mean of theirs.",
        &Material::friction, kFrictions},
    {"restitution", "1", "Speed after an impact over speed before it; two materials meet with the greater of theirs.",
        &Material::restitution, kRestitutions},
    {"rolling_friction", "m", "Lever arm of the torque that resists rolling; two materials meet with the greater of theirs.",
        &Material::rolling_friction, {0, kGreatestLength, "a rolling friction of at least 0 m"}},
};

inline constexpr Field<MaterialPairDescription> kPairFields[] = {
    {"materials", "", "Names of two materials, or of one twice; each two once.",
        ByHand{R"("type": "array", "items": {"type": "string"}, "minItems": 2, "maxItems": 2)"}, {}, "a list of two names of materials"},
    {"friction", "1", "Coulomb's coefficient between the two.",
        &MaterialPairDescription::friction, kFrictions, {}, "as without the pair"},
    {"restitution", "1", "Speed after an impact over speed before it.",
        &MaterialPairDescription::restitution, kRestitutions, {}, "as without the pair"},
};

// ---- Shapes.

inline constexpr Field<SphereShape> kSphereFields[] = {
    {"radius", "m", "Of the ball.", &SphereShape::radius, kLengths, "a length in m"},
};
inline constexpr Field<CapsuleShape> kCapsuleFields[] = {
    {"radius", "m", "About the axis.", &CapsuleShape::radius, kLengths, "a length in m"},
    {"half_length", "m", "Half of the segment along the axis, without the round ends.",
        &CapsuleShape::half_length, kLengths, "a length in m"},
};
inline constexpr Field<CylinderShape> kCylinderFields[] = {
    {"radius", "m", "About the axis.", &CylinderShape::radius, kLengths, "a length in m"},
    {"half_length", "m", "Half of what lies along the axis.",
        &CylinderShape::half_length, kLengths, "a length in m"},
};
inline constexpr Field<BoxShape> kBoxFields[] = {
    {"half_extents", "m", "Half of each side, along the body's axes.",
        &BoxShape::half_extents, kLengths, "three lengths [x, y, z]"},
};
inline constexpr Field<HullShape> kHullFields[] = {
    {"points", "m", "Corners, in the body's axes; those inside are left out.",
        &HullShape::points, kPlaces, "a list of points"},
};
inline constexpr Field<PlaneShape> kPlaneFields[] = {
    {"normal", "1", "Out of what is solid; within 1e-6 of unit length.",
        &PlaneShape::normal, {}, "a direction [x, y, z]"},
    {"offset", "m", "Distance of the plane from the origin, along the normal.",
        &PlaneShape::offset, {-kGreatestLength, kGreatestLength, "an offset in m"}},
};
inline constexpr Field<MeshShape> kMeshFields[] = {
    {"file", "", "Wavefront OBJ, or STL in text or bytes.",
        &MeshShape::file, {}, "the name of an OBJ or STL file"},
    {"scale", "1", "Vertices are multiplied by it.",
        &MeshShape::scale, {kLeastLength, kGreatestLength, "a factor above 0"}},
    {"nonconvex", "", "How a moving mesh is taken.",
        OfDial<MeshShape>{&MeshShape::nonconvex}, {}, {}, "as the settings say"},
    {"voxel_size", "m", "Side of a voxel of a moving mesh.",
        OfDial<MeshShape>{&MeshShape::voxel_size}, {}, {}, "as the settings say"},
    {"image_resolution", "", "Rays of depth images along the longest side of the smaller shape of a pair.",
        OfDial<MeshShape>{&MeshShape::image_resolution}, {}, {}, "as the settings say"},
    {"sphere_levels", "", "Levels of the sphere tree.",
        OfDial<MeshShape>{&MeshShape::sphere_levels}, {}, {}, "as the settings say"},
    {"max_parts", "", "Convex parts of a shape, at most.",
        OfDial<MeshShape>{&MeshShape::max_parts}, {}, {}, "as the settings say"},
};
inline constexpr Field<VoxelsShape> kVoxelsFields[] = {
    {"file", "", "OpenVDB; its first float level set, of voxels that are cubes along the axes.",
        &VoxelsShape::file, {}, "the name of a .vdb file"},
};
/// Of each part of a compound; where it stands is in kPoseFields.
inline constexpr Field<CompoundShape::Part> kPartFields[] = {
    {"shape", "", "Name of a shape, given before or after this one.",
        NameOf<CompoundShape::Part>{&CompoundShape::Part::shape, Named::shape}, {}, "the name of a shape"},
};
inline constexpr Field<Pose> kPoseFields[] = {
    {"position", "m", "In the axes of the whole.", &Pose::position, kPlaces},
    {"orientation", "", "Turns the part's axes into those of the whole.", &Pose::orientation},
};

constexpr std::span<const Field<SphereShape>> fields_of(const SphereShape&) { return kSphereFields; }
constexpr std::span<const Field<CapsuleShape>> fields_of(const CapsuleShape&) { return kCapsuleFields; }
constexpr std::span<const Field<CylinderShape>> fields_of(const CylinderShape&) { return kCylinderFields; }
constexpr std::span<const Field<BoxShape>> fields_of(const BoxShape&) { return kBoxFields; }
constexpr std::span<const Field<HullShape>> fields_of(const HullShape&) { return kHullFields; }
constexpr std::span<const Field<PlaneShape>> fields_of(const PlaneShape&) { return kPlaneFields; }
constexpr std::span<const Field<MeshShape>> fields_of(const MeshShape&) { return kMeshFields; }
constexpr std::span<const Field<VoxelsShape>> fields_of(const VoxelsShape&) { return kVoxelsFields; }
constexpr std::span<const Field<CompoundShape>> fields_of(const CompoundShape&) { return {}; }

/// Kinds of shapes, in the order of ShapeDescription::shape.
struct ShapeName {
    std::string_view name, meaning;
};
inline constexpr ShapeName kShapeNames[] = {
    {"sphere", "A ball round the body's origin."},
    {"capsule", "Axis z; half_length is of the segment, without the round ends."},
    {"cylinder", "Axis z."},
    {"box", "Sides along the body's axes, its middle at the origin."},
    {"hull", "The smallest convex shape round the points."},
    {"plane", "The points with normal . x = offset, solid below. Not for dynamic bodies."},
    {"mesh", "Triangles, counter-clockwise seen from outside."},
    {"compound", "Spheres, capsules, cylinders, boxes and hulls, each placed in the axes of the whole."},
    {"voxels", "A level set: how far every place is from a surface, below 0 inside. Where its values end before the surface does, the shape is cut off, and is not for dynamic bodies."},
};
static_assert(std::size(kShapeNames) == std::variant_size_v<decltype(ShapeDescription::shape)>);

// ---- Bodies.

inline constexpr std::string_view kMotions[] = {"static", "kinematic", "dynamic"};  // as in Motion

inline constexpr Field<BodyDescription> kDragFields[] = {
    {"linear", "kg/s", "Force over velocity against the wind.",
        &BodyDescription::linear_drag, {0, kGreatestNumber, "a drag of at least 0 kg/s"}},
    {"angular", "kg m2/s", "Torque over angular velocity.",
        &BodyDescription::angular_drag, {0, kGreatestNumber, "a drag of at least 0 kg m2/s"}},
};

/// What bodies state, and what all of a group of instances share.
inline constexpr Field<BodyDescription> kBodyFields[] = {
    {"shape", "", "Name of a shape; null for a body without collision.",
        NameOf<BodyDescription>{&BodyDescription::shape, Named::shape, true}, {}, "the name of a shape, or null"},
    {"material", "", "Name of a material.",
        NameOf<BodyDescription>{&BodyDescription::material, Named::material}, {}, {}, "density 1000, friction 0.5, restitution 0"},
    {"motion", "", "A dynamic body is moved by forces and contacts, a kinematic one follows its velocities, a static one stays.",
        &BodyDescription::motion},
    {"mass", "kg", "Of a dynamic body; has to be given where the shape is null.",
        &BodyDescription::mass, {kLeastMass, kGreatestMass, "a mass above 0 kg"}, {}, "from density and shape"},
    {"inertia", "kg m2", "About the center of mass, body axes: [xx, yy, zz, xy, xz, yz].",
        &BodyDescription::inertia, {}, {}, "from mass and shape"},
    {"center", "m", "Center of mass, in body axes.",
        &BodyDescription::center, kPlaces, {}, "from the shape"},
    {"force", "N", "At the center of mass, constant, world axes.",
        &BodyDescription::force, {-kGreatestNumber, kGreatestNumber, "a force in N"}},
    {"torque", "N m", "Constant, world axes.",
        &BodyDescription::torque, {-kGreatestNumber, kGreatestNumber, "a torque in N m"}},
    {"drag", "", "Against the motion through the air.",
        Group<BodyDescription>{kDragFields}, {}, {}, "none"},
    {"pivot", "m", "This point of the body, in its axes, stays where it is, and bears what the body stands on next to it. `velocity` is then that of its turning, and is left out.",
        &BodyDescription::pivot, kPlaces, {}, "none"},
    {"drive_velocity", "m/s", "World axes; components that are not null are set before every step; friction with the ground pulls with them.",
        &BodyDescription::drive_velocity, kVelocities},
    {"lock_rotation", "", "It never turns.", &BodyDescription::lock_rotation},
    {"lock_position", "", "Its center of mass stays where it is.", &BodyDescription::lock_position},
    {"group", "", "Filter, 32 bits: two bodies may touch when a.group & b.mask and b.group & a.mask are both not zero.",
        Bits<BodyDescription>{&BodyDescription::group}},
    {"mask", "", "Filter, 32 bits: the groups that it may touch.",
        Bits<BodyDescription>{&BodyDescription::mask}},
    {"fast", "", "Continuous collision at any speed: it is held where it first meets something. Others are watched once they may go half of their smallest half extent in a step.",
        &BodyDescription::fast},
    {"sensor", "", "It touches nothing, and tells a program that listens who overlaps it. Of convex shapes, or a compound of them.",
        &BodyDescription::sensor},
    {"gravity_scale", "1", "Gravity on it, of that of the scene.",
        &BodyDescription::gravity_scale, {-kGreatestNumber, kGreatestNumber, "a factor"}},
    {"user_data", "", "A whole number that a program keeps with it, from 0 to 2^53.",
        &BodyDescription::user_data},
};

/// What a body states for itself alone.
inline constexpr Field<BodyDescription> kOwnBodyFields[] = {
    {"name", "", "Its own among bodies; springs refer to it.", &BodyDescription::name, {}, {}, "none"},
    {"position", "m", "Of the body's own frame.", &BodyDescription::position, kPlaces},
    {"orientation", "", "Turns body axes into world axes.", &BodyDescription::orientation},
    {"velocity", "m/s", "Of the center of mass, world axes.", &BodyDescription::velocity, kVelocities},
    {"angular_velocity", "rad/s", "World axes.", &BodyDescription::angular_velocity, kSpins},
};

inline constexpr Field<Instances> kInstancesFields[] = {
    {"count", "", "How many records are in the file.",
        ByHand{R"("type": "integer", "minimum": 0, "maximum": 4294967294)"}, {}, {}, "as many as the file holds"},
    {"file", "", "Little-endian doubles, 13 a body: position, orientation (w, x, y, z), velocity, angular velocity.",
        &Instances::file, {}, "the name of a file of records"},
    {"sizes", "", "\"file\": three more doubles a body: half extents of a box; radius of a sphere, 0, 0; radius and half length of a capsule or cylinder, 0.",
        ByHand{R"("const": "file")"}, {}, {}, "all as the shape says"},
};

// ---- What acts on bodies.

inline constexpr Field<Spring> kSpringFields[] = {
    {"a", "", "Name of a body; null is the world.",
        NameOf<Spring>{&Spring::a, Named::body, true}, {}, "the name of a body, or null for the world"},
    {"b", "", "Name of another body; null is the world.",
        NameOf<Spring>{&Spring::b, Named::body, true}, {}, "the name of a body, or null for the world"},
    {"at_a", "m", "Where it is fixed, in the axes of a.", &Spring::at_a, kPlaces},
    {"at_b", "m", "Where it is fixed, in the axes of b.", &Spring::at_b, kPlaces},
    {"stiffness", "N/m", "Force over what it is longer than at rest.",
        &Spring::stiffness, {0, kGreatestNumber, "a stiffness of at least 0 N/m"}, "a stiffness in N/m"},
    {"damping", "N s/m", "Force over the speed at which it grows longer.",
        &Spring::damping, {0, kGreatestNumber, "a damping of at least 0 N s/m"}},
    {"length", "m", "At rest.", &Spring::length, {0, kGreatestLength, "a length of at least 0 m"}},
};

inline constexpr Field<Attractor> kAttractorFields[] = {
    {"position", "m", "World axes.", &Attractor::position, kPlaces},
    {"strength", "m3/s2", "Draws bodies near by an acceleration of strength / distance^2; below 0 drives them off. Nearer than where a circle takes 62.8 substeps, (100 strength)^(1/3) substep^(2/3), it acts smoothly less, nothing in the middle, for a substep could not follow it.",
        &Attractor::strength, {-kGreatestNumber, kGreatestNumber, "a strength"}, "a strength"},
};

// ---- The whole.

inline constexpr Field<Scene> kSceneFields[] = {
    {"throng", "", "Version of the format.", ByHand{R"("const": 1)"}, {}, "1, the version of the format"},
    {"gravity", "m/s2", "Acceleration of all that is free to fall.",
        &Scene::gravity, {-kGreatestLength, kGreatestLength, "an acceleration in m/s2"}},
    {"wind", "m/s", "Velocity of the air: drag is against it.", &Scene::wind, kVelocities},
    {"settings", "", "Dials: what trades accuracy for time. Values that a build does not offer are refused by name.",
        ByHand{R"("$ref": "#/$defs/settings")"}, {}, {}, "each dial its default"},
    {"materials", "", "What surfaces are made of, by name.",
        ByHand{R"("type": "object", "propertyNames": {"minLength": 1}, "additionalProperties": {"$ref": "#/$defs/material"})"}},
    {"pairs", "", "What two materials have together, in place of the geometric mean of their frictions and the greater restitution.",
        ByHand{R"("type": "array", "items": {"$ref": "#/$defs/pair"})"}},
    {"shapes", "", "What bodies collide as, by name.",
        ByHand{R"("type": "object", "propertyNames": {"minLength": 1}, "additionalProperties": {"$ref": "#/$defs/shape"})"}},
    {"bodies", "", "Ids 0, 1, ... in this order.",
        ByHand{R"("type": "array", "items": {"$ref": "#/$defs/body"})"}},
    {"instances", "", "Many bodies alike; ids go on from the last of bodies.",
        ByHand{R"("type": "array", "items": {"$ref": "#/$defs/instances"})"}},
    {"springs", "", "Springs with dampers, between two bodies or a body and the world.",
        ByHand{R"("type": "array", "items": {"$ref": "#/$defs/spring"})"}},
    {"attractors", "", "Points that draw bodies near, or drive them off.",
        ByHand{R"("type": "array", "items": {"$ref": "#/$defs/attractor"})"}},
};

// clang-format on

}  // namespace throng
