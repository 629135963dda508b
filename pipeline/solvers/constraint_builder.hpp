// Constraint builder: contacts into the constraints of the solver, and impulses back into contacts.
//
// The solver does both itself, slice by slice, so that constraints are in cache when they are first
// and last needed.
#pragma once

#include "kernels/solver/contact_packing.hpp"
#include "kernels/solver/turning_arms.hpp"
#include "pipeline/contacts/contact_lists.hpp"
#include "pipeline/step/step_data.hpp"

#include <span>

namespace throng {

/// Hz, of the spring that a contact of so many points is.
double contact_rate(const StepContext& context, const SolverParameters& parameters, int points);
/// The same as an angular frequency, rad/s.
double
contact_frequency(const StepContext& context, const SolverParameters& parameters, int points);
/// 1/s, the share of its overlap that it pushes apart.
double push_rate(const StepContext& context, const SolverParameters& parameters, int points);
/// m, overlap under a load that so many points share, from which they begin to turn rigid.
///
///   extent  m, the lesser of the smallest half extents of the two shapes
double rigid_overlap(double extent, int points);

template <class Real>
class ConstraintBuilder {
public:
    /// Of constraints that have their places (see prepare_constraints), of batches whose islands
    /// call for that.
    ConstraintBuilder(const StepContext& context,
                      const SolverParameters& parameters,
                      const Layout& layout,
                      const ActiveContacts& active,
                      ConvexContacts<Real>& convex,
                      MeshContacts<Real>& meshes,
                      SolidContacts<Real>& solids,
                      JoinedContacts<Real>& joined,
                      const IslandCalls& calls,
                      ContactConstraints<Real>& constraints);

    /// Makes the constraints of blocks from `begin` to before `end`. Bodies have not moved yet.
    void make(std::size_t begin, std::size_t end) const;
    /// Gives their impulses back to the contacts of these places in Layout::contacts: in the order
    /// in which they lie in memory, as there are more of them than of the constraints that they lie
    /// in.
    void store(std::size_t begin, std::size_t end) const;

    /// Makes what the contact of a place in Layout::contacts holds this times as much.
    void scale_impulses(std::size_t place, Real scale) const;
    /// The same of all contacts of a slice, for substeps of another length.
    void scale_impulses(const Slice& slice, Real scale) const;
    /// 1 for each body of a slice that can be moved, by place, at whose contacts there is an
    /// impulse.
    std::vector<std::uint8_t> pressed(const Slice& slice) const;

    /// The flat side on which the contact of a lane, by its place in the layout, rolls on a rim.
    RollsFlat rolls_on_rim(std::size_t place, const Contact<Real>& contact) const;
    /// The rims of a body by its solver index.
    RoundRim rim_of(std::int32_t solver_index) const
    {
        return constraints_.rims[static_cast<std::size_t>(solver_index)];
    }

    Contact<Real>& contact_of(const ActiveContacts::Entry& entry) const
    {
        return throng::contact_of(convex_, meshes_, solids_, joined_, entry);
    }
    /// That of a place in Layout::contacts.
    const Contact<Real>& contact_at(std::size_t place) const
    {
        return contact_of(active_.entries[layout_.contacts[place]]);
    }
    /// Gives what a joined contact holds back to those that it is made of.
    void give_back(const ActiveContacts::Entry& entry) const;

private:
    void fill(std::size_t at, PackedContacts<Real>& packed) const;
    // Of a block that is filled what its contacts are asked about one by one.
    void finish(std::size_t at, std::span<const RollsFlat> on_rim) const;
    Surfaces::MaterialPair materials_of(std::uint32_t entry) const;
    void settle_separation(const Contact<Real>& contact,
                           std::size_t lane,
                           ContactConstraintWide<Real>& block) const;
    void find_carried(std::size_t at) const;
    void find_turning_axes(std::size_t at) const;

    const Layout& layout_;
    const ActiveContacts& active_;
    ConvexContacts<Real>& convex_;
    MeshContacts<Real>& meshes_;
    SolidContacts<Real>& solids_;
    JoinedContacts<Real>& joined_;
    ContactConstraints<Real>& constraints_;
    const IslandCalls& calls_;
    ContactConstraintsView<Real> view_;
    const SolveKernels<Real>& kernels_;
    bool turns_;
    bool uncut_;                              // friction is not cut to a round cone
    double dt_;                               // s, of a step
    Real up_[3];                              // see driven_contacts.hpp
    std::array<Softness<Real>, 4> softness_;  // by the number of points, less one
    // m, the overlap that weight makes; by the number of points, less one.
    std::array<double, 4> pressed_;
    bool settles_;  // that is so little that the digits of separations are next to it
};

}  // namespace throng
