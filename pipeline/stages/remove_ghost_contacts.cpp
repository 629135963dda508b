// Remove ghost contacts: where colliders that do not move against one another lie flush, the edge
// or the side of the next one is no bump.
//
// A body that a face bears cannot come below that face's plane. So what another collider beside it
// shows no higher than that plane is out of its speculative margin as long as the face bears it;
// pairs are collided one by one, and cannot know. A contact is taken for such a ghost where
//
// - another of the same shape is along a face of its partner, pushes another way, and comes first,
// - all its points lie in the plane of that face, or below,
// - its own partner does not rise above that plane, neither there nor a little beyond.
//
// A face that leans towards the body bears it itself and is never dropped; so of two contacts one
// is left. What pushes almost as the face does is no bump but the body's own side, as it leans:
// where that would come down next, the face beside is needed, and its contact is made level.
#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/geometry/nearest_point.hpp"
#include "kernels/parallel/blocks.hpp"
#include "narrowphase/mesh/mesh_sides.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace throng {

namespace {

constexpr std::size_t kGrain = 2048;  // pairs a block
// Cosine beyond which two directions are one: a hundredth of a radian, over which a slide loses
// 1e-4 of its speed.
constexpr double kAlike = 0.99995;
// Cosine below which a face is the side of something and not a slope.
constexpr double kSide = 0.1;
// Cosine beyond which a ghost is the mover's own side that leans, if that is not round: a fifth of
// a radian.
constexpr double kLeans = 0.98;
// Shares of the shape's smallest half extent: what is level, and how far a rise is looked for. A
// slope of one by the other is still seen as a rise.
constexpr double kLevel = 2e-3, kBeyond = 0.1;

// A contact of a shape that can be pushed with what may have a flush neighbor, seen from the shape.
template <class Real>
struct Seen {
    std::uint32_t moving = 0, other = 0;  // colliders
    std::uint32_t part = 0;               // triangle of a mesh, kNoTriangle where none is told
    bool mover_first = false;
    Contact<Real>* contact = nullptr;

    bool face = false;                // the other pushes along one of its faces
    const Seen* hidden_by = nullptr;  // a face; then it is a ghost
    Vec3 normal = Vec3::Zero();       // from the other to the mover
    // world, on the other's surface
    std::array<Vec3, 4> at{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    double nearest = 0;  // m, separation of the nearest point
};

template <class Real>
class GhostSearch {
public:
    GhostSearch(const Pairs& pairs,
                const Shapes& shapes,
                const Colliders& colliders,
                const Bounds& bounds,
                const Poses& poses,
                const Velocities& velocities,
                const BodyStates& states,
                GhostMarks& marks)
        : pairs_(pairs), shapes_(shapes), colliders_(colliders), bounds_(bounds), poses_(poses),
          velocities_(velocities), states_(states), touches_(marks.touches)
    {
        touches_.resize(colliders.size(), 0);
    }
    // The marks are taken back.
    ~GhostSearch()
    {
        for (const std::uint32_t collider : marked_) touches_[collider] = 0;
    }
    GhostSearch(const GhostSearch&) = delete;
    GhostSearch& operator=(const GhostSearch&) = delete;

    // Most lie on one floor, and on nothing else that stands still: who meets no ghost is told by
    // marks, before anything is listed.
    void
    gather(ConvexContacts<Real>& convex, ManyContacts<Real>& meshes, ManyContacts<Real>& solids)
    {
        const std::size_t count = pairs_to_look_at();
        if (!mark_touches(count, convex, meshes, solids)) return;

        BlockLists<Seen<Real>> lists;
        lists.start(block_count(count, kGrain));
        for_each_block(count, kGrain, [&](auto begin, auto end, auto block) {
            for (std::size_t i = begin; i < end; ++i) {
                const PairKey key = pairs_.keys[i];
                if (!meets_ghosts(first_of(key)) && !meets_ghosts(second_of(key))) continue;
                if (const std::uint32_t place = convex.of_pair[i].contact;
                    place != PairState::kApart)
                    note(key, 0, convex.contacts[place], lists[block]);
            }
        });
        lists.append_to(seen_);
        // A solid's contacts are told of patches.
        for (auto* list : {&meshes, &solids})
            for (auto& entry : list->entries)
                if (entry.contact.count > 0)
                    note(pairs_.keys[entry.pair], list == &meshes ? entry.part : kNoTriangle,
                         entry.contact, seen_);
    }

    // Shape by shape: those of one come together. All are judged before any goes, as a contact of
    // two that can be pushed is seen from both.
    void remove()
    {
        const auto before = [](const Seen<Real>& a, const Seen<Real>& b) {
            return a.moving < b.moving;
        };
        std::stable_sort(seen_.begin(), seen_.end(), before);
        const std::span all(seen_);
        for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
            while (end < all.size() && all[end].moving == all[begin].moving) ++end;
            if (end - begin > 1) judge(all.subspan(begin, end - begin));
        }
        for (const Seen<Real>& ghost : all) {
            if (ghost.hidden_by == nullptr || ghost.contact->count == 0) continue;
            if (leans(ghost))
                level(ghost);
            else
                ghost.contact->count = 0;
        }
    }

private:
    // What touches one: something that may lie flush with another, more than one, one with a rim.
    static constexpr std::uint8_t kOne = 1, kMore = 4, kMoreAndRim = kMore | Bounds::kRimmed;

    // Whether anybody may meet a ghost.
    bool mark_touches(std::size_t count,
                      const ConvexContacts<Real>& convex,
                      const ManyContacts<Real>& meshes,
                      const ManyContacts<Real>& solids)
    {
        bool some = false;
        const auto mark = [&](PairKey key) {
            for_each_side(key, [&](std::uint32_t moving, std::uint32_t other, bool) {
                std::uint8_t& touches = touches_[moving];
                if (touches == 0) marked_.push_back(moving);
                const std::uint8_t number = (touches & kOne) != 0 ? kMore : kOne;
                const std::uint8_t rim = bounds_.flush[other] & Bounds::kRimmed;
                touches = static_cast<std::uint8_t>(touches | number | rim);
                some = some || meets_ghosts(moving);
            });
        };
        for (std::size_t i = 0; i < count; ++i)
            if (concerns(pairs_.keys[i]) && convex.of_pair[i].contact != PairState::kApart)
                mark(pairs_.keys[i]);
        for (const auto* list : {&meshes, &solids})
            for (const auto& entry : list->entries)
                if (entry.contact.count > 0) mark(pairs_.keys[entry.pair]);
        return some;
    }

    // They ascend by their first, and what stands still is mostly made before what moves: behind
    // the last that may have neighbors, no pair has one.
    std::size_t pairs_to_look_at() const
    {
        const auto& keys = pairs_.keys;
        return static_cast<std::size_t>(
            std::lower_bound(keys.begin(), keys.end(), bounds_.flush_end,
                             [](PairKey key, std::uint32_t end) { return first_of(key) < end; })
            - keys.begin());
    }

    bool may_have_neighbors(std::uint32_t collider) const { return bounds_.flush[collider] != 0; }
    bool is_pushed(std::uint32_t collider) const
    {
        return states_.movable(colliders_.body[collider]);
    }
    bool concerns(PairKey key) const
    {
        return may_have_neighbors(first_of(key)) || may_have_neighbors(second_of(key));
    }
    // Planes have no rims: what is borne by them alone meets none.
    bool meets_ghosts(std::uint32_t moving) const
    {
        return (touches_[moving] & kMoreAndRim) == kMoreAndRim;
    }

    // Calls action(mover, other, mover_first) for each of the two that can be pushed, where the
    // other may have a flush neighbor.
    void for_each_side(PairKey key, const auto& action) const
    {
        const std::uint32_t a = first_of(key), b = second_of(key);
        if (may_have_neighbors(b) && is_pushed(a)) action(a, b, true);
        if (may_have_neighbors(a) && is_pushed(b)) action(b, a, false);
    }

    void note(PairKey key, std::uint32_t part, Contact<Real>& contact, auto& list) const
    {
        for_each_side(key, [&](std::uint32_t moving, std::uint32_t other, bool mover_first) {
            if (meets_ghosts(moving)) list.push_back({moving, other, part, mover_first, &contact});
        });
    }

    // Whether two colliders go on as they are to one another.
    bool together(std::uint32_t a, std::uint32_t b) const
    {
        if (a == b) return true;
        const auto moves = [&](std::uint32_t body) {
            return states_.kind[body] != BodyKind::static_
                && !(velocities_.linear[body].isZero(0) && velocities_.angular[body].isZero(0));
        };
        if (states_.dynamic(a) || states_.dynamic(b)) return false;
        if (!moves(a) && !moves(b)) return true;
        return velocities_.linear[a] == velocities_.linear[b] && velocities_.angular[a].isZero(0)
            && velocities_.angular[b].isZero(0) && moves(a) == moves(b);
    }

    void process(Seen<Real>& seen) const
    {
        const Contact<Real>& contact = *seen.contact;
        const Vec3& center = poses_.position[colliders_.body[seen.moving]];
        const Vec3 normal = contact.normal.template cast<double>().normalized();
        seen.normal = seen.mover_first ? Vec3(-normal) : normal;
        seen.nearest = contact.points[0].separation;
        for (int k = 0; k < contact.count; ++k) {
            const double separation = contact.points[static_cast<std::size_t>(k)].separation;
            const Vec3 on_mover =
                (seen.mover_first ? contact.points[static_cast<std::size_t>(k)].anchor_a
                                  : contact.anchor_b(k))
                    .template cast<double>();
            seen.at[static_cast<std::size_t>(k)] = center + on_mover - seen.normal * separation;
            seen.nearest = std::min(seen.nearest, separation);
        }
        if (seen.part == kNoTriangle) seen.part = triangle_at(seen.other, seen.at[0]);
        seen.face = is_face(seen);
    }

    // Of a mesh that a solid touches there; of others any.
    std::uint32_t triangle_at(std::uint32_t collider, const Vec3& place) const
    {
        const ShapeRef shape = colliders_.shape[collider];
        if (shape.kind != ShapeKind::mesh) return 0;
        return nearest_on_mesh(shapes_.meshes[shape.index],
                               bounds_.placed[collider].to_local(place))
            .triangle;
    }

    bool is_face(const Seen<Real>& seen) const
    {
        const ShapeRef shape = colliders_.shape[seen.other];
        const Vec3 local = bounds_.placed[seen.other].orientation.conjugate() * seen.normal;
        switch (shape.kind) {
        case ShapeKind::plane:
            return true;
        case ShapeKind::box:
            return local.cwiseAbs().maxCoeff() > kAlike;
        case ShapeKind::cylinder:
            return std::abs(local.z()) > kAlike;
        case ShapeKind::hull: {
            const auto& normals = shapes_.hulls[shape.index].normals;
            return std::any_of(normals.begin(), normals.end(),
                               [&](const Vec3& normal) { return normal.dot(local) > kAlike; });
        }
        case ShapeKind::mesh:
            return std::abs(shapes_.meshes[shape.index].normals[seen.part & ~kBehind].dot(local))
                > kAlike;
        default:
            return false;
        }
    }

    // Triangles of one mesh know their neighbors; where one has none there may be a flush rim.
    bool may_be_flush(const Seen<Real>& ghost, const Seen<Real>& face) const
    {
        if (ghost.other != face.other) return true;
        const ShapeRef shape = colliders_.shape[ghost.other];
        if (shape.kind != ShapeKind::mesh || ghost.face) return false;
        const auto& beyond = shapes_.meshes[shape.index].adjacent[ghost.part & ~kBehind];
        return std::any_of(beyond.begin(), beyond.end(), [](std::int32_t t) { return t < 0; });
    }

    // Whether the ghost's partner comes above the face's plane at a point of that plane, or a
    // little further that way.
    bool rises(const Seen<Real>& ghost, const Seen<Real>& face, const Vec3& at, double size) const
    {
        const double beyond = kBeyond * size, least = beyond - kLevel * size;
        Vec3 away = face.normal * face.normal.dot(ghost.normal) - ghost.normal;
        away /= away.norm();
        const Pose& placed = bounds_.placed[ghost.other];
        const auto is_near = [&](const Vec3& point) {
            return nearest_point(shapes_, colliders_.shape[ghost.other], placed.to_local(point),
                                 least)
                       .distance
                < least;
        };
        const Vec3 above = at + beyond * face.normal;
        return is_near(above) || is_near(above + beyond * away);
    }

    // Of a point of the ghost's partner over the face's plane, m. Manifolds may tell of a point
    // that is further along the mover's side than the partner reaches.
    double
    height_over(const Seen<Real>& face, const Seen<Real>& ghost, const Vec3& at, double level) const
    {
        const double height = face.normal.dot(at - face.at[0]);
        if (height <= level) return height;
        const Pose& placed = bounds_.placed[ghost.other];
        const NearestPoint nearest =
            nearest_point(shapes_, colliders_.shape[ghost.other], placed.to_local(at), 2 * height);
        if (!(nearest.distance <= 2 * height)) return height;
        return face.normal.dot(placed * nearest.point - face.at[0]);
    }

    bool hides(const Seen<Real>& face, const Seen<Real>& ghost) const
    {
        const double size = colliders_.inner_extent[ghost.moving], level = kLevel * size;
        const double along = face.normal.dot(ghost.normal);
        if (!face.face || along > kAlike) return false;
        if (face.nearest > std::max(level, std::min(ghost.nearest, kBeyond * size))) return false;
        if ((ghost.face && along > kSide) || !may_be_flush(ghost, face)) return false;
        if (!together(colliders_.body[face.other], colliders_.body[ghost.other])) return false;
        const auto count = static_cast<std::size_t>(ghost.contact->count);
        for (std::size_t k = 0; k < count; ++k)
            if (height_over(face, ghost, ghost.at[k], level) > level) return false;
        for (std::size_t k = 0; k < count; ++k) {
            const double height = face.normal.dot(ghost.at[k] - face.at[0]);
            if (rises(ghost, face, ghost.at[k] - height * face.normal, size)) return false;
        }
        return true;
    }

    void judge(std::span<Seen<Real>> of_shape) const
    {
        for (Seen<Real>& seen : of_shape) process(seen);
        for (Seen<Real>& ghost : of_shape)
            for (const Seen<Real>& face : of_shape)
                if (ghost.hidden_by == nullptr && &face != &ghost && hides(face, ghost))
                    ghost.hidden_by = &face;
    }

    bool leans(const Seen<Real>& ghost) const
    {
        const Contact<Real>& contact = *ghost.contact;
        const bool round = (ghost.mover_first ? contact.round_a : contact.round_b) > 0;
        const bool stands = !is_pushed(ghost.other);
        return stands && !round && ghost.hidden_by->normal.dot(ghost.normal) > kLeans;
    }

    // As if the mover met the plane of the face there.
    void level(const Seen<Real>& ghost) const
    {
        const Vec3 &up = ghost.hidden_by->normal, &on_face = ghost.hidden_by->at[0];
        Contact<Real>& contact = *ghost.contact;
        contact.normal = (ghost.mover_first ? Vec3(-up) : up).template cast<Real>();
        for (int k = 0; k < contact.count; ++k) {
            auto& point = contact.points[static_cast<std::size_t>(k)];
            const Vec3& at = ghost.at[static_cast<std::size_t>(k)];
            const Vec3 on_mover = at + ghost.normal * double{point.separation};
            const double height = up.dot(on_mover - on_face);
            if (!ghost.mover_first)
                point.anchor_a += ((on_mover - up * height) - at).template cast<Real>();
            point.separation = static_cast<Real>(height);
        }
    }

    const Pairs& pairs_;
    const Shapes& shapes_;
    const Colliders& colliders_;
    const Bounds& bounds_;
    const Poses& poses_;
    const Velocities& velocities_;
    const BodyStates& states_;
    std::vector<std::uint8_t>& touches_;  // [colliders]
    std::vector<std::uint32_t> marked_;   // of those, that are not 0
    std::vector<Seen<Real>> seen_;
};

}  // namespace

template <class Real>
void remove_ghost_contacts(const Pairs& pairs,
                           const Shapes& shapes,
                           const Colliders& colliders,
                           const Bounds& bounds,
                           const Poses& poses,
                           const Velocities& velocities,
                           const BodyStates& states,
                           ConvexContacts<Real>& convex,
                           MeshContacts<Real>& meshes,
                           SolidContacts<Real>& solids,
                           GhostMarks& marks)
{
    GhostSearch<Real> search(pairs, shapes, colliders, bounds, poses, velocities, states, marks);
    search.gather(convex, meshes, solids);
    search.remove();
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void remove_ghost_contacts<Real>(                                                     \
        const Pairs&, const Shapes&, const Colliders&, const Bounds&, const Poses&,                \
        const Velocities&, const BodyStates&, ConvexContacts<Real>&, MeshContacts<Real>&,          \
        SolidContacts<Real>&, GhostMarks&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
