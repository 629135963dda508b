#include "pipeline/contacts/known_apart.hpp"

#include "kernels/dynamics/travels.hpp"

#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kAhead = 16;  // pairs: how early memory is asked for

constexpr double kRounding = 1e-7;  // of float, and more

double approach(PairKey key, const Travels& travels)
{
    return travels.approach[first_of(key)] + travels.approach[second_of(key)];
}

// Most pairs are apart and most of those are seen to be so at once: in loops without a branch for
// each. In a large world they would wait for the memory of whoever is second in a pair, so it is
// asked for ahead.
template <class Real>
class Look {
public:
    Look(const Pairs& pairs,
         const Bounds& bounds,
         ConvexContacts<Real>& contacts,
         std::vector<std::uint32_t>& parted,
         std::span<std::uint32_t> near)
        : keys_(pairs.keys), boxes_(bounds.near), contacts_(contacts), parted_(parted), near_(near)
    { }

    std::size_t at_boxes(std::size_t begin, std::size_t end)
    {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            if (i + kAhead < keys_.size())
                __builtin_prefetch(&boxes_[second_of(keys_[i + kAhead])]);
            const bool overlap = boxes_[first_of(keys_[i])].overlaps(boxes_[second_of(keys_[i])]);
            near_[count] = static_cast<std::uint32_t>(i);
            count += overlap ? 1 : 0;
            part_if(!overlap, i);
        }
        return count;
    }

    // Not even what they have come since they were last looked at brings the others within the
    // margin.
    std::size_t at_travels(std::size_t begin, std::size_t end)
    {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            if (i + kAhead < keys_.size())
                __builtin_prefetch(&contacts_.travels.approach[second_of(keys_[i + kAhead])]);
            const bool apart =
                approach(keys_[i], contacts_.travels) < double{contacts_.apart_until[i]};
            near_[count] = static_cast<std::uint32_t>(i);
            count += apart ? 0 : 1;
            part_if(apart, i);
        }
        return count;
    }

    // The first `count` of those that are near, less those whose boxes are apart.
    std::size_t at_boxes_of_near(std::size_t count)
    {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count; ++k) {
            if (k + kAhead < count)
                __builtin_prefetch(&boxes_[second_of(keys_[near_[k + kAhead]])]);
            const std::uint32_t i = near_[k];
            const NearBox &a = boxes_[first_of(keys_[i])], &b = boxes_[second_of(keys_[i])];
            const bool overlap = a.overlaps(b);
            near_[kept] = i;
            kept += overlap ? 1 : 0;
            if (overlap) continue;
            note_apart(keys_[i], separation_between(a, b), contacts_.travels,
                       contacts_.apart_until[i]);
            part_if(true, i);
        }
        return kept;
    }

private:
    void part_if(bool apart, std::size_t i)
    {
        if (apart & (contacts_.of_pair[i].contact != PairState::kApart))
            parted_.push_back(static_cast<std::uint32_t>(i));
    }

    std::span<const PairKey> keys_;
    std::span<const NearBox> boxes_;
    ConvexContacts<Real>& contacts_;
    std::vector<std::uint32_t>& parted_;
    std::span<std::uint32_t> near_;
};

}  // namespace

template <class Real>
std::size_t find_near(const Pairs& pairs,
                      const Bounds& bounds,
                      std::size_t begin,
                      std::size_t end,
                      ConvexContacts<Real>& contacts,
                      std::vector<std::uint32_t>& parted,
                      std::span<std::uint32_t> near)
{
    Look<Real> look(pairs, bounds, contacts, parted, near);
    if (!contacts.recycles) return look.at_boxes(begin, end);
    return look.at_boxes_of_near(look.at_travels(begin, end));
}

void note_apart(PairKey key, double beyond_margin, const Travels& travels, float& apart_until)
{
    const double until = approach(key, travels) + beyond_margin;
    apart_until = static_cast<float>(until - kRounding * std::abs(until));
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template std::size_t find_near<Real>(const Pairs&, const Bounds&, std::size_t, std::size_t,    \
                                         ConvexContacts<Real>&, std::vector<std::uint32_t>&,       \
                                         std::span<std::uint32_t>);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
