// File checksum: a checksum behind a file of throng's own, by which damage is known before anything
// is made of it. Other tools read the file without it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace throng {

/// How many bytes a checksum takes.
inline constexpr std::size_t kChecksumBytes = 16;

enum class ChecksumState : std::uint8_t { none, good, broken };

/// Whether the bytes of a file end with a checksum, and whether it is theirs.
ChecksumState check_checksum(std::string_view bytes);

/// Puts a checksum behind a file that has none. False where it cannot be read or written.
bool append_checksum(const std::filesystem::path& path);

/// All of a file; nothing where it cannot be read or is none, as a folder or a pipe.
std::string bytes_of_file(const std::filesystem::path& path);

}  // namespace throng
