// Read report: what an earlier sweep has measured, to go on from and to be compared.
#include "cost/report/cost_report.hpp"
#include "scene/files/json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

class Reader {
public:
    Reader(const std::string& text, const std::string& file) : json_(text, file) { }

    bool is_of(const std::string& state) const { return text(kTop, "state") == state; }
    // Of an older report, whose measures were others, points cannot be taken.
    bool has(const std::vector<Quantity>& quantities) const
    {
        const std::vector<Quantity> told = units();
        return std::equal(told.begin(), told.end(), quantities.begin(), quantities.end(),
                          [](const Quantity& a, const Quantity& b) { return a.name == b.name; });
    }

    // Dials that were set for all of it; none where a report is older than they are told.
    Changes given() const
    {
        return json_.kind(kTop) == JsonKind::object && has(kTop, "given") ? changes(kTop, "given")
                                                                          : Changes{};
    }

    std::vector<Point> points(std::size_t quantities) const
    {
        std::vector<Point> points;
        const Node list = member(kTop, "points", JsonKind::array, "an array");
        for (Node at = json_.first(list); at != json_.next(list); at = json_.next(at))
            points.push_back(point(at, quantities));
        return points;
    }

    CostReport report() const
    {
        CostReport report;
        report.state = text(kTop, "state");
        const bool of_case = has(kTop, "case");
        report.scene = text(kTop, of_case ? "case" : "scene");
        report.given = given();
        if (has(kTop, "command")) report.command = text(kTop, "command");
        report.bodies = count(kTop, "bodies");
        report.machine = machine(member(kTop, "machine", JsonKind::object, "an object"));
        if (of_case) {
            report.of_case = CaseLine{text(kTop, "about"), text(kTop, "line"), count(kTop, "runs"),
                                      number(kTop, "seconds")};
        } else {
            report.seed = count(kTop, "seed");
            report.windows = count(kTop, "windows");
            report.at_rest = count(kTop, "windows_at_rest");
            report.window = number(kTop, "window_s");
            report.plan.seconds = number(kTop, "seconds");
        }
        read_quantities(report);
        const Node reference = member(kTop, "reference", JsonKind::object, "an object");
        report.reference.settings = text(reference, "settings");
        of(report.reference.remaining, report.measure) = number(reference, "remaining");
        report.reference.settles = is_true(reference, "settles");
        const Node wish = member(kTop, "wish", JsonKind::object, "an object");
        report.wish = {number(wish, "error"), number(wish, "time_ms")};
        report.found.points = points(report.quantities.size());
        for (Point& each : report.found.points) each.reference_off = report.reference.remaining;
        return report;
    }

private:
    using Node = JsonDocument::Node;
    static constexpr Node kTop = JsonDocument::kRoot;

    bool has(Node object, std::string_view key) const { return json_.find(object, key) != kTop; }
    Node member(Node object, std::string_view key) const
    {
        if (json_.kind(object) != JsonKind::object) throw json_.error(object, "wanted an object");
        const Node found = json_.find(object, key);
        if (found == kTop) throw json_.error(object, "wanted the key " + std::string(key));
        return found;
    }
    Node member(Node object, std::string_view key, JsonKind kind, std::string_view wanted) const
    {
        const Node found = member(object, key);
        if (json_.kind(found) != kind) throw json_.error(found, "wanted " + std::string(wanted));
        return found;
    }
    std::string text(Node object, std::string_view key) const
    {
        return std::string(json_.text(member(object, key, JsonKind::string, "a text")));
    }
    bool is_true(Node object, std::string_view key) const
    {
        return json_.boolean(member(object, key, JsonKind::boolean, "true or false"));
    }
    // What is not finite was written as null.
    double number(Node object, std::string_view key) const { return number(member(object, key)); }
    double number(Node at) const
    {
        if (json_.kind(at) == JsonKind::null) return std::numeric_limits<double>::infinity();
        if (json_.kind(at) != JsonKind::number) throw json_.error(at, "wanted a number");
        return json_.number(at);
    }
    // Up to what a double counts to.
    std::size_t count(Node object, std::string_view key) const
    {
        const Node found = member(object, key, JsonKind::number, "a number");
        const double counted = json_.number(found);
        if (!(counted >= 0 && counted <= 0x1p63) || counted != std::floor(counted))
            throw json_.error(found, "wanted a whole number from 0");
        return static_cast<std::size_t>(counted);
    }

    Machine machine(Node at) const
    {
        Machine machine;
        machine.processor = text(at, "processor");
        machine.version = text(at, "throng");
        machine.cores = static_cast<unsigned>(count(at, "cores"));
        machine.threads = static_cast<int>(count(at, "threads"));
        machine.load = number(at, "load");
        return machine;
    }

    // Their units by their names, in the order of errors.
    std::vector<Quantity> units() const
    {
        std::vector<Quantity> quantities;
        const Node units = member(kTop, "units", JsonKind::object, "an object");
        for (Node key = json_.first(units); key != json_.next(units);) {
            const Node unit = key + 1;
            if (json_.kind(unit) != JsonKind::string) throw json_.error(unit, "wanted a text");
            quantities.push_back({std::string(json_.text(key)), std::string(json_.text(unit)), {}});
            key = json_.next(unit);
        }
        return quantities;
    }
    void read_quantities(CostReport& report) const
    {
        report.quantities = units();
        const std::string measure = text(kTop, "measure");
        const auto is_measure = [&](const Quantity& each) { return each.name == measure; };
        while (report.measure < report.quantities.size()
               && !is_measure(report.quantities[report.measure]))
            ++report.measure;
        if (report.measure == report.quantities.size())
            throw json_.error(member(kTop, "measure"), "wanted one of those that have units");
    }

    Changes changes(Node object, std::string_view key) const
    {
        Changes changes;
        const Node settings = member(object, key, JsonKind::object, "an object");
        for (Node name = json_.first(settings); name != json_.next(settings);) {
            const Node value = name + 1;
            if (json_.kind(value) != JsonKind::string && json_.kind(value) != JsonKind::number)
                throw json_.error(value, "wanted a number or a text");
            changes.push_back({std::string(json_.text(name)), std::string(json_.text(value))});
            name = json_.next(value);
        }
        return changes;
    }

    Point point(Node at, std::size_t quantities) const
    {
        Point point;
        point.changes = changes(at, "settings");
        if (has(at, "trouble")) {
            point.trouble = text(at, "trouble");
            return point;
        }
        const Node squares = member(at, "squares", JsonKind::array, "an array");
        for (Node k = json_.first(squares); k != json_.next(squares); k = json_.next(k))
            point.errors.push_back(errors(k, quantities));
        const Node times = member(at, "times_ms", JsonKind::array, "an array");
        if (json_.size(times) != json_.size(squares))
            throw json_.error(times, "wanted a time for each of the squares");
        for (Node k = json_.first(times); k != json_.next(times); k = json_.next(k)) {
            if (json_.kind(k) != JsonKind::number) throw json_.error(k, "wanted a number");
            point.times_ms.push_back(json_.number(k));
        }
        const Node time = member(at, "time_ms", JsonKind::object, "an object");
        point.time_ms = {number(time, "median"), number(time, "least"), number(time, "most"),
                         count(time, "repeats")};
        point.on_front = is_true(at, "on_front");
        return point;
    }

    Errors errors(Node at, std::size_t quantities) const
    {
        if (json_.kind(at) != JsonKind::array || json_.size(at) != quantities)
            throw json_.error(at, "wanted a number for each measure");
        Errors errors;
        for (Node each = json_.first(at); each != json_.next(at); each = json_.next(each))
            errors.push_back(number(each));
        return errors;
    }

    JsonDocument json_;
};

}  // namespace

CostReport read_report(const std::string& text, const std::string& file)
{
    return Reader(text, file).report();
}

std::vector<Point>
read_points(const std::string& text, const std::string& file, const CostReport& report)
{
    const Reader reader(text, file);
    const bool goes_on = reader.is_of(report.state) && reader.given() == report.given
        && reader.has(report.quantities);
    return goes_on ? reader.points(report.quantities.size()) : std::vector<Point>{};
}

}  // namespace throng
