// Balances: buildings that friction and weight alone hold up, with little to spare.
#include "scene/catalog/parts.hpp"
#include "scene/catalog/recipes.hpp"

#include <cmath>
#include <numbers>

namespace throng {

namespace {

// Cards of 0.4 x 0.25 m and 2 mm thick, leaning 25 degrees from upright.
const Vec3 kHalfCard(0.2, 0.125, 0.001);  // along the card, its width, its thickness
constexpr double kLean = 25 * std::numbers::pi / 180;

}  // namespace

// A house of cards: level by level, tents of two leaning cards, and a flat card from each tent's
// ridge to the next. Stresses thin shapes, edges that meet edges, and friction that must hold for
// ever: nothing but it keeps a tent from sliding open.
//
// The flat cards of a level lie end to end, so each ridge carries one on either side; a ridge has
// two edges 3.6 mm apart and the cards' ends meet between them. A tent on a rough floor stands by
// itself when the friction is above tan(lean) / 2 = 0.233.
//
// Source: the card house of Catto's solver2d, friction 0.7; there the flat cards overlap at first.
Scene make_card_house(int size, std::uint64_t /*seed*/)
{
    Scene scene = begin_scene("card_house", size);
    scene.materials[0].name = "card";
    scene.materials[0].friction = 0.7;
    add_ground(scene);

    // A leaning card reaches this far from its center, sideways and up.
    const double sideways = kHalfCard.x() * std::sin(kLean) + kHalfCard.z() * std::cos(kLean);
    const double upwards = kHalfCard.x() * std::cos(kLean) + kHalfCard.z() * std::sin(kLean);
    const double separation = 0.0004;  // between the ends of flat cards, well within the ridge
    const double pitch = 2 * kHalfCard.x() + separation;
    const Quat leaning_right = turn(Vec3::UnitY(), kLean - std::numbers::pi / 2);
    const Quat leaning_left = turn(Vec3::UnitY(), -kLean - std::numbers::pi / 2);

    const std::uint32_t card = add_shape(scene, "card", BoxShape{kHalfCard});
    const auto levels = static_cast<std::size_t>(size);
    Instances& cards = add_instances(scene, card, (3 * levels * levels + levels) / 2, false);
    double floor = 0;
    for (int tents = size; tents >= 1; --tents) {
        const double first = -(tents - 1) / 2.0 * pitch;
        for (int i = 0; i < tents; ++i) {
            const double ridge = first + i * pitch;
            add_record(cards, {{ridge - sideways, 0, floor + upwards}, leaning_right});
            add_record(cards, {{ridge + sideways, 0, floor + upwards}, leaning_left});
        }
        const double roof = floor + 2 * upwards + kHalfCard.z();
        for (int i = 0; i + 1 < tents; ++i)
            add_record(cards, {{first + (i + 0.5) * pitch, 0, roof}, Quat::Identity()});
        floor = roof + kHalfCard.z();
    }
    return scene;
}

// An arch of wedges along a hanging chain turned upside down, the one curve along which weight
// alone presses stone on stone squarely. Stresses long chains of load, where each joint's error
// adds to those before it: it stands only as long as the line of thrust stays within the stones.
//
// The chain is z = a (cosh 2 - cosh(x / a)) with a from the length: a meter a stone, measured along
// the middle. It meets the ground 15 degrees from upright, where friction of tan 15 = 0.28 holds
// it.
//
// Source: arches of 25 to 951 stones with friction 0.5 in rigid-ipc's scenes (Ferguson and others,
//         Intersection-free Rigid Body Dynamics, 2021); the curve is Hooke's (1676).
Scene make_arch(int size, std::uint64_t /*seed*/)
{
    Scene scene = begin_scene("arch", size);
    add_ground(scene);
    scene.bodies.reserve(static_cast<std::size_t>(size) + 1);

    const double half_thickness = 0.5, half_width = 0.5;
    const double steepest = std::sinh(2.0);
    const double a = size / (2 * steepest);

    // A joint between stones, from its inner end to its outer one, in the plane of the arch.
    struct Joint {
        Vec3 inner, outer;
    };
    const auto joint_after = [&](int stones) {
        const double slope = steepest * (2.0 * stones / size - 1);
        const double secant = std::sqrt(1 + slope * slope);
        const Vec3 middle(a * std::asinh(slope), 0, a * (std::cosh(2.0) - secant));
        const Vec3 outward(slope / secant, 0, 1 / secant);
        if (stones > 0 && stones < size)
            return Joint{middle - half_thickness * outward, middle + half_thickness * outward};
        // The feet are cut level, with the ground.
        const double offset = std::copysign(half_thickness * secant / steepest, slope);
        return Joint{{middle.x() - offset, 0, 0}, {middle.x() + offset, 0, 0}};
    };

    Joint left = joint_after(0);
    for (int i = 0; i < size; ++i) {
        const Joint right = joint_after(i + 1);
        const Vec3 corners[] = {left.inner, left.outer, right.outer, right.inner};
        left = right;

        // The centroid of the face: of its two triangles, each by its area.
        const auto area = [&](int p, int q) {
            return (corners[p] - corners[0]).cross(corners[q] - corners[0]).norm();
        };
        const double first = area(1, 2), second = area(2, 3);
        const Vec3 centroid = (first * (corners[0] + corners[1] + corners[2])
                               + second * (corners[0] + corners[2] + corners[3]))
            / (3 * (first + second));

        HullShape wedge;
        for (const Vec3& corner : corners)
            for (const double y : {-half_width, half_width})
                wedge.points.emplace_back(corner - centroid + Vec3(0, y, 0));
        BodyDescription& stone = scene.bodies.emplace_back();
        stone.shape = add_shape(scene, "stone " + std::to_string(i), std::move(wedge));
        stone.material = 0;
        stone.position = centroid;
    }
    return scene;
}

}  // namespace throng
