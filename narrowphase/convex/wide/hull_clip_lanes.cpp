// The points that two faces share: the edges of one cut by the sides of the other, and the corners
// of the other that lie over the one.
//
// Source: Liang, Barsky, A New Concept and Method for Line Clipping (1984).
#include "narrowphase/convex/wide/hull_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// A face's corners, each with the one after it, in self's frame; zero up to a whole group.
struct Outline {
    int count = 0;
    float x[kWideCorners], y[kWideCorners], z[kWideCorners];
    float next_x[kWideCorners], next_y[kWideCorners], next_z[kWideCorners];

    F3 at(int i) const { return {x[i], y[i], z[i]}; }
    void put(int i, F3 corner)
    {
        x[i] = corner.x;
        y[i] = corner.y;
        z[i] = corner.z;
    }
    void close()
    {
        const int whole = (count + L::kWidth - 1) / L::kWidth * L::kWidth;
        for (int i = count; i < whole; ++i) {
            put(i, {0, 0, 0});
            put_next(i, {0, 0, 0});
        }
        for (int i = 0; i + 1 < count; ++i) put_next(i, at(i + 1));
        put_next(count - 1, at(0));
    }
    void put_next(int i, F3 corner)
    {
        // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): every face has corners
        next_x[i] = corner.x;
        next_y[i] = corner.y;
        next_z[i] = corner.z;
    }
};

struct Face {
    int index, corners, begin;
    F3 normal;
    float offset;

    Face(const WidePolytope& shape, int face)
        : index(face), corners(shape.face_begin()[face + 1] - shape.face_begin()[face]),
          begin(shape.face_begin()[face]), normal(normal_of(shape, face)),
          offset(shape.offset()[face])
    { }
};

// Of the other's faces at the vertex that is nearest, the one most against the normal.
int face_against(const WidePolytope& other, F3 local)
{
    const int vertex = lowest_vertex(other, local);
    int best = 0;
    float lowest_cosine = 2;
    for (int i = other.vertex_begin()[vertex]; i < other.vertex_begin()[vertex + 1]; ++i) {
        const int face = other.around()[i];
        const float cosine = dot(normal_of(other, face), local);
        if (cosine < lowest_cosine) {
            lowest_cosine = cosine;
            best = face;
        }
    }
    return best;
}

// Which stretch of each edge is left: fractions of it, and the walls that cut it (-1 for none).
struct Cuts {
    float from[kWideCorners], to[kWideCorners], from_wall[kWideCorners], to_wall[kWideCorners];
    unsigned left[kWideCorners / L::kWidth];  // edges with anything left, as bits
};

void cut_edges(const Wall* walls, int count, const Outline& line, float slack, Cuts& cuts)
{
    const L zero = 0.0F, one = 1.0F, near = slack;
    for (int at = 0; at < line.count; at += L::kWidth) {
        const L x = L::load(line.x + at), y = L::load(line.y + at), z = L::load(line.z + at);
        const L next_x = L::load(line.next_x + at), next_y = L::load(line.next_y + at);
        const L next_z = L::load(line.next_z + at);
        L from = zero, to = one, from_wall = -1.0F, to_wall = -1.0F;
        auto gone = zero > zero;
        for (int i = 0; i < count; ++i) {
            const Wall& wall = walls[i];
            const L out_x = wall.out.x, out_y = wall.out.y, out_z = wall.out.z;
            const L here = out_x * x + out_y * y + out_z * z - L(wall.offset);
            const L next = out_x * next_x + out_y * next_y + out_z * next_z - L(wall.offset);
            // A corner within the slack counts as inside, but what crosses is cut at the wall.
            const auto here_out = here > near, next_out = next > near;
            gone |= here_out & next_out;
            const L span = select(here_out ^ next_out, here - next, one);
            const L at_wall = min(max(here / span, zero), one);
            const auto enters = here_out & (!next_out) & (!(at_wall < from));
            const auto leaves = next_out & (!here_out) & (!(at_wall > to));
            const L number = static_cast<float>(i);
            from = select(enters, at_wall, from);
            from_wall = select(enters, number, from_wall);
            to = select(leaves, at_wall, to);
            to_wall = select(leaves, number, to_wall);
        }
        from.store(cuts.from + at);
        to.store(cuts.to + at);
        from_wall.store(cuts.from_wall + at);
        to_wall.store(cuts.to_wall + at);
        cuts.left[at / L::kWidth] = bits_of((!gone) & (!(from > to)));
    }
}

// Points over a face, out to the speculative margin.
struct Gathered {
    const Face& face;
    float speculative_margin;
    std::uint32_t faces;  // both of them, as the upper bits of features
    HullOverlap& out;
    float deepest = 0;

    void add(F3 point, float separation, std::uint32_t feature)
    {
        if (!(separation <= speculative_margin)) return;
        deepest = out.count == 0 ? separation : least(deepest, separation);
        const F3 middle = point - face.normal * (separation / 2);
        out.points[out.count++] = {{middle.x, middle.y, middle.z}, separation, feature | faces};
    }
    void add_over(F3 point, std::uint32_t feature)
    {
        add(point, dot(face.normal, point) - face.offset, feature);
    }
};

// A feature's lower bits: what it is (2), which corner or edge (6), which wall (6).
enum Place : std::uint32_t { corner_over, edge_enters, edge_leaves, corner_under };
std::uint32_t name(Place place, int corner, float wall)
{
    return static_cast<std::uint32_t>(place) << 12 | static_cast<std::uint32_t>(corner) << 6
        | static_cast<std::uint32_t>(wall);
}

// True where the outline lies over the face as a whole.
bool add_edges(const Outline& line, const Cuts& cuts, Gathered& found)
{
    bool whole = true;
    for (int i = 0; i < line.count; ++i) {
        const bool left = (cuts.left[i / L::kWidth] >> i % L::kWidth & 1u) != 0;
        whole = whole && left && cuts.from_wall[i] < 0 && cuts.to_wall[i] < 0;
        if (!left) continue;
        const F3 here = line.at(i);
        const F3 along = F3{line.next_x[i], line.next_y[i], line.next_z[i]} - here;
        if (cuts.from_wall[i] < 0)
            found.add_over(here, name(corner_over, i, 0));
        else
            found.add_over(here + along * cuts.from[i], name(edge_enters, i, cuts.from_wall[i]));
        // A stretch without length has one end.
        if (cuts.to_wall[i] >= 0 && cuts.to[i] > cuts.from[i])
            found.add_over(here + along * cuts.to[i], name(edge_leaves, i, cuts.to_wall[i]));
    }
    return whole;
}

// The face's own corners that lie well inside the outline; those near its edges are there already,
// where the edges are cut.
void add_corners(const WidePolytope& self,
                 const Face& face,
                 const Outline& line,
                 F3 against,
                 float slack,
                 Gathered& found)
{
    const float facing = dot(against, face.normal);
    // A face seen from its edge has nothing over it.
    if (facing > -0.05F) return;
    unsigned inside = (2u << (face.corners - 1)) - 1;
    for (int i = 0; i < line.count && inside != 0; ++i) {
        const F3 here = line.at(i);
        const F3 along = F3{line.next_x[i], line.next_y[i], line.next_z[i]} - here;
        const F3 out = cross(face.normal, along);
        const float limit = dot(out, here) - slack * root(dot(out, out));
        for (int k = 0; k < face.corners; ++k)
            if (dot(out, vertex_of(self, self.corners()[face.begin + k])) > limit)
                inside &= ~(1u << k);
    }
    for (; inside != 0; inside &= inside - 1) {
        const int k = __builtin_ctz(inside);
        const F3 corner = vertex_of(self, self.corners()[face.begin + k]);
        const float separation = dot(against, line.at(0) - corner) / facing;
        found.add(corner + face.normal * separation, separation, name(corner_under, k, 0));
    }
}

}  // namespace

float clip_under(
    const Side& side, int index, float speculative_margin, float slack, HullOverlap& out)
{
    const Face face(side.self, index);
    const Face against(side.other, face_against(side.other, side.to_other(face.normal)));
    Outline line;
    line.count = against.corners;
    for (int i = 0; i < line.count; ++i)
        line.put(i,
                 side.from_other(vertex_of(side.other, side.other.corners()[against.begin + i]))
                     + side.center);
    line.close();
    Wall walls[kWideCorners];
    for (int i = 0; i < face.corners; ++i) walls[i] = wall_of(side.self, index, i);
    Cuts cuts;
    cut_edges(walls, face.corners, line, slack, cuts);

    const auto faces =
        static_cast<std::uint32_t>(face.index) << 8 | static_cast<std::uint32_t>(against.index);
    Gathered found{face, speculative_margin, faces << 14, out};
    // An outline that lies over the face as a whole has none of its corners under it.
    if (add_edges(line, cuts, found)) return found.deepest;
    add_corners(side.self, face, line, side.from_other(against.normal), slack, found);
    return found.deepest;
}

}  // namespace throng::THRONG_LANES
