#include "pipeline/solvers/borne_bodies.hpp"

#include "kernels/solver/contact_packing.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

// Of what acts on a body, the share that contacts may leave of it, or give too much.
constexpr double kLeft = 0.5;

constexpr std::size_t kNotForced = ~std::size_t{0};

template <class Real>
class BorneBodies {
public:
    BorneBodies(const ContactConstraints<Real>& constraints,
                const IslandCalls& calls,
                std::span<const ForcedBody> forced,
                double substep)
        : constraints_(constraints), forced_(forced), substep_(substep),
          at_points_(calls.effects.has(Effect::friction) && !constraints.point_frictions.empty()),
          given_(forced.size(), Vec3::Zero()), slips_(forced.size(), 0)
    { }

    // A contact of two bodies, by their places among the forced ones.
    void
    add(const ContactConstraintWide<Real>& block, std::size_t lane, std::size_t a, std::size_t b)
    {
        double pressed = 0, nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < static_cast<std::size_t>(block.points); ++k) {
            const ContactPointWide<Real>& point = constraints_.points[block.first_point + k];
            if (!(point.mass.at[lane] > 0)) continue;
            pressed += double{point.impulse.at[lane]};
            nearest = std::min(nearest, double{point.separation.at[lane]});
        }
        const Vec3 normal = in_double(block.normal, lane);
        if (pressed > 0) {
            const Vec3 impulse = normal * pressed + friction_of(block, lane, normal);
            const bool rubs = block.friction.at[lane] > 0;
            if (a != kNotForced) press(a, -impulse, rubs && !(block.round_a.at[lane] > 0));
            if (b != kNotForced) press(b, impulse, rubs && !(block.round_b.at[lane] > 0));
            return;
        }
        const double speed = std::abs(normal_speed(block, lane, normal));
        if (a != kNotForced) stand(a, b, -normal, speed, nearest);
        if (b != kNotForced) stand(b, a, normal, speed, nearest);
    }

    void judge(const Masses& masses, std::span<ForcedBody> forced) const
    {
        for (std::size_t i = 0; i < forced.size(); ++i) {
            const double inverse_mass = masses.inverse_mass[forced[i].body];
            forced[i].left = (forced[i].change + inverse_mass * given_[i]).norm();
            forced[i].grips = slips_[i] == 0;
            // A pivot bears whoever it holds, and what swings on it keeps its two halves.
            forced[i].borne = inverse_mass > 0 && !given_[i].isZero(0)
                && forced[i].left <= kLeft * forced[i].change.norm();
        }
        // Who stands on one that falls as he does is not borne: two that fly in touch.
        const auto rises = [&](const Standing& standing) {
            return !forced[standing.body].borne && given_[standing.body].isZero(0)
                && masses.inverse_mass[forced[standing.body].body] > 0
                && (standing.on == kNotForced || forced[standing.on].borne);
        };
        for (bool more = true; more;) {
            more = false;
            for (const Standing& standing : standing_)
                if (rises(standing)) more = forced[standing.body].borne = true;
        }
    }

private:
    struct Standing {
        std::size_t body, on;  // places among the forced ones
    };
    void press(std::size_t i, const Vec3& impulse, bool grips)
    {
        given_[i] += impulse;
        if (!grips) slips_[i] = 1;
    }

    // Friction at points is left out.
    Vec3 friction_of(const ContactConstraintWide<Real>& block,
                     std::size_t lane,
                     const Vec3& normal) const
    {
        if (at_points_) return Vec3::Zero();
        const Vec3 tangent = in_double(block.tangent, lane);
        return tangent * double{block.friction_impulse[0].at[lane]}
        + normal.cross(tangent) * double{block.friction_impulse[1].at[lane]};
    }

    double normal_speed(const ContactConstraintWide<Real>& block,
                        std::size_t lane,
                        const Vec3& normal) const
    {
        const auto at = [&](std::int32_t place, const Vec3& arm) -> Vec3 {
            const Real* const motion = constraints_.bodies[static_cast<std::size_t>(place)].motion;
            const Vec3 spin(double{motion[4]}, double{motion[5]}, double{motion[6]});
            return Vec3(double{motion[0]}, double{motion[1]}, double{motion[2]}) + spin.cross(arm);
        };
        return normal.dot(at(block.b[lane], in_double(block.center_b, lane))
                          - at(block.a[lane], in_double(block.center_a, lane)));
    }

    // In touch, no faster than what acts on it gives in a substep, with that against the contact.
    void stand(std::size_t i, std::size_t on, const Vec3& away, double speed, double separation)
    {
        const double gives = forced_[i].change.norm();
        if (speed <= gives && separation <= gives * substep_
            && forced_[i].change.dot(away) <= -kLeft * gives && gives > 0)
            standing_.push_back({i, on});
    }

    const ContactConstraints<Real>& constraints_;
    std::span<const ForcedBody> forced_;
    double substep_;
    bool at_points_;                   // friction
    std::vector<Vec3> given_;          // N s
    std::vector<Standing> standing_;   // on contacts that have no impulse yet
    std::vector<std::uint8_t> slips_;  // on one that gives way, or rolls
};

// Places among the forced bodies of a batch, by those that constraints have.
class ForcedPlaces {
public:
    ForcedPlaces(const Layout& layout, const Batch& batch, std::span<const ForcedBody> forced)
        : first_(layout.slices[batch.first_slice].first_body)
    {
        const Slice& last = layout.slices[batch.first_slice + batch.slices - 1];
        places_.assign(last.first_body + last.dynamic - first_, kNotForced);
        for (std::size_t i = 0; i < forced.size(); ++i)
            places_[layout.solver_index[forced[i].body] - first_] = i;
    }
    std::size_t of(std::int32_t body) const
    {
        const std::size_t at = static_cast<std::size_t>(body) - first_;
        return at < places_.size() ? places_[at] : kNotForced;
    }

private:
    std::size_t first_;
    std::vector<std::size_t> places_;
};

void visit_lanes(const Layout& layout, const Batch& batch, const auto& visit)
{
    for (std::uint32_t i = 0; i < batch.slices; ++i) {
        const auto [begin, end] = layout.blocks_of(layout.slices[batch.first_slice + i]);
        for (std::size_t at = begin; at < end; ++at)
            for (std::size_t lane = 0; lane < kBlock; ++lane)
                if (layout.lanes[at * kBlock + lane].entry != LaneSource{}.entry) visit(at, lane);
    }
}

}  // namespace

template <class Real>
void find_borne(const Layout& layout,
                const Batch& batch,
                const ContactConstraints<Real>& constraints,
                const Masses& masses,
                double substep,
                std::span<ForcedBody> forced)
{
    const ForcedPlaces places(layout, batch, forced);
    BorneBodies<Real> bodies(constraints, batch.calls, forced, substep);
    visit_lanes(layout, batch, [&](std::size_t at, std::size_t lane) {
        const ContactConstraintWide<Real>& block = constraints.blocks[at];
        bodies.add(block, lane, places.of(block.a[lane]), places.of(block.b[lane]));
    });
    bodies.judge(masses, forced);
}

template <class Real>
void find_least_speeds(const Layout& layout,
                       const Batch& batch,
                       std::span<const ForcedBody> forced,
                       std::span<const double> slow,
                       const Vec3& fall,
                       int substeps,
                       ContactConstraints<Real>& constraints)
{
    if (!batch.calls.effects.has(Effect::restitution)) return;
    const ForcedPlaces places(layout, batch, forced);
    const auto change_of = [&](std::int32_t body) -> Vec3 {
        const std::size_t at = places.of(body);
        if (at != kNotForced) return forced[at].pressing;
        return layout.movable(body) ? fall : Vec3(Vec3::Zero());
    };
    visit_lanes(layout, batch, [&](std::size_t at, std::size_t lane) {
        const ContactConstraintWide<Real>& block = constraints.blocks[at];
        const std::int32_t a = block.a[lane], b = block.b[lane];
        double least = slow[layout.island_of(batch, layout.movable(a) ? a : b)];
        if (places.of(a) != kNotForced || places.of(b) != kNotForced)
            least = std::max(least,
                             least_speed_of(in_double(block.normal, lane), change_of(a),
                                            change_of(b), substeps));
        constraints.restitutions[at].least_speed.at[lane] = static_cast<Real>(least);
    });
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void find_borne<Real>(const Layout&, const Batch&, const ContactConstraints<Real>&,   \
                                   const Masses&, double, std::span<ForcedBody>);                  \
    template void find_least_speeds<Real>(const Layout&, const Batch&,                             \
                                          std::span<const ForcedBody>, std::span<const double>,    \
                                          const Vec3&, int, ContactConstraints<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
