// Trace: which stage and which block of its loops ran when on which thread, in the last steps.
#include "pipeline/records/trace.hpp"

#include "kernels/parallel/block_watch.hpp"
#include "pipeline/world/world_state.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace throng {
namespace {

std::uint64_t next_id()
{
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

// Names are those of stages and scenes: of plain letters, but a file may be called anything.
std::string quoted(std::string_view text)
{
    std::string all = "\"";
    for (const char letter : text) {
        if (letter == '"' || letter == '\\') all += '\\';
        all += static_cast<unsigned char>(letter) < ' ' ? ' ' : letter;
    }
    return all += '"';
}

std::string microseconds(std::chrono::steady_clock::duration time)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.3f",
                  std::chrono::duration<double, std::micro>(time).count());
    return text;
}

}  // namespace

/// Of one step and thread a row of events.
class Trace::Inside final : public StepWatch {
public:
    explicit Inside(std::size_t steps_kept);

    void begin_step(std::uint64_t number);
    void end_step();
    void run_stage(std::string_view name, const std::function<void()>& stage) override;
    std::size_t steps() const;
    std::uint64_t left_out() const;
    void write(std::string_view label, const std::vector<Wait>& waits, std::ostream& out) const;

private:
    using Clock = std::chrono::steady_clock;
    class Blocks;

    struct Event {
        std::string_view stage;
        std::int64_t block = kWholeStage;
        Clock::time_point begin, end;
    };
    static constexpr std::int64_t kWholeStage = -1;

    /// What one thread did, by the step's slot. Nobody else writes there.
    struct Row {
        std::thread::id thread;
        std::vector<std::vector<Event>> steps;
        std::uint64_t left_out = 0;
    };
    struct Step {
        std::uint64_t number = 0;
        Clock::time_point begin, end;
    };

    Row& row_of_thread();
    void add(const Event& event);
    std::vector<std::size_t> kept_indices_in_order() const;
    static void write_bar(std::string_view name,
                          std::string_view kind,
                          std::size_t row,
                          const Event& event,
                          Clock::time_point zero,
                          std::ostream& out);
    void write_arrows(const std::vector<Wait>& waits,
                      std::size_t kept_index,
                      Clock::time_point zero,
                      std::ostream& out) const;

    const std::uint64_t id_;  // no two traces share one, not even one after another
    std::size_t kept_index_ = 0;
    std::uint64_t begun_ = 0;
    std::vector<Step> kept_;
    std::mutex guard_;  // of rows_, not of what is in them
    std::deque<Row> rows_;
};

/// Sees the blocks of one stage.
class Trace::Inside::Blocks final : public BlockWatch {
public:
    Blocks(Inside& trace, std::string_view stage) : trace_(trace), stage_(stage) { }
    void run_block(const BlockBody& block,
                   std::size_t begin,
                   std::size_t end,
                   std::size_t number) override
    {
        const auto from = Clock::now();
        block(begin, end, number);
        trace_.add({stage_, static_cast<std::int64_t>(number), from, Clock::now()});
    }

private:
    Inside& trace_;
    std::string_view stage_;
};

Trace::Inside::Inside(std::size_t steps_kept)
    : id_(next_id()), kept_(std::max<std::size_t>(1, steps_kept))
{ }

void Trace::Inside::begin_step(std::uint64_t number)
{
    kept_index_ = begun_++ % kept_.size();
    for (Row& row : rows_) row.steps[kept_index_].clear();
    kept_[kept_index_] = {number, Clock::now(), {}};
}

void Trace::Inside::end_step() { kept_[kept_index_].end = Clock::now(); }

Trace::Inside::Row& Trace::Inside::row_of_thread()
{
    struct Known {
        std::uint64_t trace = 0;
        Row* row = nullptr;
    };
    thread_local Known known;
    if (known.row != nullptr && known.trace == id_) return *known.row;
    const std::lock_guard lock(guard_);
    const auto self = std::this_thread::get_id();
    const auto found = std::find_if(rows_.begin(), rows_.end(),
                                    [&](const Row& row) { return row.thread == self; });
    Row& row = found != rows_.end() ? *found : rows_.emplace_back();
    row.thread = self;
    row.steps.resize(kept_.size());
    known = {id_, &row};
    return row;
}

void Trace::Inside::add(const Event& event)
{
    Row& row = row_of_thread();
    std::vector<Event>& events = row.steps[kept_index_];
    if (events.size() < kMostEvents)
        events.push_back(event);
    else
        ++row.left_out;
}

void Trace::Inside::run_stage(std::string_view name, const std::function<void()>& stage)
{
    Blocks blocks(*this, name);
    const auto begin = Clock::now();
    {
        const BlockWatchScope watched(&blocks);
        stage();
    }
    add({name, kWholeStage, begin, Clock::now()});
}

std::size_t Trace::Inside::steps() const { return std::min<std::size_t>(begun_, kept_.size()); }

std::uint64_t Trace::Inside::left_out() const
{
    std::uint64_t sum = 0;
    for (const Row& row : rows_) sum += row.left_out;
    return sum;
}

std::vector<std::size_t> Trace::Inside::kept_indices_in_order() const
{
    std::vector<std::size_t> kept_indices;
    for (std::uint64_t step = begun_ - steps(); step < begun_; ++step)
        kept_indices.push_back(step % kept_.size());
    return kept_indices;
}

void Trace::Inside::write(std::string_view label,
                          const std::vector<Wait>& waits,
                          std::ostream& out) const
{
    const std::vector<std::size_t> kept_indices = kept_indices_in_order();
    const Clock::time_point zero =
        kept_indices.empty() ? Clock::time_point() : kept_[kept_indices[0]].begin;
    out << R"({"displayTimeUnit": "ms", "otherData": {"run": )" << quoted(label) << R"(, "steps": )"
        << kept_indices.size() << R"(, "left_out": )" << left_out() << "},\n\"traceEvents\": [\n";
    // Row 0 is of the steps, the others are those of threads.
    const auto name_row = [&](std::size_t row, const std::string& name) {
        out << R"({"ph": "M", "name": "thread_name", "pid": 1, "tid": )" << row
            << R"(, "args": {"name": )" << quoted(name) << "}}";
    };
    name_row(0, "steps");
    for (std::size_t row = 1; row <= rows_.size(); ++row) {
        out << ",\n";
        name_row(row, "thread " + std::to_string(row));
    }
    for (const std::size_t kept_index : kept_indices) {
        const Step& step = kept_[kept_index];
        write_bar("step " + std::to_string(step.number), "step", 0,
                  {{}, kWholeStage, step.begin, step.end}, zero, out);
        for (std::size_t row = 0; row < rows_.size(); ++row)
            for (const Event& event : rows_[row].steps[kept_index])
                write_bar(event.stage, event.block == kWholeStage ? "stage" : "block", row + 1,
                          event, zero, out);
        write_arrows(waits, kept_index, zero, out);
    }
    out << "\n]}\n";
}

void Trace::Inside::write_bar(std::string_view name,
                              std::string_view kind,
                              std::size_t row,
                              const Event& event,
                              Clock::time_point zero,
                              std::ostream& out)
{
    out << ",\n"
        << R"({"ph": "X", "name": )" << quoted(name) << R"(, "cat": )" << quoted(kind)
        << R"(, "pid": 1, "tid": )" << row << R"(, "ts": )" << microseconds(event.begin - zero)
        << R"(, "dur": )" << microseconds(event.end - event.begin);
    if (event.block != kWholeStage) out << R"(, "args": {"block": )" << event.block << '}';
    out << '}';
}

// From the end of a stage to the beginning of one that waits for it.
void Trace::Inside::write_arrows(const std::vector<Wait>& waits,
                                 std::size_t kept_index,
                                 Clock::time_point zero,
                                 std::ostream& out) const
{
    struct Place {
        const Event* event = nullptr;
        std::size_t row = 0;
    };
    const auto place_of = [&](std::string_view stage) {
        for (std::size_t row = 0; row < rows_.size(); ++row)
            for (const Event& event : rows_[row].steps[kept_index])
                if (event.block == kWholeStage && event.stage == stage)
                    return Place{&event, row + 1};
        return Place{};
    };
    for (std::size_t i = 0; i < waits.size(); ++i) {
        const Place from = place_of(waits[i].earlier), to = place_of(waits[i].later);
        if (from.event == nullptr || to.event == nullptr) continue;
        const std::uint64_t id = kept_[kept_index].number * waits.size() + i;
        const auto write_end = [&](const char* kind, std::size_t row, Clock::time_point at) {
            out << ",\n"
                << R"({"ph": ")" << kind
                << R"(", "name": "waits", "cat": "wait", "bp": "e", "pid": 1, "id": )" << id
                << R"(, "tid": )" << row << R"(, "ts": )" << microseconds(at - zero) << '}';
        };
        // An arrow belongs to the bar that its end is in: the last nanosecond, not the one after.
        constexpr std::chrono::nanoseconds kLast(1);
        write_end("s", from.row, std::max(from.event->begin, from.event->end - kLast));
        write_end("f", to.row, to.event->begin);
    }
}

Trace::Trace(std::size_t steps_kept) : inside_(std::make_unique<Inside>(steps_kept)) { }
Trace::~Trace() = default;
Trace::Trace(Trace&&) noexcept = default;
Trace& Trace::operator=(Trace&&) noexcept = default;

void Trace::watch(World& world) { state_of(world).watch = inside_.get(); }
void Trace::leave(World& world) { state_of(world).watch = nullptr; }

void Trace::begin_step(std::uint64_t number) { inside_->begin_step(number); }
void Trace::end_step() { inside_->end_step(); }
std::size_t Trace::steps() const { return inside_->steps(); }
std::uint64_t Trace::left_out() const { return inside_->left_out(); }

void Trace::write(std::string_view label, const std::vector<Wait>& waits, std::ostream& out) const
{
    inside_->write(label, waits, out);
}

}  // namespace throng
