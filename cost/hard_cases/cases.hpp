// Cases: the hard cases that throng claims, each with a setting, a figure and the bound it keeps.
//
// A case is a program that goes through the public door, so that what it shows is what a user gets.
// The command and the tests run the very same ones. To add one: write it in hard_cases/, list it in
// cases.cpp.
#pragma once

#include "cost/changes.hpp"
#include "throng/convex_query.hpp"
#include "throng/impact_query.hpp"
#include "throng/volume_query.hpp"

#include <functional>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace throng {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kGravity = 9.81;  // m/s2, where a case does not say another

/// missed: the default misses a bound that a named setting of the same case meets. shown: held to
/// no bound, and so no verdict.
enum class Verdict : std::uint8_t { pass, fail, skipped, missed, shown };

/// One line of a case's answer. A figure passes when it is at most its bound.
struct CaseResult {
    std::string name;      // H8
    std::string method;    // of those that convex_query.hpp lists; empty where none was asked
    std::string setting;   // n=10
    std::string quantity;  // greatest overlap
    double figure = 0;
    double bound = 0;
    std::string unit;  // 1 where it has none
    Verdict verdict = Verdict::fail;
    std::string why;     // of a skipped one, or one that lost a body
    double time_ms = 0;  // of the run that the figure comes from
};

/// A mistake planted on purpose, to show that a case would notice it.
enum class Fault : std::uint8_t {
    none,
    friction,     // coefficients 10 % too small
    mass,         // bodies 10 % too heavy
    float_poses,  // poses rounded to float after every step, and before a method sees them
    nudge,        // pairs handed to a method off by a millionth of their size, and of a radian
    spin,         // bodies that turn 5 % too fast
    stiffness,    // springs 10 % too stiff
    late,         // times of impact a hundredth too late, and touches at the start not seen
    overlap,      // bodies that may overlap, whatever was asked
    haste,        // bodies that go 5 % faster after every step
    restitution,  // coefficients of restitution 10 % too small
    shrink,       // meshes a tenth too small, and all that is asked for its shared volume
    unsteady,     // bodies moved a bit after every step, in each run by another
    grip,         // coefficients of friction 10 % too great
    sink,         // bodies moved down by a millimeter after every step
    skew,         // bodies moved and pushed aslant after every step, each by more than the last
    whirl,        // bodies that turn faster by a radian a second after every step
    modesty,      // errors told a tenth as great as they are estimated
};

/// How much of a case is run: all of it, or what a test has time for.
enum class Extent : std::uint8_t { brief, whole };

/// A run that a case has come to the end of.
///
///   scene      as it was run
///   duration   s that the case's own steps add up to, had the run not been ended early
///   simulated  s that its steps did
///   steps_ms   ms of the clock that they took
///   lost       bodies that were quarantined
struct CaseRun {
    const Scene& scene;
    double duration = 0, simulated = 0, steps_ms = 0;
    std::size_t lost = 0;
};

/// Who waits for a case: sees each line as soon as it is there, and may want no more of them.
struct CaseListener {
    std::function<void(const CaseResult&)> line = [](const CaseResult&) {};
    /// Asked after every step, question and line.
    std::function<bool()> enough = [] { return false; };
    /// Keeps an energy ledger of every run by the default dials (but for dt and sleep), and adds a
    /// line at the case's end: the worst of them.
    bool energy = false;
    std::function<void(const CaseRun&)> ran = [](const CaseRun&) {};
};

/// What a case runs on: it makes the worlds, so that settings and faults reach all of them.
class CaseBench {
public:
    /// Thrown out of a case by whatever it asks next, once its listener has had enough.
    struct Stopped { };

    explicit CaseBench(Settings settings = {},
                       Fault fault = Fault::none,
                       int threads = 1,
                       Extent extent = Extent::whole,
                       CaseListener listener = {});

    const Settings& settings() const { return settings_; }
    bool brief() const { return extent_ == Extent::brief; }
    int threads() const { return threads_; }
    /// For runs to come.
    void use_threads(int threads) { threads_ = threads; }
    /// Turns these dials in every scene that the case runs from now on, whatever it had set itself.
    /// A run takes as long as it would by the case's own step. What cannot be had together is
    /// thrown as std::invalid_argument where the case runs.
    void force(Changes changes) { forced_ = std::move(changes); }

    /// A scene with the bench's settings, ready to be filled.
    Scene scene() const;
    /// Runs a scene for a time; `watch` sees the world after every step and may end the run early
    /// by answering false. A ledger is kept of every step.
    void run(const Scene& scene,
             double time,
             const std::function<bool(class World&, double now)>& watch,
             class EnergyLedger* ledger = nullptr);

    /// Shows a scene's world before its first step.
    void inspect(const Scene& scene, const std::function<void(const class World&)>& look);

    /// What a method says of two shapes, placed in the world.
    ConvexAnswer ask(ConvexQuery& query,
                     std::string_view method,
                     const Pose& a,
                     const Pose& b,
                     double size,
                     MethodStart start);

    /// What a step of that precision says of them: whether they touch, and how deep.
    ConvexAnswer
    touch(const ConvexQuery& query, Precision precision, const Pose& a, const Pose& b, double size);

    /// When two shapes first touch, by a method of the dial toi_method; its time counts towards
    /// that method's next line, as does that of linear paths.
    ImpactAnswer ask_impact(const ImpactQuery& query,
                            ToiMethod method,
                            const ShapeMotion& a,
                            const ShapeMotion& b,
                            double duration);
    ImpactAnswer
    ask_linear_paths(const LinearQuestion& question, ToiMethod method, double tolerance);

    /// What a way says that two shapes share; its time counts towards the next line.
    VolumeAnswer ask_volume(std::string_view way,
                            const ShapeDescription& a,
                            const ShapeDescription& b,
                            const Pose& b_in_a,
                            int resolution);

    /// What a step's error was estimated to be, m, as a case is told it.
    double estimated(double error) const { return fault_ == Fault::modesty ? 0.1 * error : error; }

    /// For a case that does not ask how exactly contacts were solved.
    void forgive_residual() { missed_ = 0; }

    /// Adds a line. Time is counted from the last line, or from the start.
    void report(
        std::string setting, std::string quantity, double figure, double bound, std::string unit);

    /// Adds a line about the default where `setting`, which the case runs as well, is what meets
    /// the bound: missed where the default does not. `met_by` empty: as report().
    void report_default(std::string setting,
                        std::string quantity,
                        double figure,
                        double bound,
                        std::string unit,
                        std::string_view met_by);

    /// Adds a figure that is held to nothing.
    void show(std::string setting, std::string quantity, double figure, std::string unit);
    /// The same of how long something took, ns; a brief run has none.
    void report_time(std::string setting, std::string quantity, double ns);
    /// ns, the mean over the steps of the last run.
    double time_a_step() const { return steps_ > 0 ? 1e6 * step_ms_ / steps_ : 0; }

    /// Adds a line about a method; time is what it took since its last line.
    void report_method(std::string_view method,
                       std::string_view setting,
                       std::string quantity,
                       double figure,
                       double bound,
                       std::string unit);
    /// ms, what a method has taken since its last line.
    double spent_on(std::string_view method) const;
    /// Adds a line that says why there is none.
    void skip(std::string setting, std::string quantity, std::string why);

    /// Runs a case. Its lines, as many as there were until the listener had enough.
    std::vector<CaseResult> run(const struct HardCase& which);

private:
    // Places the two, with the fault if there is one, and counts the method's time.
    ConvexAnswer timed(std::string_view method,
                       const Pose& a,
                       const Pose& b,
                       double size,
                       const std::function<ConvexAnswer(const Pose&)>& asked);

    ImpactAnswer timed_impact(ToiMethod method, const std::function<ImpactAnswer()>& asked);

    CaseResult judged(
        std::string setting, std::string quantity, double figure, double bound, std::string unit);
    void keep(CaseResult result);
    void enter_energy(const class EnergyLedger& ledger);
    void fold_energy(const std::string& setting);
    void report_energy();
    // Throws Stopped.
    void stop_where_enough() const;
    // As it is run: by the dials that are forced, with the fault.
    Scene as_run(const Scene& scene) const;

    Settings settings_;
    Changes forced_;
    Fault fault_;
    int threads_;
    Extent extent_;
    CaseListener listener_;
    std::string name_;
    double spent_ms_ = 0;
    double step_ms_ = 0;    // of the last run's steps
    int steps_ = 0;         // of the last run
    int runs_ = 0;          // so far
    std::size_t lost_ = 0;  // bodies quarantined since the last line
    double missed_ = 0;     // greatest residual of the direct solver, likewise
    // What ledgers kept for the listener say, of the run that gained most beside its greatest
    // kinetic energy.
    struct EnergyOfRun {
        double gained = 0, kinetic = 0;  // J
        std::string setting;             // of the line that followed
        bool is_worse_than(const EnergyOfRun& other) const
        {
            return gained * other.kinetic > other.gained * kinetic
                || (gained > 0 && other.gained == 0);
        }
    };
    int energy_runs_ = 0;
    EnergyOfRun energy_, worst_energy_;  // since the last line, and of all
    std::map<std::string, double, std::less<>> method_ms_;
    std::vector<CaseResult> results_;
};

struct HardCase {
    std::string_view name;
    std::string_view about;
    void (*run)(CaseBench& bench);
    Fault shown_by;           // a fault that makes it fail
    bool asks_alone = false;  // asks methods about shapes, and steps no world
};

/// All cases, in the order of their numbers.
std::span<const HardCase> hard_cases();

/// The case of that name (any case of letters), or null.
const HardCase* find_case(std::string_view name);

/// Of one that the listener ended, the lines that were there.
std::vector<CaseResult> run_case(const HardCase& which,
                                 Settings settings = {},
                                 Fault fault = Fault::none,
                                 int threads = 1,
                                 Extent extent = Extent::whole,
                                 CaseListener listener = {});

}  // namespace throng
