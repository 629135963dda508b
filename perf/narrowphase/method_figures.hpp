// Method figures: what every convex method takes for a question, how far off its answers are, how
// often they are wrong or none.
#pragma once

#include "perf/narrowphase/turns.hpp"

namespace throng::perf {

inline constexpr double kReach = 0.02;  // m, as in a pile of bodies of 1 m

// Within reach of the far ones is nothing, so that they need no more than to be told so.
inline constexpr PairCase kFar{"far", 2, kReach};
inline constexpr PairCase kNear{"near", 0.1, 1e9};
// Nearer than what double can be asked to tell for good: where verdicts go wrong, if they do.
inline constexpr PairCase kGrazing{"grazing", 1e-12, kReach, true};
inline constexpr PairCase kTouching{"touching", -0.005, kReach};
inline constexpr PairCase kDeep{"deep", -0.2, kReach};
inline constexpr PairCase kPairCases[] = {kFar, kNear, kGrazing, kTouching, kDeep};

// A body that settles, and one that tumbles at some 6 rad/s.
inline constexpr Motion kSmall{"small", 0.002};
inline constexpr Motion kLarge{"large", 0.1};

/// Separating axes are not asked about more vertices than this where nothing parts the two: what
/// they take there grows with the square.
inline constexpr std::size_t kMostAxes = 1000;

/// What the answers about some pairs were worth.
///
///   error     the worst, m; of volumes, as a part of what is shared
///   asked     answers looked at; of them
///   wrong     said yes where it is no, or no where it is yes
///   undecided said neither
struct Worth {
    std::string error_of;
    double error = kNone;
    int asked = 0, wrong = 0, undecided = 0;

    void add_error(std::string_view of, double more)
    {
        // Depths and distances are both lengths.
        error_of = error_of.empty() || error_of == of ? of : "length";
        if (!(more <= error)) error = more;
    }
};

struct Row {
    std::string_view method;
    std::string build;
    std::string_view pair_case;
    double cold = kNone, plain = kNone, warm_small = kNone, warm_large = kNone;  // ns
    Worth worth;
};

/// Figures of all methods for one build in one meeting.
///
///   unproved  m, raised to the worst that any truth is not proved to
void measure_meeting(const Shapes& shapes,
                     const Build& build,
                     const PairCase& pair_case,
                     const Effort& effort,
                     double& unproved,
                     std::vector<Row>& rows);

}  // namespace throng::perf
