#include "narrowphase/manifold/places_between.hpp"

#include <algorithm>
#include <limits>

namespace throng {

void take_between(const std::vector<LocalManifold<double>::Point>& points,
                  double spacing,
                  double shallow,
                  std::size_t most,
                  std::vector<std::size_t>& taken)
{
    if (points.empty()) return;
    double deepest = std::numeric_limits<double>::infinity();
    for (const auto& point : points) deepest = std::min(deepest, point.separation);
    thread_local std::vector<double> from_taken;  // m, of each point
    from_taken.assign(points.size(), std::numeric_limits<double>::infinity());
    const auto note = [&](std::size_t at) {
        for (std::size_t i = 0; i < points.size(); ++i)
            from_taken[i] =
                std::min(from_taken[i], (points[i].position - points[at].position).norm());
    };
    if (taken.empty() && most > 0) {
        const auto less = [](const auto& p, const auto& q) { return p.separation < q.separation; };
        const auto first = std::min_element(points.begin(), points.end(), less);
        taken.push_back(static_cast<std::size_t>(first - points.begin()));
        --most;
    }
    for (const std::size_t at : taken) note(at);
    for (; most > 0; --most) {
        std::size_t next = 0;
        double furthest = spacing;
        bool found = false;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double away = from_taken[i] - shallow * (points[i].separation - deepest);
            if (!(away > furthest)) continue;
            furthest = away;
            next = i;
            found = true;
        }
        if (!found) return;
        taken.push_back(next);
        note(next);
    }
}

}  // namespace throng
