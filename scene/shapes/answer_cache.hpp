// Answer cache: what took long to make of a stated shape, on its way from a file into a world.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>

namespace throng {

/// Answers by a hash of what they were made of, until they are forgotten or crowded out, the oldest
/// first. Any number of threads may ask.
template <class Answer>
class AnswerCache {
public:
    /// most  the sizes of all that is kept, together
    explicit AnswerCache(std::size_t most) : most_(most) { }

    /// The answer for a key, made where it is not kept.
    template <class Make>
    std::shared_ptr<const Answer> get(std::uint64_t key, std::size_t size, Make make)
    {
        if (auto known = find(key)) return known;
        std::shared_ptr<const Answer> made = make();
        keep(key, size, made);
        return made;
    }

    void forget(std::uint64_t key)
    {
        const std::lock_guard lock(guard_);
        if (const auto at = place_of(key); at != kept_.end()) erase(at);
    }

private:
    struct Kept {
        std::uint64_t key;
        std::size_t size;
        std::shared_ptr<const Answer> answer;
    };

    std::shared_ptr<const Answer> find(std::uint64_t key)
    {
        const std::lock_guard lock(guard_);
        const auto at = place_of(key);
        return at == kept_.end() ? nullptr : at->answer;
    }
    void keep(std::uint64_t key, std::size_t size, std::shared_ptr<const Answer> answer)
    {
        const std::lock_guard lock(guard_);
        if (size > most_ || place_of(key) != kept_.end()) return;
        kept_.push_back({key, size, std::move(answer)});
        size_ += size;
        while (size_ > most_) erase(kept_.begin());
    }
    typename std::deque<Kept>::iterator place_of(std::uint64_t key)
    {
        return std::find_if(kept_.begin(), kept_.end(),
                            [&](const Kept& one) { return one.key == key; });
    }
    void erase(typename std::deque<Kept>::iterator at)
    {
        size_ -= at->size;
        kept_.erase(at);
    }

    std::mutex guard_;
    std::deque<Kept> kept_;
    std::size_t size_ = 0, most_;
};

}  // namespace throng
