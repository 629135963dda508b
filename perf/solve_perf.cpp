// Solve: what one visit to a contact takes, by width, kind of number and points a contact.
//
// As many contacts as a batch of small islands holds: in a step, too, they stay in one core's cache
// through all visits.
#include "kernels/solve/coloring.hpp"
#include "perf/support.hpp"
#include "tests/kernels/solve/random_contacts.hpp"

#include <algorithm>
#include <chrono>
#include <string>

namespace throng::perf {
namespace {

constexpr std::size_t kBlocks = kBatchContacts / kBlock;

// Four contacts a body, as in a pile: the blocks of two colors meet the same bodies soon enough
// that one waits for what the other stored.
constexpr std::size_t kBodies = kBatchContacts / 2;

// Those of a step of four substeps: each pushes once and relaxes twice.
constexpr int kVisits = 12;

template <class Real>
Rows<Real> random_rows(int points)
{
    std::mt19937 random(1);
    const testing::BlockWish wish{.points = points};
    Rows<Real> rows;
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < kBodies; ++i) {
        rows.bodies.push_back(testing::random_body<Real>(random));
        positions.push_back(testing::random_vector(random, 0.5));
    }
    ContactTerms<Real> terms;
    terms.friction = Real(0.5);
    terms.softness = softness<Real>(40, 10, 1.0 / 240);

    rows.blocks.resize(kBlocks);
    for (std::size_t k = 0; k < kBlocks; ++k) {
        ContactBlock<Real>& block = rows.blocks[k];
        block = {};
        block.points = points;
        block.writes_a = block.writes_b = 0xffff;
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            // 32 bodies a block, in pairs that change from color to color.
            const std::size_t first = k * 2 * kBlock % kBodies, color = k * 2 * kBlock / kBodies;
            const std::size_t a = first + lane, b = first + kBlock + (lane + color) % kBlock;
            block.a[lane] = static_cast<std::int32_t>(a);
            block.b[lane] = static_cast<std::int32_t>(b);
            Contact<Real> contact;
            do contact = testing::random_contact<Real>(random, positions[a], positions[b], wish);
            while (contact.count != points);
            fill_lane(block, static_cast<int>(lane), contact, rows.bodies[a], rows.bodies[b],
                      terms);
        }
    }
    return rows;
}

// Every iteration starts from the same rows: left to themselves they would come to rest, and work
// on numbers that no longer change.
template <class Real>
void time_sweep(benchmark::State& state, const SolveKernels<Real>& kernels, int points)
{
    const Rows<Real> start = random_rows<Real>(points);
    Rows<Real> rows = start;
    Visit<Real> visit;
    visit.inverse_substep = 240;
    visit.push_limit = 3;
    for ([[maybe_unused]] auto iteration : state) {
        std::copy(start.blocks.begin(), start.blocks.end(), rows.blocks.begin());
        std::copy(start.bodies.begin(), start.bodies.end(), rows.bodies.begin());
        const auto begin = std::chrono::steady_clock::now();
        for (int i = 0; i < kVisits; ++i) {
            visit.push = i % 3 == 0;
            kernels.sweep(rows.blocks.data(), kBlocks, rows.bodies.data(), visit);
        }
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        state.SetIterationTime(taken.count());
    }
    state.counters["a_contact"] = time_of_one(kBatchContacts * kVisits);
}

template <class Real>
void register_widths(const std::string& number)
{
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        const SolveKernels<Real>* const kernels = solve_kernels_of<Real>(width);
        if (kernels == nullptr) continue;
        for (const int points : {1, 4}) {
            const std::string name = "sweep/" + number + '/' + width + '/' + std::to_string(points)
                + (points == 1 ? "_point" : "_points");
            benchmark::RegisterBenchmark(name.c_str(), time_sweep<Real>, *kernels, points)
                ->UseManualTime()
                ->Unit(benchmark::kMicrosecond);
        }
    }
}

}  // namespace

void register_benchmarks()
{
    register_widths<float>("float");
    register_widths<double>("double");
}

}  // namespace throng::perf
