// Read points: what an earlier sweep of the same windows has measured.
#include "cost/report/cost_report.hpp"
#include "scene/files/json.hpp"

#include <limits>

namespace throng {

namespace {

class Reader {
public:
    Reader(const std::string& text, const std::string& file) : json_(text, file) { }

    bool is_of(const std::string& state) const
    {
        const Node found = member(JsonDocument::kRoot, "state", JsonKind::string, "a text");
        return json_.text(found) == state;
    }

    std::vector<Point> points() const
    {
        std::vector<Point> points;
        const Node list = member(JsonDocument::kRoot, "points", JsonKind::array, "an array");
        for (Node at = json_.first(list); at != json_.next(list); at = json_.next(at))
            points.push_back(point(at));
        return points;
    }

private:
    using Node = JsonDocument::Node;

    Node member(Node object, std::string_view key, JsonKind kind, std::string_view wanted) const
    {
        if (json_.kind(object) != JsonKind::object) throw json_.error(object, "wanted an object");
        const Node found = json_.find(object, key);
        if (found == JsonDocument::kRoot)
            throw json_.error(object, "wanted the key " + std::string(key));
        if (json_.kind(found) != kind) throw json_.error(found, "wanted " + std::string(wanted));
        return found;
    }

    Point point(Node at) const
    {
        Point point;
        const Node settings = member(at, "settings", JsonKind::object, "an object");
        for (Node key = json_.first(settings); key != json_.next(settings);) {
            const Node value = key + 1;
            point.changes.push_back({std::string(json_.text(key)), std::string(json_.text(value))});
            key = json_.next(value);
        }
        if (json_.find(at, "trouble") != JsonDocument::kRoot) {
            point.trouble = json_.text(member(at, "trouble", JsonKind::string, "a text"));
            return point;
        }
        const Node squares = member(at, "squares", JsonKind::array, "an array");
        for (Node k = json_.first(squares); k != json_.next(squares); k = json_.next(k))
            point.errors.push_back(window(k));
        const Node times = member(at, "times_ms", JsonKind::array, "an array");
        if (json_.size(times) != json_.size(squares))
            throw json_.error(times, "wanted a time for each window");
        double sum = 0;
        for (Node k = json_.first(times); k != json_.next(times); k = json_.next(k)) {
            if (json_.kind(k) != JsonKind::number) throw json_.error(k, "wanted a number");
            point.times_ms.push_back(json_.number(k));
            sum += json_.number(k);
        }
        const double mean =
            point.times_ms.empty() ? 0 : sum / static_cast<double>(point.times_ms.size());
        point.time_ms = {mean, mean, mean, 1};
        return point;
    }

    // What is not finite was written as null.
    WindowErrors window(Node at) const
    {
        WindowErrors errors{};
        if (json_.kind(at) != JsonKind::array || json_.size(at) != kMeasures)
            throw json_.error(at, "wanted a number for each measure");
        Node each = json_.first(at);
        for (double& square : errors) {
            square = json_.kind(each) == JsonKind::number ? json_.number(each)
                                                          : std::numeric_limits<double>::infinity();
            each = json_.next(each);
        }
        return errors;
    }

    JsonDocument json_;
};

}  // namespace

std::vector<Point>
read_points(const std::string& text, const std::string& file, const std::string& state)
{
    const Reader reader(text, file);
    return reader.is_of(state) ? reader.points() : std::vector<Point>{};
}

}  // namespace throng
