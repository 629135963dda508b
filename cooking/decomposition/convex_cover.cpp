#include "cooking/decomposition/convex_cover.hpp"

#include "cooking/decomposition/bare_surface.hpp"
#include "cooking/decomposition/convex_parts.hpp"
#include "cooking/decomposition/hull_cell.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Of the error: how near to a hull a place is covered, and how far thinned hulls fall short.
constexpr double kNear = 0.5, kThin = 0.25;
// Places within the mesh are as many along its longest side.
constexpr int kPlacesAcross = 24;
// How often bare surface is looked for, to be covered by one hull more.
constexpr int kMends = 12;

class Cover {
public:
    Cover(const PartSearch& search, std::size_t most) : search_(search), most_(most)
    {
        for (const SurfaceSample& sample : sample_surface(search.mesh))
            add(sample.point, sample.normal);
        add_places_within();
    }

    std::vector<HullMesh> make()
    {
        if (!cover_places()) return {};
        drop_needless();
        for (int i = 0; i < kMends && hulls_.size() < most_; ++i) {
            const BareSurface bare = find_bare_surface(search_.mesh, hulls_, search_.error);
            if (bare.bound <= search_.error) break;
            add(bare.where, bare.normal);
            // A place that cannot be covered is left: the answer tells how far it is outside.
            grow(places_.back());
        }
        return std::move(hulls_);
    }

private:
    // Balls that touch a surface at one point lie in one another: the largest is found by halving.
    void add(const Vec3& point, const Vec3& normal)
    {
        double fits = 0, wide = search_.extent;
        for (int i = 0; i < 12; ++i) {
            const double radius = (fits + wide) / 2;
            const double depth = -signed_distance(search_.mesh, point - radius * normal);
            (depth > 0.999 * radius ? fits : wide) = radius;
        }
        places_.push_back({point, point - fits * normal, fits, false});
    }

    void add_places_within()
    {
        const Box3 box = box_of(search_.mesh);
        const double step = search_.extent / kPlacesAcross;
        for (double x = box.lower.x() + step / 2; x < box.upper.x(); x += step)
            for (double y = box.lower.y() + step / 2; y < box.upper.y(); y += step)
                for (double z = box.lower.z() + step / 2; z < box.upper.z(); z += step) {
                    const Vec3 at(x, y, z);
                    const double depth = -signed_distance(search_.mesh, at);
                    if (depth > search_.error) places_.push_back({at, at, depth, false});
                }
    }

    // False where it takes too many hulls.
    bool cover_places()
    {
        // The thickest first: what they need is covered by fewer.
        std::vector<std::size_t> order(places_.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return places_[a].radius > places_[b].radius;
        });
        std::size_t missed = 0;
        for (const std::size_t i : order) {
            // In a sharp corner there is no room to grow from; what is near is.
            if (places_[i].covered || places_[i].radius < search_.error / 4) continue;
            if (hulls_.size() == most_) return false;
            if (!grow(places_[i]) && ++missed > most_) return false;
        }
        return true;
    }

    // False where the hull is of no use.
    bool grow(const HullPlace& place)
    {
        HullCell cell(search_, places_);
        if (!cell.close(place)) return false;
        HullMesh hull =
            thinned(hull_mesh(cell.corners(place)), kMostPartVertices, kThin * search_.error);
        if (hull.empty() || search_.overhang(hull).least > search_.error) return false;
        bool of_use = false;
        for (HullPlace& other : places_) {
            if (other.covered || !covers(hull, other)) continue;
            other.covered = true;
            of_use = true;
        }
        if (of_use) hulls_.push_back(std::move(hull));
        return of_use;
    }

    bool covers(const HullMesh& hull, const HullPlace& place) const
    {
        return height_above(hull, place.point) <= kNear * search_.error;
    }

    // Hulls whose places all are in others too. Later ones cover less, so that they go first.
    void drop_needless()
    {
        std::vector<std::vector<std::size_t>> within(hulls_.size());
        std::vector<int> hulls_at(places_.size(), 0);
        for (std::size_t h = 0; h < hulls_.size(); ++h)
            for (std::size_t i = 0; i < places_.size(); ++i)
                if (covers(hulls_[h], places_[i])) {
                    within[h].push_back(i);
                    ++hulls_at[i];
                }
        for (std::size_t h = hulls_.size(); h-- > 0;) {
            const bool needed = std::any_of(within[h].begin(), within[h].end(),
                                            [&](std::size_t i) { return hulls_at[i] == 1; });
            if (needed) continue;
            for (const std::size_t i : within[h]) --hulls_at[i];
            hulls_.erase(hulls_.begin() + static_cast<std::ptrdiff_t>(h));
        }
    }

    const PartSearch& search_;
    std::size_t most_;
    std::vector<HullPlace> places_;
    std::vector<HullMesh> hulls_;
};

}  // namespace

std::vector<HullMesh> cover_by_hulls(const PartSearch& search, std::size_t most)
{
    return Cover(search, most).make();
}

}  // namespace throng
