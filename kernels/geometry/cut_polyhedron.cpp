#include "kernels/geometry/cut_polyhedron.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace { }  // namespace

void CutPolyhedron::start(const PolytopeView& shape, double slack, std::size_t planes)
{
    slack_ = slack;
    cut_short_ = false;
    x_.clear();
    y_.clear();
    z_.clear();
    free_vertices_.clear();
    free_edges_.clear();
    for (const Vec3& vertex : shape.vertices) {
        x_.push_back(vertex.x() - shape.center.x());
        y_.push_back(vertex.y() - shape.center.y());
        z_.push_back(vertex.z() - shape.center.z());
    }
    half_edges_.clear();
    leaving_.resize(x_.size());
    for (const Hull::Edge& edge : shape.edges) {
        const auto half = static_cast<std::uint32_t>(half_edges_.size());
        half_edges_.push_back({edge.from, kNone, Surface::own});
        half_edges_.push_back({edge.to, kNone, Surface::own});
        leaving_[edge.from] = half;
        leaving_[edge.to] = half + 1;
    }
    link_faces(shape);
    for (std::size_t face = 0; face < shape.normals.size(); ++face)
        if (!is_flat(shape, face, slack)) split_face(shape, face);
    // Three edges or more meet in every vertex, so Euler's formula allows three a face at most.
    most_edges_ = 4 * (edge_count() + planes);
    find_bounds();
}

// Follows the loop of each face with the halves that its corners begin.
void CutPolyhedron::link_faces(const PolytopeView& shape)
{
    // Halves by face in any order, then each to the place of the corner that it leaves.
    halves_.resize(shape.face_vertices.size());
    place_.assign(shape.face_begin.begin(), shape.face_begin.end());
    for (std::uint32_t i = 0; i < shape.edges.size(); ++i) {
        halves_[place_[shape.edges[i].left]++] = 2 * i;
        halves_[place_[shape.edges[i].right]++] = 2 * i + 1;
    }
    place_.resize(shape.vertices.size());
    std::vector<std::uint32_t>& sorted = led_to_by_;
    for (std::size_t face = 0; face < shape.normals.size(); ++face) {
        const auto corners = shape.face(face);
        const std::uint32_t begin = shape.face_begin[face];
        for (std::uint32_t i = 0; i < corners.size(); ++i) place_[corners[i]] = i;
        sorted.assign(corners.size(), kNone);
        for (std::uint32_t i = 0; i < corners.size(); ++i)
            sorted[place_[origin(halves_[begin + i])]] = halves_[begin + i];
        for (std::uint32_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t next = sorted[i + 1 < corners.size() ? i + 1 : 0];
            THRONG_CHECK(next != kNone && origin(next) == target(sorted[i]),
                         "the edges of a face go round its corners");
            half_edges_[sorted[i]].next = next;
            halves_[begin + i] = sorted[i];
        }
    }
}

// Puts the triangles of a face in its place; halves_ still hold its loop.
void CutPolyhedron::split_face(const PolytopeView& shape, std::size_t face)
{
    const auto corners = shape.face(face);
    const std::uint32_t begin = shape.face_begin[face];
    long_sides_ = {{0, corners.size() - 1, halves_[begin + corners.size() - 1]}};
    const auto side = [&](std::size_t from, std::size_t to) {
        if (to == from + 1) return halves_[begin + from];
        const auto half = static_cast<std::uint32_t>(half_edges_.size());
        half_edges_.push_back({corners[from], kNone, Surface::own});
        half_edges_.push_back({corners[to], kNone, Surface::own});
        long_sides_.push_back({from, to, half + 1});
        return half;
    };
    collect_triangles(shape, face, triangles_);
    for (const FaceTriangle& triangle : triangles_) {
        const auto [first, middle, last] = triangle;
        const auto known =
            std::find_if(long_sides_.begin(), long_sides_.end(), [&](const LongSide& long_side) {
                return long_side.first == triangle.first && long_side.last == triangle.last;
            });
        const std::uint32_t back = known->half;
        const std::uint32_t up = side(first, middle), down = side(middle, last);
        half_edges_[back].next = up;
        half_edges_[up].next = down;
        half_edges_[down].next = back;
    }
}

void CutPolyhedron::find_bounds()
{
    lower_ = Vec3::Constant(std::numeric_limits<double>::max());
    upper_ = -lower_;
    for (std::uint32_t i = 0; i < x_.size(); ++i) {
        const Vec3 at = vertex(i);
        // What is not a number is less and more than nothing.
        for (int k = 0; k < 3; ++k) {
            lower_[k] = at[k] < lower_[k] ? at[k] : lower_[k];
            upper_[k] = at[k] > upper_[k] ? at[k] : upper_[k];
        }
    }
}

bool CutPolyhedron::spared_by(const CutPlane& plane) const
{
    const Vec3 middle = (lower_ + upper_) / 2, half = (upper_ - lower_) / 2;
    const double most = plane.normal.dot(middle) + plane.normal.cwiseAbs().dot(half);
    // Faces that lie in the plane are cut()'s to find.
    return most < plane.offset - 2 * slack_;
}

CutPolyhedron::Cut CutPolyhedron::cut(const CutPlane& plane)
{
    const std::size_t count = x_.size();
    beyond_.resize(count);
    removed_.resize(count);
    const double x = plane.normal.x(), y = plane.normal.y(), z = plane.normal.z();
    for (std::size_t i = 0; i < count; ++i)
        beyond_[i] = x_[i] * x + y_[i] * y + z_[i] * z - plane.offset;
    std::size_t beyond = 0, inside = 0;
    for (std::size_t i = 0; i < count; ++i) {
        removed_[beyond] = static_cast<std::uint32_t>(i);
        beyond += beyond_[i] > slack_;
        inside += beyond_[i] < -slack_;
    }
    removed_.resize(beyond);
    if (beyond == vertex_count()) return Cut::gone;
    if (beyond == 0) {
        if (vertex_count() - inside >= 3) mark_flush(plane.normal);
        return Cut::missed;
    }
    find_cuts();
    if (!join_cuts()) return Cut::missed;
    free_removed();
    // Few enough gaps for the work to keep to what is there.
    if (2 * vertex_count() < x_.size()) close_gaps();
    return Cut::done;
}

// Faces that lie in the plane and face its way are as much of the one surface as of the other.
void CutPolyhedron::mark_flush(const Vec3& normal)
{
    visit_loops([&](std::uint32_t loop) {
        std::uint32_t half = loop;
        do {
            if (beyond_[origin(half)] < -slack_) return;
            half = half_edges_[half].next;
        } while (half != loop);
        if (half_edges_[loop].surface != Surface::own || !(area_of(loop).dot(normal) > 0)) return;
        do {
            half_edges_[half].surface = Surface::both;
            half = half_edges_[half].next;
        } while (half != loop);
    });
}

// The edges that lie beyond the plane, and those that do with one end.
void CutPolyhedron::find_cuts()
{
    dropped_.clear();
    cuts_.clear();
    for (const std::uint32_t lost : removed_) {
        std::uint32_t half = leaving_[lost];
        do {
            if (!is_removed(target(half))) {
                cuts_.push_back({half ^ 1U, kNone});
            } else if (half % 2 == 0) {
                dropped_.push_back(half / 2);
            }
            half = half_edges_[half ^ 1U].next;
        } while (half != leaving_[lost]);
    }
}

// A new vertex where each cut edge meets the plane, new edges from where the loops leave to where
// they come back, and the other halves of those put into loops of their own. Does nothing where
// there is no room.
bool CutPolyhedron::join_cuts()
{
    if (edge_count() + cuts_.size() > most_edges_) {
        cut_short_ = true;
        return false;
    }
    const std::size_t edges = half_edges_.size() / 2;
    new_vertex_.resize(edges);
    led_to_by_.resize(edges);
    for (const CutEdge& cut : cuts_) {
        const std::uint32_t kept = origin(cut.half), lost = target(cut.half);
        // From the nearer end, where the product loses least; what stays by the slack alone is met
        // where it is.
        const double inside = std::max(-beyond_[kept], 0.0), outside = beyond_[lost];
        const bool near_kept = inside <= outside;
        const Vec3 from = vertex(near_kept ? kept : lost), to = vertex(near_kept ? lost : kept);
        const double part = (near_kept ? inside : outside) / (inside + outside);
        const std::uint32_t added = new_vertex(from + (to - from) * part);
        leaving_[added] = cut.half ^ 1U;
        new_vertex_[cut.half / 2] = added;
    }
    for (CutEdge& cut : cuts_) {
        std::uint32_t back = half_edges_[cut.half].next;
        while (is_removed(target(back))) back = half_edges_[back].next;
        const std::uint32_t half = 2 * new_edge();
        half_edges_[half] = {new_vertex_[cut.half / 2], back, half_edges_[cut.half].surface};
        half_edges_[half + 1] = {new_vertex_[back / 2], kNone, Surface::cut};
        cut.followed_by = half;
        led_to_by_[back / 2] = half;
    }
    // Last, for until now the ends that are lost have said where the loops come back.
    for (const CutEdge& cut : cuts_) {
        half_edges_[cut.half].next = cut.followed_by;
        half_edges_[cut.half ^ 1U].origin = new_vertex_[cut.half / 2];
        half_edges_[cut.followed_by ^ 1U].next = led_to_by_[cut.half / 2] ^ 1U;
    }
    return true;
}

std::uint32_t CutPolyhedron::new_vertex(const Vec3& position)
{
    if (free_vertices_.empty()) {
        x_.push_back(position.x());
        y_.push_back(position.y());
        z_.push_back(position.z());
        leaving_.push_back(kNone);
        beyond_.push_back(0);
        return static_cast<std::uint32_t>(x_.size() - 1);
    }
    const std::uint32_t place = free_vertices_.back();
    free_vertices_.pop_back();
    x_[place] = position.x();
    y_[place] = position.y();
    z_[place] = position.z();
    return place;
}

std::uint32_t CutPolyhedron::new_edge()
{
    if (free_edges_.empty()) {
        half_edges_.resize(half_edges_.size() + 2);
        return static_cast<std::uint32_t>(half_edges_.size() / 2 - 1);
    }
    const std::uint32_t place = free_edges_.back();
    free_edges_.pop_back();
    return place;
}

void CutPolyhedron::free_removed()
{
    for (const std::uint32_t vertex : removed_) {
        x_[vertex] = y_[vertex] = z_[vertex] = std::numeric_limits<double>::quiet_NaN();
        free_vertices_.push_back(vertex);
    }
    for (const std::uint32_t edge : dropped_) {
        half_edges_[2 * edge].origin = half_edges_[2 * edge + 1].origin = kNone;
        free_edges_.push_back(edge);
    }
}

void CutPolyhedron::close_gaps()
{
    place_.resize(half_edges_.size() / 2);
    std::uint32_t kept = 0;
    for (std::uint32_t edge = 0; edge < place_.size(); ++edge) {
        if (origin(2 * edge) == kNone) continue;
        half_edges_[2 * kept] = half_edges_[2 * edge];
        half_edges_[2 * kept + 1] = half_edges_[2 * edge + 1];
        place_[edge] = kept++;
    }
    half_edges_.resize(2 * std::size_t{kept});
    for (HalfEdge& half : half_edges_) half.next = 2 * place_[half.next / 2] + half.next % 2;

    place_.resize(x_.size());
    kept = 0;
    for (std::uint32_t vertex = 0; vertex < place_.size(); ++vertex) {
        if (std::isnan(x_[vertex])) continue;
        x_[kept] = x_[vertex];
        y_[kept] = y_[vertex];
        z_[kept] = z_[vertex];
        place_[vertex] = kept++;
    }
    x_.resize(kept);
    y_.resize(kept);
    z_.resize(kept);
    leaving_.resize(kept);
    for (std::uint32_t half = 0; half < half_edges_.size(); ++half) {
        half_edges_[half].origin = place_[origin(half)];
        leaving_[origin(half)] = half;
    }
    free_vertices_.clear();
    free_edges_.clear();
    find_bounds();
}

// Calls visit(half) once for each face, with one of the halves round it.
template <class Visitor>
void CutPolyhedron::visit_loops(Visitor visit)
{
    visited_.assign(half_edges_.size(), 0);
    for (std::uint32_t loop = 0; loop < half_edges_.size(); ++loop) {
        if (visited_[loop] || origin(loop) == kNone) continue;
        for (std::uint32_t half = loop; !visited_[half]; half = half_edges_[half].next)
            visited_[half] = 1;
        visit(loop);
    }
}

Vec3 CutPolyhedron::area_of(std::uint32_t loop) const
{
    const Vec3 first = vertex(origin(loop));
    Vec3 twice = Vec3::Zero(), arm = Vec3::Zero();
    for (std::uint32_t half = half_edges_[loop].next; half != loop; half = half_edges_[half].next) {
        const Vec3 next = vertex(origin(half)) - first;
        twice += arm.cross(next);
        arm = next;
    }
    return twice / 2;
}

Enclosed CutPolyhedron::enclosed()
{
    // From a point inside, so that nothing large cancels.
    const Vec3 middle = center_of_vertices();
    Enclosed all;
    Vec3 moment = Vec3::Zero();
    visit_loops([&](std::uint32_t loop) {
        const Vec3 first = vertex(origin(loop)) - middle;
        Vec3 twice = Vec3::Zero(), arm = Vec3::Zero();
        std::uint32_t half = half_edges_[loop].next;
        for (; half != loop; half = half_edges_[half].next) {
            const Vec3 next = vertex(origin(half)) - middle - first;
            const Vec3 across = arm.cross(next);
            const double six_volumes = first.dot(across);
            all.volume += six_volumes / 6;
            moment += (3 * first + arm + next) * (six_volumes / 24);
            twice += across;
            arm = next;
        }
        all.surface += twice.norm() / 2;
        const Surface surface = half_edges_[loop].surface;
        if (surface != Surface::cut) all.own += twice * (surface == Surface::own ? 0.5 : 0.25);
    });
    if (all.volume > slack_ * all.surface) {
        all.center = (middle + moment / all.volume).cwiseMax(lower_).cwiseMin(upper_);
    } else {
        all.volume = 0;
        all.center = center_of_surface();
    }
    return all;
}

Vec3 CutPolyhedron::center_of_vertices() const
{
    Vec3 sum = Vec3::Zero();
    for (std::uint32_t i = 0; i < x_.size(); ++i)
        if (!std::isnan(x_[i])) sum += vertex(i);
    return sum / static_cast<double>(vertex_count());
}

Vec3 CutPolyhedron::center_of_surface()
{
    const Vec3 middle = center_of_vertices();
    double total = 0;
    Vec3 moment = Vec3::Zero();
    visit_loops([&](std::uint32_t loop) {
        const Vec3 first = vertex(origin(loop)) - middle;
        Vec3 arm = Vec3::Zero();
        std::uint32_t half = half_edges_[loop].next;
        for (; half != loop; half = half_edges_[half].next) {
            const Vec3 next = vertex(origin(half)) - middle - first;
            const double area = arm.cross(next).norm();
            total += area;
            moment += (3 * first + arm + next) * (area / 3);
            arm = next;
        }
    });
    return total > 0 ? Vec3(middle + moment / total) : middle;
}

}  // namespace throng
