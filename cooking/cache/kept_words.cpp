#include "cooking/cache/kept_words.hpp"

#include "cooking/cache/kept_file.hpp"

#include <fstream>

namespace throng {

std::string keep_words(const std::filesystem::path& path, const WordWriter& words)
{
    return keep_file(path, [&](const std::filesystem::path& part) {
        std::ofstream file(part, std::ios::binary);
        file.write(words.bytes.data(), static_cast<std::streamsize>(words.bytes.size()));
        file.close();
        return file.fail() ? part.string() + ": cannot be written" : std::string();
    });
}

}  // namespace throng
