#include "pipeline/solvers/relax_iterations.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr int kInHeaps = 1;

// With finer substeps: contacts for each relaxing iteration, and iterations at most. With two
// iterations columns of 50 to 100 boxes or balls that are dropped, each a little above the last,
// won up to 0.9 of their energy of motion as they were escalated; with four, of 80 boxes still a
// tenth. They are strained by far more than what twice the substeps are for, which is heaps.
constexpr std::uint32_t kContactsPerRelaxIteration = 12, kMostRelaxIterations = 8;

// From where on a push is more than what a contact bears in a substep: friction that it made, left
// behind by a single iteration, slows what rubs on its way down.
constexpr int kManySubsteps = 16;

}  // namespace

bool lies_on_faces(const Batch& batch) { return 2 * batch.on_faces > batch.contacts; }

int relax_iterations(const SolverParameters& parameters, int substeps, const Batch& batch)
{
    if (parameters.relax_iterations > 0) return parameters.relax_iterations;
    return lies_on_faces(batch) || substeps > kManySubsteps ? kInStructures : kInHeaps;
}

int finer_relax_iterations(const SolverParameters& parameters, int substeps, const Batch& batch)
{
    const int usual = relax_iterations(parameters, substeps, batch);
    if (parameters.relax_iterations > 0) return usual;
    return std::max(usual,
                    static_cast<int>(std::min({kMostRelaxIterations, 2u * batch.times,
                                               batch.contacts / kContactsPerRelaxIteration})));
}

double mean_relax_iterations(const SolverParameters& parameters, int substeps, const Layout& layout)
{
    double iterations = 0, contacts = 0;
    for (const Batch& batch : layout.batches) {
        iterations += double(batch.contacts) * relax_iterations(parameters, substeps, batch);
        contacts += batch.contacts;
    }
    return contacts > 0 ? iterations / contacts : 0;
}

}  // namespace throng
