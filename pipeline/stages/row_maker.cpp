#include "pipeline/stages/row_maker.hpp"

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

template <class Real>
std::array<Softness<Real>, 4> softness_of(const Conditions& conditions)
{
    const Settings& settings = conditions.settings;
    const double h = conditions.substep();
    std::array<Softness<Real>, 4> terms;
    for (std::size_t points = 0; points < terms.size(); ++points) {
        const double rate = contact_rate(conditions, static_cast<int>(points) + 1);
        terms[points] = settings.solver == Solver::pgs
            ? Softness<Real>{static_cast<Real>(kBaumgarte / h), Real(0)}
            : softness<Real>(rate, kDampingRatio, h);
    }
    return terms;
}

}  // namespace

double contact_rate(const Conditions& conditions, int points)
{
    const Settings& settings = conditions.settings;
    if (settings.contact_hertz > 0) return settings.contact_hertz;
    const double share =
        settings.contact_rate > 0 ? settings.contact_rate : kRate[std::size_t(points) - 1];
    return share / conditions.substep();
}

double push_rate(const Conditions& conditions, int points)
{
    const double h = conditions.substep();
    return softness<double>(contact_rate(conditions, points), kDampingRatio, h).bias_rate;
}

double rigid_overlap(double extent, int points)
{
    return kDeep * extent * (points > 2 ? kSharedDeep : 1);
}

template <class Real>
RowMaker<Real>::RowMaker(const Conditions& conditions,
                         const Layout& layout,
                         const ActiveContacts& active,
                         ConvexContacts<Real>& convex,
                         MeshContacts<Real>& meshes,
                         SolidContacts<Real>& solids,
                         Rows<Real>& rows)
    : layout_(layout), active_(active), convex_(convex), meshes_(meshes), solids_(solids),
      rows_(rows), view_(RowsView<Real>::of(rows)), kernels_(solve_kernels<Real>()),
      turns_(conditions.has(Effect::rotation) || conditions.grips_apart()),
      uncut_(conditions.grips_apart()
             && conditions.settings.friction_cone == FrictionCone::pyramid),
      softness_(softness_of<Real>(conditions))
{ }

template <class Real>
Contact<Real>& RowMaker<Real>::contact_of(const ActiveContacts::Entry& source) const
{
    switch (source.list) {
    case ContactList::mesh:
        return meshes_.entries[source.slot].contact;
    case ContactList::solid:
        return solids_.entries[source.slot].contact;
    case ContactList::convex:
        break;
    }
    return convex_.contacts[source.slot];
}

template <class Real>
void RowMaker<Real>::fill(std::size_t at, LooseBlock<Real>& loose) const
{
    ContactBlock<Real>& block = rows_.blocks[at];
    block.points = layout_.points[at];
    block.first_point = rows_.first_point[at];
    block.writes_a = block.writes_b = 0;
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
        const std::size_t place = at * kBlock + lane;
        const int lane_at = static_cast<int>(lane);
        block.a[lane] = layout_.slot_a[place];
        block.b[lane] = layout_.slot_b[place];
        const std::uint32_t entry = layout_.lanes[place].entry;
        if (entry == LaneSource{}.entry) {
            loosen_nothing(lane_at, loose);
            continue;
        }
        const auto& source = active_.entries[entry];
        const auto writes = [&](std::int32_t slot) {
            return layout_.movable(slot) ? 1u << lane : 0u;
        };
        block.writes_a = static_cast<std::uint16_t>(block.writes_a | writes(block.a[lane]));
        block.writes_b = static_cast<std::uint16_t>(block.writes_b | writes(block.b[lane]));
        loosen(contact_of(source),
               {Real(source.friction), Real(source.restitution), Real(source.rolling_friction),
                softness_[source.points - 1u], static_cast<Real>(kDeep * double{source.extent})},
               lane_at, loose);
    }
    kernels_.prepare(loose, at, view_, turns_);
    if (!uncut_) return;
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
        const std::uint32_t entry = layout_.lanes[at * kBlock + lane].entry;
        if (entry == LaneSource{}.entry) continue;
        hold_uncut(contact_of(active_.entries[entry]), static_cast<int>(lane), block);
    }
}

template <class Real>
void RowMaker<Real>::make(std::size_t begin, std::size_t end) const
{
    LooseBlock<Real> loose;
    for (std::size_t block = begin; block < end; ++block) fill(block, loose);
}

template <class Real>
void RowMaker<Real>::store(std::size_t begin, std::size_t end) const
{
    for (std::size_t i = begin; i < end; ++i) {
        const std::size_t lane = layout_.lane[i];
        store_impulses(view_, lane / kBlock, static_cast<int>(lane % kBlock),
                       contact_of(active_.entries[layout_.contacts[i]]));
    }
}

template <class Real>
void RowMaker<Real>::scale_impulses(const Slice& slice, Real scale) const
{
    for (std::size_t i = slice.first_contact; i < slice.first_contact + slice.contacts; ++i)
        throng::scale_impulses(scale, contact_of(active_.entries[layout_.contacts[i]]));
}

template class RowMaker<float>;
template class RowMaker<double>;

}  // namespace throng
