// Cache words: numbers and texts as the bytes of a cached file, and back.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

namespace throng {

class WordWriter {
public:
    void word(std::uint64_t value) { append(&value); }
    void number(double value) { append(&value); }
    void text(const std::string& value)
    {
        word(value.size());
        bytes += value;
    }

    std::string bytes;

private:
    void append(const void* eight) { bytes.append(static_cast<const char*>(eight), 8); }
};

/// Once it has run out of bytes everything it reads is 0 and `good` is false.
class WordReader {
public:
    explicit WordReader(std::string_view bytes) : rest_(bytes) { }
    std::uint64_t word() { return take<std::uint64_t>(); }
    double number() { return take<double>(); }
    /// A count of things of so many bytes, no more than there can be.
    std::size_t count(std::size_t bytes_each)
    {
        const std::uint64_t value = word();
        if (value > rest_.size() / bytes_each) good = false;
        return good ? static_cast<std::size_t>(value) : 0;
    }
    std::string text()
    {
        const std::size_t size = count(1);
        std::string value(rest_.substr(0, size));
        rest_.remove_prefix(size);
        return value;
    }
    bool at_end() const { return good && rest_.empty(); }

    bool good = true;

private:
    template <class Word>
    Word take()
    {
        Word value{};
        if (rest_.size() < sizeof value) good = false;
        if (!good) return value;
        std::memcpy(&value, rest_.data(), sizeof value);
        rest_.remove_prefix(sizeof value);
        return value;
    }

    std::string_view rest_;
};

/// Keeps them as a cached file (disk_cache.hpp). Answers what went wrong, or nothing.
std::string write_cached_words(const std::filesystem::path& path, const WordWriter& words);

}  // namespace throng
