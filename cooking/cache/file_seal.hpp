// File seal: a checksum behind a file of throng's own, by which damage is known before anything is
// made of it. Other tools read the file without it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace throng {

/// How many bytes a seal takes.
inline constexpr std::size_t kSealBytes = 16;

enum class Seal : std::uint8_t { none, good, broken };

/// Whether the bytes of a file end with a seal, and whether it is theirs.
Seal seal_of(std::string_view bytes);

/// Puts a seal behind a file that has none. False where it cannot be read or written.
bool seal_file(const std::filesystem::path& path);

/// All of a file; nothing where it cannot be read or is none, as a folder or a pipe.
std::string bytes_of_file(const std::filesystem::path& path);

}  // namespace throng
