#include "pipeline/solvers/constraint_builder.hpp"

#include "kernels/solver/carried_points.hpp"
#include "kernels/solver/driven_contacts.hpp"
#include "kernels/solver/solver_bodies.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

// Contacts are damped far beyond critical: they give way slowly and do not ring.
constexpr double kDampingRatio = 20;
// Stiffness as a share of the substep's rate, by the number of points: the most that comes to rest.
// Points share a body's mass among them, so the more there are the less each bears.
constexpr double kRate[4] = {0.5, 0.3, 0.25, 0.25};
// Overlap from which a contact stops giving way, as a share of the smaller body's half extent.
constexpr double kDeep = 0.005;
// Plain Gauss-Seidel: the share of the overlap taken away each substep.
constexpr double kBaumgarte = 0.2;

// Gaps are told to so many times the last digit of what they are the difference of.
constexpr double kDigits = 4;
// m: what this is the last digit of is smaller than scenes are.
constexpr double kLeastPress = 1e-5;

template <class Real>
std::array<Softness<Real>, 4> softness_of(const StepContext& context,
                                          const SolverParameters& parameters)
{
    const double h = context.substep();
    std::array<Softness<Real>, 4> terms;
    for (std::size_t points = 0; points < terms.size(); ++points) {
        const double rate = contact_rate(context, parameters, static_cast<int>(points) + 1);
        terms[points] = parameters.solver == Solver::pgs
            ? Softness<Real>{static_cast<Real>(kBaumgarte / h), Real(0)}
            : softness<Real>(rate, kDampingRatio, h);
    }
    return terms;
}

}  // namespace

double contact_rate(const StepContext& context, const SolverParameters& parameters, int points)
{
    if (parameters.contact_hertz > 0) return parameters.contact_hertz;
    const double share =
        parameters.contact_rate > 0 ? parameters.contact_rate : kRate[std::size_t(points) - 1];
    return share / context.substep();
}

double contact_frequency(const StepContext& context, const SolverParameters& parameters, int points)
{
    constexpr double kTurn = 2 * 3.14159265358979323846;
    return kTurn * contact_rate(context, parameters, points);
}

double push_rate(const StepContext& context, const SolverParameters& parameters, int points)
{
    const double h = context.substep();
    return softness<double>(contact_rate(context, parameters, points), kDampingRatio, h).bias_rate;
}

double rigid_overlap(double extent, int points)
{
    return kDeep * extent * (points > 2 ? kSharedDeep : 1);
}

template <class Real>
ConstraintBuilder<Real>::ConstraintBuilder(const StepContext& context,
                                           const SolverParameters& parameters,
                                           const Layout& layout,
                                           const ActiveContacts& active,
                                           ConvexContacts<Real>& convex,
                                           MeshContacts<Real>& meshes,
                                           SolidContacts<Real>& solids,
                                           JoinedContacts<Real>& joined,
                                           const IslandCalls& calls,
                                           ContactConstraints<Real>& constraints)
    : layout_(layout), active_(active), convex_(convex), meshes_(meshes), solids_(solids),
      joined_(joined), constraints_(constraints), calls_(calls),
      view_(ContactConstraintsView<Real>::of(constraints, calls)), kernels_(solve_kernels<Real>()),
      turns_(context.has(Effect::rotation)
             || parameters.friction_at_points_or_pyramid(context.effects)),
      uncut_(parameters.friction_at_points_or_pyramid(context.effects)
             && parameters.friction_cone == FrictionCone::pyramid),
      dt_(context.dt), softness_(softness_of<Real>(context, parameters))
{
    for (std::size_t points = 0; points < pressed_.size(); ++points) {
        const double omega = contact_frequency(context, parameters, static_cast<int>(points) + 1);
        pressed_[points] = context.gravity.norm() / (omega * omega);
    }
    settles_ = pressed_[0] < kLeastPress;
    const Vec3 up = up_of(context.gravity);
    for (int k = 0; k < 3; ++k) up_[k] = static_cast<Real>(up[k]);
}

template <class Real>
void ConstraintBuilder<Real>::fill(std::size_t at, PackedContacts<Real>& packed) const
{
    ContactConstraintWide<Real>& block = constraints_.blocks[at];
    block.points = layout_.points[at];
    block.first_point = constraints_.first_point[at];
    block.writes_a = block.writes_b = block.axis_turns_a = block.axis_turns_b = 0;
    RollsFlat on_rim[kBlock] = {};
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
        const std::size_t place = at * kBlock + lane;
        const int lane_at = static_cast<int>(lane);
        block.a[lane] = layout_.solver_index_a[place];
        block.b[lane] = layout_.solver_index_b[place];
        const std::uint32_t entry = layout_.lanes[place].entry;
        if (entry == LaneSource{}.entry) {
            pack_empty_lane(lane_at, packed);
            continue;
        }
        const auto& source = active_.entries[entry];
        const Surfaces::MaterialPair materials = materials_of(entry);
        const auto writes = [&](std::int32_t solver_index) {
            return layout_.movable(solver_index) ? 1u << lane : 0u;
        };
        block.writes_a = static_cast<std::uint16_t>(block.writes_a | writes(block.a[lane]));
        block.writes_b = static_cast<std::uint16_t>(block.writes_b | writes(block.b[lane]));
        const Contact<Real>& contact = contact_of(source);
        if (calls_.rolls) on_rim[lane] = rolls_on_rim(place, contact);
        pack_contact(contact,
                     {Real(materials.friction), Real(materials.restitution),
                      Real(materials.rolling_friction), softness_[source.points - 1u],
                      static_cast<Real>(kDeep * double{source.extent}),
                      on_rim[lane] != RollsFlat::no},
                     lane_at, packed);
    }
    kernels_.prepare(packed, at, view_, turns_);
    if (view_.surface_velocities != nullptr) {
        constraints_.surface_velocities[at] = {};
        if (calls_.carries) find_carried(at);
        if (view_.prescribed != nullptr) kernels_.walk_surface_velocity(view_, at, up_);
        if (calls_.axes_turn) find_turning_axes(at);
    }
    finish(at, on_rim);
}

template <class Real>
void ConstraintBuilder<Real>::finish(std::size_t at, std::span<const RollsFlat> on_rim) const
{
    ContactConstraintWide<Real>& block = constraints_.blocks[at];
    const bool turn = view_.turning_arms != nullptr;
    if (turn) view_.turning_arms[at].lanes = 0;
    if (!uncut_ && !settles_ && !turn) return;
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
        const std::uint32_t entry = layout_.lanes[at * kBlock + lane].entry;
        if (entry == LaneSource{}.entry) continue;
        const Contact<Real>& contact = contact_of(active_.entries[entry]);
        if (uncut_) pack_unclamped_friction(contact, static_cast<int>(lane), block);
        if (settles_) settle_separation(contact, lane, block);
        if (turn)
            note_turning_arms(view_, at, lane, contact, double{active_.entries[entry].extent},
                              on_rim[lane]);
    }
}

template <class Real>
Surfaces::MaterialPair ConstraintBuilder<Real>::materials_of(std::uint32_t entry) const
{
    if (!active_.materials.empty()) return active_.materials[entry];
    const ActiveContacts::Entry& source = active_.entries[entry];
    return {source.friction, source.restitution, source.rolling_friction};
}

// Where substeps are short, a separation that is rounding alone would ask for more speed than
// weight gives in a substep: the contact would be thrown open and pressed shut by turns, and
// friction, which takes from what presses, would act several times too much. Such a separation is
// none.
template <class Real>
void ConstraintBuilder<Real>::settle_separation(const Contact<Real>& contact,
                                                std::size_t lane,
                                                ContactConstraintWide<Real>& block) const
{
    constexpr double kLastDigit = kDigits * double{std::numeric_limits<Real>::epsilon()} / 2;
    const double pressed = pressed_[static_cast<std::size_t>(contact.count) - 1];
    const auto apart = double{contact.center_offset.norm()};
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
        const auto& point = contact.points[k];
        const double told = kLastDigit * (double{point.anchor_a.norm()} + apart);
        const double most = std::max(0.0, told - pressed);
        Real& separation = constraints_.points[block.first_point + k].separation.at[lane];
        // One that is open stays so, by a hair: it stops what comes, and does not give way.
        const Real hair = separation > 0 ? std::numeric_limits<Real>::min() : Real(0);
        separation -= std::clamp(separation, static_cast<Real>(-most), static_cast<Real>(most));
        if (separation == 0) separation = hair;
    }
}

template <class Real>
void ConstraintBuilder<Real>::find_carried(std::size_t at) const
{
    const ContactConstraintWide<Real>& block = constraints_.blocks[at];
    SurfaceVelocityWide<Real>& carried = constraints_.surface_velocities[at];
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
        const auto& a = constraints_.bodies[static_cast<std::size_t>(block.a[lane])];
        const auto& b = constraints_.bodies[static_cast<std::size_t>(block.b[lane])];
        const InverseMass of_a = inverse_mass_of(a), of_b = inverse_mass_of(b);
        const bool by_a = carries(a, of_b, dt_);
        if (!by_a && !carries(b, of_a, dt_)) continue;
        const Real round_a = block.round_a.at[lane], round_b = block.round_b.at[lane];
        const double share = goes_with_b(double{round_a}, double{round_b}, by_a);
        carried.by_a.at[lane] = static_cast<Real>(1 - share);
        carried.by_b.at[lane] = static_cast<Real>(share);
        const Real arm_a = vector_at(block.center_a, lane).squaredNorm();
        const Real arm_b = vector_at(block.center_b, lane).squaredNorm();
        carried.range_a.at[lane] = range_of(arm_a, of_a.angular > 0);
        carried.range_b.at[lane] = range_of(arm_b, of_b.angular > 0);
        carried.carries = true;
    }
}

template <class Real>
void ConstraintBuilder<Real>::find_turning_axes(std::size_t at) const
{
    ContactConstraintWide<Real>& block = constraints_.blocks[at];
    const SurfaceVelocityWide<Real>& surface = constraints_.surface_velocities[at];
    const auto walks = [&](std::size_t lane) {
        return surface.speed[0].at[lane] != 0 || surface.speed[1].at[lane] != 0;
    };
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
        const Real round_a = block.round_a.at[lane], round_b = block.round_b.at[lane];
        if (!(round_a > 0) && !(round_b > 0)) continue;
        if (surface.by_a.at[lane] + surface.by_b.at[lane] > 0 || walks(lane)) continue;
        const Vec3 normal = in_double(block.normal, lane);
        const auto bit = [&](std::int32_t solver_index, Real round, const auto& center) {
            const auto place = static_cast<std::size_t>(solver_index);
            const GyroscopicInertia<Real>& inertia = constraints_.inertias[place];
            return round > 0 && axis_turns(constraints_.bodies[place], inertia, dt_)
                    && rolls_on_axis(inertia, normal, in_double(center, lane))
                ? 1u << lane
                : 0u;
        };
        block.axis_turns_a = static_cast<std::uint16_t>(
            block.axis_turns_a | bit(block.a[lane], round_a, block.center_a));
        block.axis_turns_b = static_cast<std::uint16_t>(
            block.axis_turns_b | bit(block.b[lane], round_b, block.center_b));
    }
}

template <class Real>
void ConstraintBuilder<Real>::make(std::size_t begin, std::size_t end) const
{
    PackedContacts<Real> packed;
    for (std::size_t block = begin; block < end; ++block) fill(block, packed);
}

template <class Real>
void ConstraintBuilder<Real>::store(std::size_t begin, std::size_t end) const
{
    for (std::size_t i = begin; i < end; ++i) {
        const std::size_t lane = layout_.lane[i];
        const ActiveContacts::Entry& entry = active_.entries[layout_.contacts[i]];
        store_impulses(view_, lane / kBlock, static_cast<int>(lane % kBlock), contact_of(entry));
        give_back(entry);
    }
}

template <class Real>
void ConstraintBuilder<Real>::scale_impulses(std::size_t place, Real scale) const
{
    const ActiveContacts::Entry& entry = active_.entries[layout_.contacts[place]];
    throng::scale_impulses(scale, contact_of(entry));
    give_back(entry);
}

template <class Real>
void ConstraintBuilder<Real>::scale_impulses(const Slice& slice, Real scale) const
{
    for (std::size_t i = slice.first_contact; i < slice.first_contact + slice.contacts; ++i)
        scale_impulses(i, scale);
}

template <class Real>
std::vector<std::uint8_t> ConstraintBuilder<Real>::pressed(const Slice& slice) const
{
    std::vector<std::uint8_t> of_place(slice.dynamic, 0);
    for (std::size_t i = slice.first_contact; i < slice.first_contact + slice.contacts; ++i) {
        const ActiveContacts::Entry& entry = active_.entries[layout_.contacts[i]];
        const Contact<Real>& contact = contact_of(entry);
        const bool presses =
            std::any_of(contact.points.begin(), contact.points.begin() + contact.count,
                        [](const auto& point) { return point.impulse > 0; });
        if (!presses) continue;
        for (const std::uint32_t body : {entry.body_a, entry.body_b}) {
            const std::uint32_t place = layout_.solver_index[body] - slice.first_body;
            if (place < of_place.size()) of_place[place] = 1;
        }
    }
    return of_place;
}

template <class Real>
RollsFlat ConstraintBuilder<Real>::rolls_on_rim(std::size_t place,
                                                const Contact<Real>& contact) const
{
    if (!calls_.rolls) return RollsFlat::no;
    const std::int32_t a = layout_.solver_index_a[place], b = layout_.solver_index_b[place];
    return throng::rolls_on_rim(contact, rim_of(a), rim_of(b), layout_.movable(a),
                                layout_.movable(b));
}

template <class Real>
void ConstraintBuilder<Real>::give_back(const ActiveContacts::Entry& entry) const
{
    if (entry.list != ContactList::joined) return;
    const auto& joined = joined_.contacts[entry.list_index];
    const auto source = [&](std::uint32_t i) -> Contact<Real>& {
        return contact_of(joined_.sources[joined.first + i]);
    };
    for (std::uint32_t i = 0; i < joined.count; ++i) throng::scale_impulses(Real(0), source(i));
    for (std::size_t k = 0; k < static_cast<std::size_t>(joined.contact.count); ++k) {
        const auto& from = joined.points[k];
        source(from.source).points[from.point].impulse = joined.contact.points[k].impulse;
    }
    // Friction of one plane adds up, wherever it is kept.
    source(0).friction = joined.contact.friction;
    source(0).rolling = joined.contact.rolling;
    source(0).torsional_impulse = joined.contact.torsional_impulse;
}

template class ConstraintBuilder<float>;
template class ConstraintBuilder<double>;

}  // namespace throng
