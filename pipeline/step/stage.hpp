// Stage: how a function becomes a row of the step table.
//
// What a stage reads and writes is read off its signature: a const parameter is read, any other is
// written (and may be read). So the declaration cannot drift from what the stage can reach.
#pragma once

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

/// A row of the step table.
template <class Real>
struct Stage {
    std::string_view name;
    Set<Effect> called_for_by;
    DataSet reads;
    DataSet writes;
    void (*run)(StepData<Real>&);

    /// True when this stage has to wait for an earlier row of the table.
    constexpr bool waits_for(const Stage& earlier) const
    {
        return earlier.writes.meets(reads | writes) || earlier.reads.meets(writes);
    }
};

namespace detail {

template <class Real, auto function>
struct Wired;

template <class Real, class... Parameters, void (*function)(Parameters...)>
struct Wired<Real, function> {
    template <class Parameter>
    static constexpr bool only_read = std::is_const_v<std::remove_reference_t<Parameter>>;
    template <class Parameter>
    static constexpr DataSet data = data_set<Real, std::remove_cvref_t<Parameter>>;

    static constexpr DataSet reads =
        (DataSet{} | ... | (only_read<Parameters> ? data<Parameters> : DataSet{}));
    static constexpr DataSet writes =
        (DataSet{} | ... | (only_read<Parameters> ? DataSet{} : data<Parameters>));
    static void run(StepData<Real>& step)
    {
        function(std::get<std::remove_cvref_t<Parameters>>(step)...);
    }
};

}  // namespace detail

/// Wires a function into the step.
template <class Real, auto function>
constexpr Stage<Real> stage(std::string_view name, Set<Effect> called_for_by)
{
    using Wired = detail::Wired<Real, function>;
    return {name, called_for_by, Wired::reads, Wired::writes, Wired::run};
}

}  // namespace throng
