#include "apps/throng/step_picture.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace throng {

namespace {

// Pixels.
constexpr int kLine = 16, kBoxWidth = 188, kAcross = 64, kDown = 18, kMargin = 16;

struct Box {
    int x = 0, y = 0, height = 0;
    int middle() const { return y + height / 2; }
};

class Picture {
public:
    Picture(std::span<const World::StageInfo> stages, const std::map<std::string_view, double>& ms)
        : stages_(stages), ms_(ms), boxes_(stages.size())
    {
        place();
        find_waits();
    }

    void write(std::ostream& out) const
    {
        out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width_ << "\" height=\""
            << height_ << "\" font-family=\"sans-serif\" font-size=\"12\">\n"
            << "<style>rect{fill:#f4f6f8;stroke:#5b6770}path{fill:none;stroke:#8896a0}"
               ".pass,.ms{fill:#5b6770}</style>\n"
            << "<defs><marker id=\"end\" markerWidth=\"8\" markerHeight=\"8\" refX=\"7\" "
               "refY=\"4\" "
               "orient=\"auto\"><path d=\"M1 1 7 4 1 7\"/></marker></defs>\n";
        for (std::size_t later = 0; later < stages_.size(); ++later)
            for (const std::size_t earlier : stages_[later].waits_for)
                if (!is_implied(earlier, later)) write_wait(earlier, later, out);
        for (std::size_t i = 0; i < stages_.size(); ++i) write_stage(i, out);
        out << "</svg>\n";
    }

private:
    // Each behind the last that it waits for.
    void place()
    {
        std::vector<int> column(stages_.size(), 0), bottom;
        for (std::size_t i = 0; i < stages_.size(); ++i) {
            for (const std::size_t earlier : stages_[i].waits_for)
                column[i] = std::max(column[i], column[earlier] + 1);
            const auto at = static_cast<std::size_t>(column[i]);
            if (bottom.size() <= at) bottom.resize(at + 1, kMargin);
            const int lines = 2 + static_cast<int>(stages_[i].passes.size());
            boxes_[i] = {kMargin + column[i] * (kBoxWidth + kAcross), bottom[at],
                         lines * kLine + kLine / 2};
            bottom[at] += boxes_[i].height + kDown;
            width_ = std::max(width_, boxes_[i].x + kBoxWidth + kMargin);
            height_ = std::max(height_, bottom[at] - kDown + kMargin);
        }
    }

    // Who waits for whom by way of others, too: stages wait for earlier ones alone.
    void find_waits()
    {
        before_.assign(stages_.size(), std::vector<bool>(stages_.size(), false));
        for (std::size_t later = 0; later < stages_.size(); ++later)
            for (const std::size_t earlier : stages_[later].waits_for) {
                before_[later][earlier] = true;
                for (std::size_t i = 0; i < earlier; ++i)
                    if (before_[earlier][i]) before_[later][i] = true;
            }
    }
    bool is_implied(std::size_t earlier, std::size_t later) const
    {
        const auto& waits = stages_[later].waits_for;
        return std::any_of(waits.begin(), waits.end(),
                           [&](std::size_t other) { return before_[other][earlier]; });
    }

    void write_wait(std::size_t earlier, std::size_t later, std::ostream& out) const
    {
        const Box &from = boxes_[earlier], &to = boxes_[later];
        const int x = from.x + kBoxWidth;
        out << "<path marker-end=\"url(#end)\" d=\"M" << x << ' ' << from.middle() << 'C'
            << x + kAcross / 2 << ' ' << from.middle() << ' ' << to.x - kAcross / 2 << ' '
            << to.middle() << ' ' << to.x << ' ' << to.middle() << "\"/>\n";
    }

    void write_stage(std::size_t i, std::ostream& out) const
    {
        const Box& box = boxes_[i];
        out << "<rect x=\"" << box.x << "\" y=\"" << box.y << "\" width=\"" << kBoxWidth
            << "\" height=\"" << box.height << "\" rx=\"4\"/>\n";
        int line = 0;
        const auto write = [&](std::string_view text, const char* kind) {
            out << "<text class=\"" << kind << "\" x=\"" << box.x + 8 << "\" y=\""
                << box.y + ++line * kLine << "\">" << text << "</text>\n";
        };
        write(stages_[i].name, "stage");
        const auto found = ms_.find(stages_[i].name);
        char ms[32] = "";
        if (found != ms_.end()) std::snprintf(ms, sizeof ms, "%.4g ms", found->second);
        write(ms, "ms");
        for (const World::PassInfo& pass : stages_[i].passes)
            write(std::string(pass.name) + ", " + std::string(pass.when), "pass");
    }

    std::span<const World::StageInfo> stages_;
    const std::map<std::string_view, double>& ms_;
    std::vector<Box> boxes_;
    std::vector<std::vector<bool>> before_;  // [later][earlier]
    int width_ = 2 * kMargin, height_ = 2 * kMargin;
};

}  // namespace

void draw_step(std::span<const World::StageInfo> stages,
               const std::map<std::string_view, double>& ms,
               std::ostream& out)
{
    Picture(stages, ms).write(out);
}

}  // namespace throng
