#include "cooking/cache/file_checksum.hpp"

#include "kernels/math/hash.hpp"

#include <array>
#include <cstring>
#include <fstream>

namespace throng {
namespace {

constexpr std::uint64_t kMark = 0x31646c6669676874;

// Four chains side by side: one alone would take longer than reading the file.
std::uint64_t checksum(const char* bytes, std::size_t size)
{
    std::array<Hash, 4> chains;
    std::size_t at = 0;
    for (; at + 32 <= size; at += 32) {
        std::array<std::uint64_t, 4> words;
        std::memcpy(words.data(), bytes + at, 32);
        for (std::size_t k = 0; k < 4; ++k) chains[k].add(words[k]);
    }
    Hash all;
    for (const Hash& chain : chains) all.add(chain.value());
    for (; at < size; ++at) all.add(std::uint64_t{static_cast<unsigned char>(bytes[at])});
    all.add(std::uint64_t{size});
    return all.value();
}

}  // namespace

ChecksumState check_checksum(std::string_view bytes)
{
    if (bytes.size() <= kChecksumBytes) return ChecksumState::none;
    std::array<std::uint64_t, 2> trailer;
    const std::size_t size = bytes.size() - kChecksumBytes;
    std::memcpy(trailer.data(), bytes.data() + size, kChecksumBytes);
    if (trailer[0] != kMark) return ChecksumState::none;
    return trailer[1] == checksum(bytes.data(), size) ? ChecksumState::good : ChecksumState::broken;
}

bool append_checksum(const std::filesystem::path& path)
{
    const std::string bytes = bytes_of_file(path);
    if (bytes.empty()) return false;
    const std::array<std::uint64_t, 2> trailer{kMark, checksum(bytes.data(), bytes.size())};
    std::array<char, kChecksumBytes> written;
    std::memcpy(written.data(), trailer.data(), kChecksumBytes);
    std::ofstream file(path, std::ios::binary | std::ios::app);
    file.write(written.data(), kChecksumBytes);
    file.close();
    return !file.fail();
}

std::string bytes_of_file(const std::filesystem::path& path)
{
    // A pipe would be waited for, and a folder has no end that could be told.
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return {};
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) return {};
    const std::streamoff size = file.tellg();
    if (size <= 0) return {};
    std::string bytes(static_cast<std::size_t>(size), '\0');
    file.seekg(0);
    file.read(bytes.data(), size);
    return file ? bytes : std::string();
}

}  // namespace throng
