// Stage: how a function becomes a row of the step table.
//
// What a stage reads and writes is read off its signature: a const parameter is read, any other is
// written (and may be read). So the declaration cannot drift from what the stage can reach. Its
// name is that of the function.
#pragma once

#include "pipeline/step/passes.hpp"
#include "pipeline/step/step_data.hpp"
#include "throng/effects.hpp"

#include <string_view>
#include <type_traits>
#include <utility>

namespace throng {

/// Some of the kinds of data in StepData, as bits in its order.
struct DataSet {
    std::uint64_t bits = 0;

    constexpr bool meets(DataSet other) const { return (bits & other.bits) != 0; }
    constexpr bool covers(DataSet other) const { return (other.bits & ~bits) == 0; }
    friend constexpr DataSet operator|(DataSet a, DataSet b) { return {a.bits | b.bits}; }
};

namespace detail {

template <class T, class Tuple>
struct PlaceIn;
template <class T, class... SleepEvents>
struct PlaceIn<T, std::tuple<T, SleepEvents...>> : std::integral_constant<unsigned, 0> { };
template <class T, class First, class... SleepEvents>
struct PlaceIn<T, std::tuple<First, SleepEvents...>>
    : std::integral_constant<unsigned, 1 + PlaceIn<T, std::tuple<SleepEvents...>>::value> { };

}  // namespace detail

template <class Real, class T>
constexpr DataSet data_set = {std::uint64_t{1} << detail::PlaceIn<T, StepData<Real>>::value};

/// What several stages work on alike, as one parameter: read where it is const.
template <class... Data>
struct StageData {
    std::tuple<Data&...> data;

    /// By its type as it stands in the list.
    template <class T>
    T& get() const
    {
        return std::get<T&>(data);
    }
};

/// A row of the step table.
///
///   chosen_by  settings by which it is there, besides the effects; null: any
///   passes     what runs within it; null: nothing that repeats
template <class Real>
struct Stage {
    std::string_view name;
    Set<Effect> called_for_by;
    DataSet reads;
    DataSet writes;
    void (*run)(StepData<Real>&);
    bool (*chosen_by)(const Settings&) = nullptr;
    std::vector<PassRow> (*passes)() = nullptr;

    /// True when this stage has to wait for an earlier row of the table.
    constexpr bool waits_for(const Stage& earlier) const
    {
        return earlier.writes.meets(reads | writes) || earlier.reads.meets(writes);
    }
};

namespace detail {

// A parameter of a stage, out of the data of the step.
template <class Real, class Parameter>
struct Argument {
    using Kind = std::remove_cvref_t<Parameter>;
    static constexpr bool only_read = std::is_const_v<std::remove_reference_t<Parameter>>;
    static constexpr DataSet reads = only_read ? data_set<Real, Kind> : DataSet{};
    static constexpr DataSet writes = only_read ? DataSet{} : data_set<Real, Kind>;
    static Parameter of(StepData<Real>& step) { return std::get<Kind>(step); }
};

template <class Real, class... Data>
struct Argument<Real, const StageData<Data...>&> {
    static constexpr DataSet reads = (DataSet{} | ... | Argument<Real, Data&>::reads);
    static constexpr DataSet writes = (DataSet{} | ... | Argument<Real, Data&>::writes);
    static StageData<Data...> of(StepData<Real>& step)
    {
        return {{Argument<Real, Data&>::of(step)...}};
    }
};

template <class Real, auto function>
struct Wired;

template <class Real, class... Parameters, void (*function)(Parameters...)>
struct Wired<Real, function> {
    static constexpr DataSet reads = (DataSet{} | ... | Argument<Real, Parameters>::reads);
    static constexpr DataSet writes = (DataSet{} | ... | Argument<Real, Parameters>::writes);
    static void run(StepData<Real>& step) { function(Argument<Real, Parameters>::of(step)...); }
};

}  // namespace detail

/// Wires a function into the step.
template <class Real, auto function>
constexpr Stage<Real> stage(Set<Effect> called_for_by,
                            bool (*chosen_by)(const Settings&) = nullptr,
                            std::vector<PassRow> (*passes)() = nullptr)
{
    using Wired = detail::Wired<Real, function>;
    return {function_name<function>(),
            called_for_by,
            Wired::reads,
            Wired::writes,
            Wired::run,
            chosen_by,
            passes};
}

}  // namespace throng
