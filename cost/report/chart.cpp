// Chart: error against time, both by their logarithms, as SVG: a file of its own, and what the page
// shows. No script draws it, so that it can be printed, scaled, styled and read aloud as it is.
#include "cost/report/cost_report.hpp"
#include "cost/report/markup.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace throng {

namespace {

constexpr double kWidth = 860, kHeight = 480, kLeft = 78, kRight = 170, kTop = 20, kBottom = 56;
constexpr double kMargin = 1.3;  // about what is drawn, as a factor
constexpr double kLeast = 4;     // what an axis spans at least, as a factor
constexpr double kFarDecades = 4;
constexpr std::size_t kLines = 8;  // styles of lines
constexpr double kLegendRow = 19;

// Colors that differ for every kind of sight, on light and on dark (Okabe and Ito, Color universal
// design, 2008); lines beyond the fourth are dashed.
constexpr std::string_view kStyle = R"(<style>
.chart { --ink: #1b1b1b; --faint: #d9d9d9; --paper: #ffffff; --c0: #0072b2; --c1: #d55e00;
  --c2: #008060; --c3: #a8508c; font: 13px system-ui, sans-serif; }
@media (prefers-color-scheme: dark) { .chart { --ink: #ececec; --faint: #444444; --paper: #16181b;
  --c0: #56b4e9; --c1: #f08a4b; --c2: #2fc197; --c3: #e09bca; } }
@media print { .chart { --ink: #000000; --faint: #cccccc; --paper: #ffffff; --c0: #0072b2;
  --c1: #d55e00; --c2: #008060; --c3: #a8508c; } }
.chart .paper { fill: var(--paper); }
.chart text { fill: var(--ink); }
.chart .grid { stroke: var(--faint); stroke-width: 1; }
.chart .axis { stroke: var(--ink); stroke-width: 1; fill: none; }
.chart .wish { stroke: var(--ink); stroke-width: 1; stroke-dasharray: 2 4; }
.chart .front { stroke: var(--ink); stroke-width: 2; fill: none; opacity: 0.6; }
.chart .dial { stroke-width: 1.5; fill: none; opacity: 0.75; }
.chart .l0, .chart .l4 { stroke: var(--c0); } .chart .l1, .chart .l5 { stroke: var(--c1); }
.chart .l2, .chart .l6 { stroke: var(--c2); } .chart .l3, .chart .l7 { stroke: var(--c3); }
.chart .l4, .chart .l5, .chart .l6, .chart .l7 { stroke-dasharray: 6 3; }
.chart .point { fill: var(--paper); stroke: var(--ink); opacity: 0.6; }
.chart .point.best { fill: var(--ink); opacity: 1; }
.chart .point.own { fill: var(--c1); opacity: 1; }
.chart .point.advised { fill: var(--c2); opacity: 1; }
.chart .point:hover, .chart .point:focus { stroke: var(--c1); stroke-width: 4; outline: none; }
.chart .bar { stroke: var(--ink); opacity: 0.5; }
</style>
)";

// A logarithmic axis: from and to in pixels, for the least and the greatest of what is drawn.
class Axis {
public:
    Axis(double from, double to) : from_(from), to_(to) { }
    void hold(double value)
    {
        low_ = std::min(low_, value);
        high_ = std::max(high_, value);
    }
    void widen()
    {
        const double missing = std::sqrt(std::max(1.0, kLeast / (high_ / low_)));
        low_ /= kMargin * missing;
        high_ *= kMargin * missing;
    }
    double place(double value) const
    {
        return from_ + (to_ - from_) * std::log(value / low_) / std::log(high_ / low_);
    }
    bool holds(double value) const { return value >= low_ && value <= high_; }
    // The round values in between; over many decades the powers of ten alone.
    std::vector<double> ticks() const
    {
        std::vector<double> found;
        const bool is_long = std::log10(high_ / low_) > kFarDecades;
        for (int e = static_cast<int>(std::floor(std::log10(low_))); e <= std::log10(high_); ++e)
            for (const double digit : {1.0, 2.0, 5.0}) {
                const double value = digit * std::pow(10, e);
                if (holds(value) && (digit == 1 || !is_long)) found.push_back(value);
            }
        return found;
    }

private:
    double from_, to_, low_ = INFINITY, high_ = 0;
};

// The dials of which a point turns one alone, in order.
std::vector<std::string> dials_drawn(std::span<const Point* const> drawn)
{
    std::vector<std::string> dials;
    for (const Point* const point : drawn) {
        if (point->changes.size() != 1) continue;
        const std::string& dial = point->changes[0].dial;
        if (std::find(dials.begin(), dials.end(), dial) == dials.end()) dials.push_back(dial);
    }
    return dials;
}

class Chart {
public:
    Chart(const CostReport& report, std::ostream& out)
        : report_(report), out_(out), x_(kLeft, kWidth - kRight), y_(kHeight - kBottom, kTop)
    {
        for (const Point& point : report.found.points) {
            if (!is_drawn(point, report.measure)) continue;
            drawn_.push_back(&point);
            x_.hold(point.time_ms.median);
            y_.hold(point.error(report.measure));
        }
        if (!drawn_.empty()) {
            x_.widen();
            y_.widen();
        }
        dials_ = dials_drawn(drawn_);
    }

    void write()
    {
        out_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" viewBox=\"0 0 " << kWidth
             << ' ' << kHeight << "\" role=\"group\" aria-label=\"" << in_markup(report_.scene)
             << ": " << in_markup(report_.told().name) << " against time, " << drawn_.size()
             << " settings\">\n"
             << kStyle << "<rect class=\"paper\" width=\"" << kWidth << "\" height=\"" << kHeight
             << "\"/>\n";
        if (drawn_.empty()) {
            out_ << "<text x=\"" << kWidth / 2 << "\" y=\"" << kHeight / 2
                 << "\" text-anchor=\"middle\">no setting has an error above 0 and a time</text>\n";
        } else {
            grid();
            wish();
            lines();
            front();
            for (const Point* const point : drawn_) mark(*point);
            legend();
        }
        out_ << "</svg>\n";
    }

private:
    void line(const char* kind, double x1, double y1, double x2, double y2)
    {
        out_ << "<line class=\"" << kind << "\" x1=\"" << pixels(x1) << "\" y1=\"" << pixels(y1)
             << "\" x2=\"" << pixels(x2) << "\" y2=\"" << pixels(y2) << "\"/>\n";
    }
    void text(const char* anchor, double x, double y, std::string_view words)
    {
        out_ << "<text aria-hidden=\"true\" text-anchor=\"" << anchor << "\" x=\"" << pixels(x)
             << "\" y=\"" << pixels(y) << "\">" << in_markup(words) << "</text>\n";
    }

    void grid()
    {
        const double bottom = kHeight - kBottom, right = kWidth - kRight;
        for (const double tick : x_.ticks()) {
            line("grid", x_.place(tick), kTop, x_.place(tick), bottom);
            text("middle", x_.place(tick), bottom + 18, figure_text(tick));
        }
        for (const double tick : y_.ticks()) {
            line("grid", kLeft, y_.place(tick), right, y_.place(tick));
            text("end", kLeft - 8, y_.place(tick) + 4, figure_text(tick));
        }
        line("axis", kLeft, bottom, right, bottom);
        line("axis", kLeft, kTop, kLeft, bottom);
        text("middle", (kLeft + right) / 2, kHeight - 12, "time, ms for each 1/60 s of the scene");
        out_ << "<text aria-hidden=\"true\" text-anchor=\"middle\" transform=\"translate(16 "
             << pixels((kTop + bottom) / 2) << ") rotate(-90)\">"
             << in_markup(label_of(report_.told())) << "</text>\n";
    }

    void wish()
    {
        if (x_.holds(report_.wish.time_ms))
            line("wish", x_.place(report_.wish.time_ms), kTop, x_.place(report_.wish.time_ms),
                 kHeight - kBottom);
        if (y_.holds(report_.wish.error))
            line("wish", kLeft, y_.place(report_.wish.error), kWidth - kRight,
                 y_.place(report_.wish.error));
    }

    double x(const Point& point) const { return x_.place(point.time_ms.median); }
    double y(const Point& point) const { return y_.place(point.error(report_.measure)); }

    // By time, whatever order they come in.
    void path(const std::string& kind, std::vector<const Point*> through)
    {
        if (through.size() < 2) return;
        std::stable_sort(through.begin(), through.end(), [](const Point* a, const Point* b) {
            return a->time_ms.median < b->time_ms.median;
        });
        out_ << "<polyline class=\"" << kind << "\" points=\"";
        for (const Point* const point : through)
            out_ << pixels(x(*point)) << ',' << pixels(y(*point)) << ' ';
        out_ << "\"/>\n";
    }

    static std::string style_of(std::size_t dial)
    {
        return "dial l" + std::to_string(dial % kLines);
    }

    // A line a dial, through the points that turn that alone and the scene as it is.
    void lines()
    {
        for (std::size_t dial = 0; dial < dials_.size(); ++dial) {
            std::vector<const Point*> through;
            for (const Point* const point : drawn_)
                if (point->changes.empty()
                    || (point->changes.size() == 1 && point->changes[0].dial == dials_[dial]))
                    through.push_back(point);
            path(style_of(dial), std::move(through));
        }
    }

    void front()
    {
        std::vector<const Point*> through;
        for (const Point* const point : drawn_)
            if (point->on_front) through.push_back(point);
        path("front", std::move(through));
    }

    void mark(const Point& point)
    {
        const auto at = static_cast<std::size_t>(&point - report_.found.points.data());
        const double most = point.error_at_most(report_.measure);
        if (point.on_front && std::isfinite(most))
            line("bar", x(point), y(point), x(point), std::max(y_.place(most), kTop));
        const bool own = point.changes.empty(), advised = &point == advice_.point;
        out_ << "<circle class=\"point" << (point.on_front ? " best" : "") << (own ? " own" : "")
             << (advised ? " advised" : "") << "\" cx=\"" << pixels(x(point)) << "\" cy=\""
             << pixels(y(point)) << "\" r=\""
             << (own || advised       ? 7
                     : point.on_front ? 5
                                      : 3.5)
             << "\" data-point=\"" << at << "\" role=\"img\" aria-label=\"";
        const std::string words = words_of(report_, point);
        out_ << in_markup(words) << "\"><title>" << in_markup(words) << "</title></circle>\n";
    }

    void legend()
    {
        const double left = kWidth - kRight + 16;
        double y = kTop + 8;
        const auto row = [&](std::string_view words) {
            text("start", left + 30, y + 4, words);
            y += kLegendRow;
        };
        const auto dot = [&](const char* kind, double radius, std::string_view words) {
            out_ << "<circle class=\"point " << kind << "\" cx=\"" << pixels(left + 12)
                 << "\" cy=\"" << pixels(y) << "\" r=\"" << radius << "\"/>\n";
            row(words);
        };
        dot("own", 7, name_of_own(report_));
        dot("advised", 7, "advised");
        dot("best", 5, "on the front");
        dot("", 3.5, "beaten");
        for (std::size_t dial = 0; dial < dials_.size(); ++dial) {
            line(style_of(dial).c_str(), left, y, left + 24, y);
            row(dials_[dial]);
        }
    }

    const CostReport& report_;
    std::ostream& out_;
    Axis x_, y_;
    std::vector<const Point*> drawn_;
    std::vector<std::string> dials_;  // that have a line
    const Advice advice_ = advice_of(report_);
};

}  // namespace

void write_cost_svg(const CostReport& report, std::ostream& out) { Chart(report, out).write(); }

}  // namespace throng
