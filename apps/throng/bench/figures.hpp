// Figures: what the runs of a benchmark come to.
//
// Repeats are compared one with one, and the median of them is told with its spread. Two engines
// are compared over the steps that both have done, and no others.
#pragma once

#include "apps/throng/bench/run.hpp"

namespace throng::bench {

/// A figure over repeats.
struct Spread {
    double median = 0, least = 0, most = 0;
    /// The whole range beside the median; 0 for a single one.
    double relative() const { return median > 0 ? (most - least) / median : 0; }
};

/// How many times faster than another engine, over equal steps.
struct Comparison {
    std::string engine, setting;
    int threads = 1;
    std::size_t steps = 0;  // that both have done
    Spread times;           // by the clock
    Spread cpu_times;       // by the processor's time; steadier on a busy machine
};

struct StageFigure {
    std::string name;
    double ms_mean = 0, ms_p99 = 0;
};

/// One engine on one scene of one size.
struct Figure {
    std::string engine, setting, settings;
    int threads = 1, threads_met = 1, beside = 0;
    std::size_t steps = 0;
    Spread ms_mean;
    /// What its threads do together, of what as many worlds of one thread each do beside one
    /// another; all 0 where that was not asked for.
    Spread efficiency;
    double ms_median = 0, ms_p99 = 0, cpu_ms = 0, make_ms = 0;
    double ns_a_body = 0;     // over all steps
    double ns_a_contact = 0;  // over the last quarter of them; 0 where nothing touches
    double contacts = 0;      // in the last step
    double state_bytes = 0, heap_bytes = 0, resident_bytes = 0;  // a body
    std::vector<StageFigure> stages;
    std::vector<Comparison> against;  // peers; for more threads than one also throng on one
    Quality quality;
    double error = 0;  // see Run
    std::string state_hash;
};

/// In the order of the engines.
std::vector<Figure> figures_of(const Case& made);

/// Whether every run of throng that did as many steps came to the same state.
bool hashes_agree(const Case& made);

/// How the cost of a scene grows with its size, for one number of threads: of one by the
/// processor's time, of more by the clock.
struct Growth {
    std::string scene, setting;
    double dt = 0;  // s
    int threads = 1;
    std::size_t steps = 0;  // that all sizes have done
    std::vector<std::size_t> bodies;
    std::vector<double> ms;
    double exponent = 0;  // of the power law nearest to them; 0 for a single size

    /// Cost of a contact (of a body, where little touches) at one size and at the next, both while
    /// a body has as many contacts.
    struct EqualState {
        std::size_t small = 0, large = 0;  // bodies
        bool by_contact = true;
        double ns_small = 0, ns_large = 0;
        double contacts_small = 0, contacts_large = 0;  // a body
        double ratio() const { return ns_small > 0 ? ns_large / ns_small : 0; }
    };
    std::vector<EqualState> steps_up;
};
std::vector<Growth> growth_of(const std::vector<Case>& cases);

}  // namespace throng::bench
