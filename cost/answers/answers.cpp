#include "cost/answers/answers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace throng {

namespace {

using States = std::span<const PeerState>;

/// A ball of the scene, or what is none: of radius 0.
struct Ball {
    double mass = 0, radius = 0;
};

// By body, in the order of ids.
std::vector<Ball> balls_of(const Scene& scene)
{
    std::vector<Ball> balls;
    const auto add = [&](const BodyDescription& body) {
        const auto* const sphere = std::get_if<SphereShape>(&scene.shapes[body.shape].shape);
        balls.push_back(sphere == nullptr ? Ball{} : Ball{body.mass.value(), sphere->radius});
    };
    for (const BodyDescription& body : scene.bodies) add(body);
    for (const Instances& group : scene.instances)
        for (std::size_t i = 0; i < group.count(); ++i) add(group.common);
    return balls;
}

double friction_of(const Scene& scene, std::uint32_t a, std::uint32_t b)
{
    return std::sqrt(scene.materials[a].friction * scene.materials[b].friction);
}

// The ground, the box that is pulled, the balls. Friction below the box, mu (M + n m) g, holds it
// back, and so does each ball by what friction gives it: a ball that rolls without slip goes with
// 2/7 of the box's acceleration.
SceneAnswer::Judge judge_rolling(const Scene& scene)
{
    const BodyDescription& box = scene.bodies[1];
    const Instances& balls = scene.instances.front();
    const double count = static_cast<double>(balls.count()), gravity = -scene.gravity.z();
    const double all = box.mass.value() + count * balls.common.mass.value();
    const double below = friction_of(scene, scene.bodies[0].material, box.material);
    const double driven = std::max(0.0, box.force.norm() - below * all * gravity);
    const Vec3 acceleration = driven
        / (box.mass.value() + count * balls.common.mass.value() * 2 / 7) * box.force.normalized();
    return [acceleration, count](double now, States states) {
        const Vec3 of_box = acceleration * now, of_ball = of_box * 2 / 7;
        double sum = 0;
        for (const PeerState& ball : states.subspan(2))
            sum += (ball.velocity - of_ball).squaredNorm();
        return (states[1].velocity - of_box).squaredNorm() + sum / count;
    };
}

double energy_of(const std::vector<Ball>& balls, double gravity, States states)
{
    double energy = 0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const auto& [mass, radius] = balls[i];
        energy += mass
            * (states[i].velocity.squaredNorm() / 2
               + radius * radius * states[i].angular_velocity.squaredNorm() / 5
               + gravity * states[i].pose.position.z());
    }
    return energy;
}

// At first nothing moves.
double energy_at_first(const std::vector<Ball>& balls, const Scene& scene)
{
    double energy = 0;
    std::size_t at = scene.bodies.size();
    for (const Instances& group : scene.instances)
        for (std::size_t i = 0; i < group.count(); ++i, ++at)
            energy -= balls[at].mass * scene.gravity.z() * group.records[i * group.stride() + 2];
    return energy;
}

SceneAnswer::Judge judge_energy(const Scene& scene)
{
    const std::vector<Ball> balls = balls_of(scene);
    const double gravity = -scene.gravity.z(), wanted = energy_at_first(balls, scene);
    return [=](double, States states) {
        const double error = energy_of(balls, gravity, states) - wanted;
        return error * error;
    };
}

// Of balls in one another and in the ground at z = 0. They are gone through in the order of x.
double squared_overlaps(const std::vector<Ball>& balls, States states)
{
    std::vector<std::size_t> order(balls.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto is_none = [&](std::size_t i) { return balls[i].radius == 0; };
    order.erase(std::remove_if(order.begin(), order.end(), is_none), order.end());
    const auto place = [&](std::size_t i) -> const Vec3& { return states[i].pose.position; };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return place(a).x() < place(b).x(); });
    double largest = 0;
    for (const Ball& ball : balls) largest = std::max(largest, ball.radius);
    double sum = 0;
    const auto add = [&](double separation) {
        if (separation < 0) sum += separation * separation;
    };
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t a = order[k];
        add(place(a).z() - balls[a].radius);
        for (std::size_t n = k + 1; n < order.size(); ++n) {
            const std::size_t b = order[n];
            if (place(b).x() - place(a).x() > balls[a].radius + largest) break;
            add((place(b) - place(a)).norm() - balls[a].radius - balls[b].radius);
        }
    }
    return sum;
}

SceneAnswer::Judge judge_overlaps(const Scene& scene)
{
    return [balls = balls_of(scene)](double, States states) {
        return squared_overlaps(balls, states);
    };
}

bool is_finite(const PeerState& state)
{
    return state.pose.position.allFinite() && state.velocity.allFinite()
        && state.angular_velocity.allFinite();
}

// clang-format off
constexpr SceneAnswer kAnswers[] = {
    {"rolling",           "squared error of the velocities", "m2/s2",  4, judge_rolling},
    {"bouncing",          "squared error of the energy",     "J2",    20, judge_energy},
    {"ball_cube",         "squared overlaps, added up",      "m2",    10, judge_overlaps},
    {"elastic_ball_cube", "squared error of the energy",     "J2",    10, judge_energy},
};
// clang-format on

}  // namespace

std::span<const SceneAnswer> scene_answers() { return kAnswers; }

const SceneAnswer* find_answer(std::string_view scene)
{
    for (const SceneAnswer& answer : kAnswers)
        if (answer.scene == scene) return &answer;
    return nullptr;
}

RunError::RunError(const SceneAnswer& answer, const Scene& scene)
    : judge_(answer.judge(scene)), bodies_(scene.body_count())
{ }

void RunError::add(double now, std::span<const PeerState> states)
{
    if (states.size() != bodies_)
        throw std::invalid_argument("RunError: got the states of " + std::to_string(states.size())
                                    + " bodies; give those of the scene, "
                                    + std::to_string(bodies_));
    const bool finite = std::all_of(states.begin(), states.end(), is_finite);
    sum_ += finite ? judge_(now, states) : std::numeric_limits<double>::infinity();
    ++steps_;
}

double RunError::mean() const { return steps_ > 0 ? sum_ / static_cast<double>(steps_) : 0; }

}  // namespace throng
