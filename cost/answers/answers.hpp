// Answers: scenes of the catalogue whose motion is known, and how far a run of one is from it,
// whoever stepped it.
#pragma once

#include "pipeline/records/peer_scene.hpp"
#include "throng/scene.hpp"

#include <functional>
#include <span>
#include <string_view>

namespace throng {

/// What is known of a scene.
///
///   scene     its name in the catalogue
///   quantity  whose mean over the steps the error is
///   time      s, for which SimBenchmark follows it
///   judge     makes of a scene what tells that quantity of its bodies `now` seconds on
struct SceneAnswer {
    std::string_view scene, quantity, unit;
    double time = 0;
    using Judge = std::function<double(double now, std::span<const PeerState> states)>;
    Judge (*judge)(const Scene& scene) = nullptr;
};

/// All there are.
///
///   rolling            that of the box's velocity and the mean of the balls', squared, m2/s2
///   bouncing,
///   elastic_ball_cube  that of the energy, squared, J2
///   ball_cube          the squares of all overlaps, added up, m2
///
/// Source: Kang and Hwangbo, SimBenchmark (leggedrobotics), 2018, whose rolling looks at one of the
///         balls.
std::span<const SceneAnswer> scene_answers();

/// That of the scene of this name, or null.
const SceneAnswer* find_answer(std::string_view scene);

/// The error of one run.
class RunError {
public:
    /// The scene as the catalogue makes it, of any size; settings do not matter.
    RunError(const SceneAnswer& answer, const Scene& scene);
    /// Takes in the end of a step. Throws std::invalid_argument for other than the scene's bodies.
    void add(double now, std::span<const PeerState> states);
    /// The mean over the steps so far; infinite once a state was not finite, 0 before any.
    double mean() const;

private:
    SceneAnswer::Judge judge_;
    std::size_t bodies_ = 0;
    double sum_ = 0;
    std::size_t steps_ = 0;
};

}  // namespace throng
