#include "narrowphase/mesh/near_triangles.hpp"

#include "kernels/geometry/k_dop.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "kernels/geometry/support.hpp"

#include <algorithm>

namespace throng {

void NearTriangles::add(const PairInput<double>& in)
{
    const auto& [shapes, mesh, b, pose, speculative_margin] = in;
    const std::size_t place = count_++;
    if (found_.size() < count_) found_.resize(count_);
    found_[place].clear();
    const Mesh& surface = *mesh_of(shapes, mesh);
    Box3 box = shape_bounds(shapes, b, pose);
    box.lower.array() -= speculative_margin;
    box.upper.array() += speculative_margin;
    if (!surface.k_dops.empty()) {
        const KDop k_dop =
            k_dop_of(convex_core_of<double>(shapes, b), pose.orientation.toRotationMatrix(),
                     pose.position, surface.sides);
        find_triangles(surface, box, k_dop, speculative_margin, found_[place]);
        return;
    }
    const std::size_t search = waiting_++;
    if (searches_.size() < waiting_) {
        searches_.resize(waiting_);
        searched_for_.resize(waiting_);
    }
    searches_[search].mesh = &surface;
    searches_[search].box = box;
    searched_for_[search] = place;
}

void NearTriangles::find()
{
    find_triangles({searches_.data(), waiting_});
    for (std::size_t k = 0; k < waiting_; ++k)
        std::swap(searches_[k].found, found_[searched_for_[k]]);
    waiting_ = 0;
}

}  // namespace throng
