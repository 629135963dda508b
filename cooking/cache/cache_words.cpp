#include "cooking/cache/cache_words.hpp"

#include "cooking/cache/disk_cache.hpp"

#include <fstream>

namespace throng {

std::string write_cached_words(const std::filesystem::path& path, const WordWriter& words)
{
    return write_cached(path, [&](const std::filesystem::path& part) {
        std::ofstream file(part, std::ios::binary);
        file.write(words.bytes.data(), static_cast<std::streamsize>(words.bytes.size()));
        file.close();
        return file.fail() ? part.string() + ": cannot be written" : std::string();
    });
}

}  // namespace throng
