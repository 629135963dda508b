#include "cooking/cache/file_checksum.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace throng {
namespace {

// Of files with this kind of checksum: "thgifld2".
constexpr std::uint64_t kMark = 0x32646c6669676874;

std::uint64_t checksum(const char* bytes, std::size_t size) { return XXH3_64bits(bytes, size); }

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
