// The axis along which two polytopes are furthest apart, of their faces' normals and the common
// normals of their edges; then the points of touch.
//
// What is known of one axis rules out most others unseen: a ball inside the other shape, and any of
// its points, bound how well an axis may part them. The bounds leave room for rounding, so what is
// ruled out could not have won, and the answer does not hang on where the search began.
//
// Source: Gregorius, The Separating Axis Test between Convex Polyhedra, GDC (2013), for the arcs.
#include "narrowphase/convex/wide/hull_edges.hpp"

namespace throng::THRONG_LANES {

namespace {

// Of the size of the pair: what rounding may do to a separation or to a bound stays below this.
constexpr float kNoise = 2e-6F;

Side side_of_a(const HullPair& pair)
{
    const float* t = pair.turn;
    return {pair.a,
            pair.b,
            {t[0], t[1], t[2], t[3], t[4], t[5], t[6], t[7], t[8]},
            {pair.offset[0], pair.offset[1], pair.offset[2]}};
}

Side side_of_b(const HullPair& pair, const Side& by_a)
{
    const float* t = pair.turn;
    return {pair.b,
            pair.a,
            {t[0], t[3], t[6], t[1], t[4], t[7], t[2], t[5], t[8]},
            -by_a.to_other(by_a.center)};
}

class Search {
public:
    explicit Search(const HullPair& pair)
        : pair_(pair), by_a_(side_of_a(pair)), by_b_(side_of_b(pair, by_a_)),
          distance_(root(dot(by_a_.center, by_a_.center))),
          size_(distance_ + pair.a.outer + pair.b.outer), noise_(kNoise * size_)
    { }

    /// Whether the balls round them, or the axis that was guessed, show them to be beyond the
    /// margin.
    bool parted_at_once(const HullGuess& guess);
    /// How far the axes that were looked at part them, beyond the margin or not.
    float apart() const;
    /// False where an axis shows them to be beyond the margin. Either way the best is remembered.
    bool find_axes(HullGuess& guess);
    void collide(HullOverlap& out);

private:
    bool b_leads() const { return best_b_.separation > best_a_.separation + pair_.bias; }
    static FaceAxis guess_face(const Side& side, std::uint32_t face)
    {
        return {separation_of(side, static_cast<int>(face)), static_cast<int>(face)};
    }
    EdgeAxis guess_edges(std::uint32_t edge_a, std::uint32_t edge_b) const;
    void find_bounds();
    bool find_faces();
    bool improve_faces(float floor_a, float floor_b);
    bool edges_have_alike() const;
    void find_edges(float to_beat);
    HullGuess best() const;
    void cross_edges(HullOverlap& out) const;
    F3 face_normal(bool by_b) const;
    float clip_face(bool by_b, HullOverlap& out) const;
    void collide_vertex(bool by_b, HullOverlap& out) const;

    const HullPair& pair_;
    Side by_a_, by_b_;
    float distance_, size_, noise_;
    FaceAxis best_a_, best_b_;
    EdgeAxis edge_{kNever};
    HullGuess::Kind known_ = HullGuess::none;
    float alike_from_ = kNever;  // a face that is like the best edges is at least so good
    Bound bound_a_, bound_b_;
    Arcs arcs_a_, arcs_b_;
};

// What a pair of edges still says; nothing where they no longer face one another.
EdgeAxis Search::guess_edges(std::uint32_t edge_a, std::uint32_t edge_b) const
{
    EdgeAxis best{kNever};
    const auto arc = [](const WidePolytope& shape, std::uint32_t at) {
        const WideEdge& edge = shape.edges[at];
        return Arc{along_of(edge), vertex_of(shape, edge.from), normal_of(shape, edge.left),
                   normal_of(shape, edge.right), static_cast<int>(at)};
    };
    const Arc a = arc(pair_.a, edge_a), from_b = arc(pair_.b, edge_b);
    const Arc b{by_a_.from_other(from_b.along), by_a_.from_other(from_b.on) + by_a_.center,
                -by_a_.from_other(from_b.left), -by_a_.from_other(from_b.right), from_b.edge};
    const float left_b = dot(b.left, a.along), right_b = dot(b.right, a.along);
    const float left_a = dot(b.along, a.left), right_a = dot(b.along, a.right);
    if (left_b * right_b < 0 && left_a * right_a < 0 && left_b * right_a > 0)
        try_edges(by_a_, a, b, noise_, best);
    return best;
}

bool Search::parted_at_once(const HullGuess& guess)
{
    if (distance_ > pair_.a.outer + pair_.b.outer + pair_.speculative_margin) return true;
    const auto count = [](int number) { return static_cast<std::uint32_t>(number); };
    if (guess.kind == HullGuess::face_a && guess.a < count(pair_.a.faces)) {
        best_a_ = guess_face(by_a_, guess.a);
        known_ = HullGuess::face_a;
        return best_a_.separation > pair_.speculative_margin;
    }
    if (guess.kind == HullGuess::face_b && guess.a < count(pair_.b.faces)) {
        best_b_ = guess_face(by_b_, guess.a);
        known_ = HullGuess::face_b;
        return best_b_.separation > pair_.speculative_margin;
    }
    if (guess.kind == HullGuess::edges && guess.a < count(pair_.a.edge_count)
        && guess.b < count(pair_.b.edge_count)) {
        edge_ = guess_edges(guess.a, guess.b);
        if (edge_.a >= 0) known_ = HullGuess::edges;
        return edge_.separation > pair_.speculative_margin;
    }
    return false;
}

// Points of each, near the other: where the features that were guessed come nearest.
void Search::find_bounds()
{
    bound_a_.inner = pair_.b.inner;
    bound_b_.inner = pair_.a.inner;
    if (known_ == HullGuess::edges) {
        const WideEdge &edge_a = pair_.a.edges[edge_.a], &edge_b = pair_.b.edges[edge_.b];
        F3 on_a[3], on_b[3];
        nearest_points(by_a_, edge_a, edge_b, on_a[0], on_b[0]);
        for (int i = 1; i < 3; ++i) {
            on_a[i] = vertex_of(pair_.a, i == 1 ? edge_a.from : edge_a.to);
            const F3 vertex = vertex_of(pair_.b, i == 1 ? edge_b.from : edge_b.to);
            on_b[i] = by_a_.from_other(vertex) + by_a_.center;
        }
        bound_a_.points = bound_b_.points = 3;
        for (int i = 0; i < 3; ++i) {
            bound_a_.point[i] = on_b[i];
            bound_b_.point[i] = by_a_.to_other(on_a[i] - by_a_.center);
        }
    } else {
        const bool by_b = known_ == HullGuess::face_b;
        const Side& side = by_b ? by_b_ : by_a_;
        const int face = by_b ? best_b_.face : best_a_.face;
        const int vertex = lowest_vertex(side.other, side.to_other(normal_of(side.self, face)));
        const F3 on_other = side.from_other(vertex_of(side.other, vertex)) + side.center;
        const F3 on_self = point_under(side.self, face, on_other);
        Bound &of_self = by_b ? bound_b_ : bound_a_, &of_other = by_b ? bound_a_ : bound_b_;
        of_self.points = of_other.points = 1;
        of_self.point[0] = on_other;
        of_other.point[0] = side.to_other(on_self - side.center);
    }
    for (int i = 0; i < bound_a_.points; ++i) {
        look_beyond(pair_.a, bound_a_.point[i], bound_a_.point_beyond[i]);
        look_beyond(pair_.b, bound_b_.point[i], bound_b_.point_beyond[i]);
    }
}

// The best faces of both, or some that are beyond the margin. A face that could not lead whatever
// comes after is left out, and b's are looked for only from a's best on.
bool Search::find_faces()
{
    look_beyond(pair_.a, by_a_.center, bound_a_.center_beyond);
    float floor_a = kNever, floor_b = kNever;
    if (known_ == HullGuess::none) {
        const int face = furthest_face(pair_.a, bound_a_.center_beyond);
        best_a_ = guess_face(by_a_, static_cast<std::uint32_t>(face));
        if (best_a_.separation > pair_.speculative_margin) return false;
    }
    look_beyond(pair_.b, by_b_.center, bound_b_.center_beyond);
    find_bounds();
    if (known_ == HullGuess::face_b) floor_a = best_b_.separation - pair_.bias - noise_;
    if (known_ == HullGuess::edges) {
        const float less = edges_have_alike() ? most(pair_.bias, kAlikeAngle * size_) : pair_.bias;
        alike_from_ = edge_.separation - less - noise_;
        floor_b = alike_from_ - noise_;
        floor_a = floor_b - pair_.bias - noise_;
    }
    return improve_faces(floor_a, floor_b);
}

bool Search::improve_faces(float floor_a, float floor_b)
{
    improve_face(by_a_, bound_a_, floor_a, pair_.speculative_margin, noise_, best_a_);
    if (best_a_.separation > pair_.speculative_margin) return false;
    floor_b = most(floor_b, best_a_.separation);
    improve_face(by_b_, bound_b_, floor_b, pair_.speculative_margin, noise_, best_b_);
    return best_b_.separation <= pair_.speculative_margin;
}

// Only a face that is like the edges may lead though they are better.
bool Search::edges_have_alike() const
{
    return edge_.a >= 0
        && (has_alike(pair_.a, edge_.normal) || has_alike(pair_.b, by_a_.to_other(-edge_.normal)));
}

// The best edges, if they are better than `to_beat`.
void Search::find_edges(float to_beat)
{
    if (edge_.a < 0 || !(edge_.separation > to_beat)) edge_ = {to_beat};
    const float far = edge_.separation - noise_;
    collect_arcs(by_a_, bound_a_, far, arcs_a_);
    if (arcs_a_.count == 0) return;
    collect_arcs(by_b_, bound_b_, far, arcs_b_);
    const bool known = arcs_a_.count == 1 && arcs_b_.count == 1 && arcs_a_.edge[0] == edge_.a
        && arcs_b_.edge[0] == edge_.b;
    if (known || arcs_b_.count == 0) return;
    turn_arcs(by_a_, arcs_b_);
    for (int i = 0; i < arcs_a_.count; ++i) {
        const Arc a = arc_at(arcs_a_, i);
        for (int k = 0; k < arcs_b_.count; k += L::kWidth) {
            for (unsigned there = crossing(a, arcs_b_, k); there != 0; there &= there - 1) {
                const int at = k + __builtin_ctz(there);
                if (at >= arcs_b_.count) break;
                if (a.edge == edge_.a && arcs_b_.edge[at] == edge_.b) continue;
                try_edges(by_a_, a, arc_at(arcs_b_, at), noise_, edge_);
            }
        }
    }
}

HullGuess Search::best() const
{
    if (edge_.a >= 0)
        return {HullGuess::edges, static_cast<std::uint32_t>(edge_.a),
                static_cast<std::uint32_t>(edge_.b)};
    const bool by_b = best_b_.separation > pair_.speculative_margin || b_leads();
    return {by_b ? HullGuess::face_b : HullGuess::face_a,
            static_cast<std::uint32_t>(by_b ? best_b_.face : best_a_.face), 0};
}

bool Search::find_axes(HullGuess& guess)
{
    const bool near = find_faces();
    if (near) {
        // A face that leads tells where they touch, but not whether: edges may still part them.
        find_edges(least((b_leads() ? best_b_ : best_a_).separation + pair_.bias,
                         pair_.speculative_margin));
        const bool others =
            static_cast<int>(guess.a) != edge_.a || static_cast<int>(guess.b) != edge_.b;
        if (known_ == HullGuess::edges && others && edges_have_alike()) {
            alike_from_ = kNever;
            improve_faces(kNever, kNever);
        }
    }
    guess = best();
    return near && !(edge_.a >= 0 && edge_.separation > pair_.speculative_margin);
}

// The point midway between the two edges; none where edges that are apart pass one another by
// further than the speculative margin.
void Search::cross_edges(HullOverlap& out) const
{
    F3 on_a, on_b;
    nearest_points(by_a_, pair_.a.edges[edge_.a], pair_.b.edges[edge_.b], on_a, on_b);
    const F3 apart = on_b - on_a, middle = (on_a + on_b) * 0.5F;
    const float limit = pair_.speculative_margin + pair_.bias;
    out.count = 0;
    if (edge_.separation > 0 && dot(apart, apart) > limit * limit) return;
    store(edge_.normal, out.normal);
    out.count = 1;
    const WideEdge &of_a = pair_.a.edges[edge_.a], &of_b = pair_.b.edges[edge_.b];
    const F3 seen_from_b = by_a_.to_other(edge_.normal);
    out.edge_to_face = most(most(dot(edge_.normal, normal_of(pair_.a, of_a.left)),
                                 dot(edge_.normal, normal_of(pair_.a, of_a.right))),
                            -least(dot(seen_from_b, normal_of(pair_.b, of_b.left)),
                                   dot(seen_from_b, normal_of(pair_.b, of_b.right))));
    const std::uint32_t edges =
        static_cast<std::uint32_t>(edge_.a) << 8 | static_cast<std::uint32_t>(edge_.b);
    out.points[0] = {{middle.x, middle.y, middle.z}, edge_.separation, 3u << 30 | edges};
}

// b's points about a's center, in a's axes.
void turn_round(const Side& by_a, HullOverlap& out)
{
    for (int i = 0; i < out.count; ++i) {
        HullOverlap::Point& point = out.points[i];
        const F3 turned = by_a.from_other({point.position[0], point.position[1], point.position[2]})
            + by_a.center;
        point = {{turned.x, turned.y, turned.z}, point.separation, point.feature | 1u << 31};
    }
}

// From a to b, in a's axes.
F3 Search::face_normal(bool by_b) const
{
    return by_b ? -by_a_.from_other(normal_of(pair_.b, best_b_.face))
                : normal_of(pair_.a, best_a_.face);
}

// The separation of the deepest point over the best face of one of the two; above any where there
// is none.
float Search::clip_face(bool by_b, HullOverlap& out) const
{
    out.count = 0;
    store(face_normal(by_b), out.normal);
    const int face = (by_b ? best_b_ : best_a_).face;
    const float deepest =
        clip_under(by_b ? by_b_ : by_a_, face, pair_.speculative_margin, pair_.bias, out);
    if (by_b) turn_round(by_a_, out);
    return out.count > 0 ? deepest : -kNever;
}

// The corner that is deepest under the best face of one of the two, over it or not.
void Search::collide_vertex(bool by_b, HullOverlap& out) const
{
    const Side& side = by_b ? by_b_ : by_a_;
    const FaceAxis& face = by_b ? best_b_ : best_a_;
    const F3 normal = normal_of(side.self, face.face);
    const int vertex = lowest_vertex(side.other, side.to_other(normal));
    const F3 corner = side.from_other(vertex_of(side.other, vertex)) + side.center;
    const F3 middle = corner - normal * (face.separation / 2);
    store(face_normal(by_b), out.normal);
    const auto name =
        static_cast<std::uint32_t>(face.face) << 8 | static_cast<std::uint32_t>(vertex);
    out.points[out.count++] = {{middle.x, middle.y, middle.z}, face.separation, 1u << 30 | name};
    if (by_b) turn_round(by_a_, out);
}

void Search::collide(HullOverlap& out)
{
    out.count = 0;
    const bool by_b = b_leads();
    const FaceAxis& face = by_b ? best_b_ : best_a_;
    const F3 normal = face_normal(by_b);
    const float bias = pair_.bias;
    const bool edge_better = edge_.a >= 0;
    const auto alike = [&] {
        return face.separation >= alike_from_ && dot(edge_.normal, normal) > kAlike;
    };
    if (edge_better && !alike()) {
        cross_edges(out);
        return;
    }
    const float at_depth = clip_face(by_b, out);
    if (!edge_better && (face.separation >= 0 || at_depth <= face.separation + 2 * bias)) return;
    // A face that has lost its deepest corner over the other's side still tells the depth, if what
    // is left of it agrees with the edges. Otherwise clipping has lost the very place of touch.
    if (!edge_better) find_edges(most(best_a_.separation, best_b_.separation));
    const float unlike = at_depth - edge_.separation;
    const bool agrees = unlike <= 2 * bias && unlike >= -2 * bias;
    if (edge_.a >= 0 && !(agrees && alike())) cross_edges(out);
    // A face that leads by its bias alone may have nothing over it: then the best one has. Unless
    // the two are deep its points are told far enough apart not to push: at rest others bear the
    // body, and what pushes at times would rock it.
    if (out.count > 0 || face.separation >= 0) return;
    const float deep = 4 * bias;
    const bool shallow = face.separation >= -deep;
    const bool by_best = best_b_.separation >= best_a_.separation;
    if (by_best != by_b) clip_face(by_best, out);
    if (shallow)
        for (int i = 0; i < out.count; ++i) out.points[i].separation += deep;
    if (out.count == 0 && !shallow) collide_vertex(by_best, out);
}

float Search::apart() const
{
    const float by_balls = distance_ - pair_.a.outer - pair_.b.outer;
    const float by_faces = most(best_a_.separation, best_b_.separation);
    const float best = most(most(by_balls, by_faces), edge_.a >= 0 ? edge_.separation : kNever);
    return most(0, best - noise_);
}

void collide_hulls(const HullPair& pair, HullGuess& guess, HullOverlap& out)
{
    out.count = 0;
    out.edge_to_face = 0;
    Search search(pair);
    if (!search.parted_at_once(guess) && search.find_axes(guess)) {
        search.collide(out);
        if (out.count > 0) return;
    }
    out.apart = search.apart();
}

}  // namespace

extern const HullKernel kMeetHulls;
const HullKernel kMeetHulls = collide_hulls;

}  // namespace throng::THRONG_LANES
