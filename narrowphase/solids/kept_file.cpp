#include "narrowphase/solids/kept_file.hpp"

#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>

namespace throng {
namespace {

namespace fs = std::filesystem;

// The seal, behind what other tools read without it: a word of ours and the checksum. Read in the
// wrong order of bytes the word is another.
constexpr std::uint64_t kMark = 0x31646c6669676874;
constexpr std::size_t kSeal = 16;

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

std::string bytes_of(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) return {};
    const std::streamoff size = file.tellg();
    if (size <= 0) return {};
    std::string bytes(static_cast<std::size_t>(size), '\0');
    file.seekg(0);
    file.read(bytes.data(), size);
    return file ? bytes : std::string();
}

bool seal(const fs::path& path)
{
    const std::string bytes = bytes_of(path);
    if (bytes.empty()) return false;
    const std::array<std::uint64_t, 2> seal{kMark, checksum(bytes.data(), bytes.size())};
    std::array<char, kSeal> written;
    std::memcpy(written.data(), seal.data(), kSeal);
    std::ofstream file(path, std::ios::binary | std::ios::app);
    file.write(written.data(), kSeal);
    file.close();
    return !file.fail();
}

}  // namespace

fs::path default_cache_folder()
{
    // Nothing here changes the environment.
    const char* const cache = std::getenv("XDG_CACHE_HOME");  // NOLINT(concurrency-mt-unsafe)
    // A relative one is to be passed over, as its specification has it.
    if (cache != nullptr && fs::path(cache).is_absolute()) return fs::path(cache) / "throng";
    const char* const home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe)
    if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".cache/throng";
    return {};
}

void add_mesh(const Mesh& mesh, Hash& hash)
{
    hash.add(std::uint64_t{mesh.vertices.size()});
    for (const Vec3& vertex : mesh.vertices)
        for (const double x : vertex) hash.add(x);
    for (const auto& [a, b, c] : mesh.triangles) {
        hash.add(std::uint64_t{a} << 32 | b);
        hash.add(std::uint64_t{c});
    }
}

std::string kept_bytes(const fs::path& path)
{
    std::string bytes = bytes_of(path);
    if (bytes.size() <= kSeal) return {};
    const std::size_t size = bytes.size() - kSeal;
    std::array<std::uint64_t, 2> seal;
    std::memcpy(seal.data(), bytes.data() + size, kSeal);
    if (seal[0] != kMark || seal[1] != checksum(bytes.data(), size)) return {};
    bytes.resize(size);
    return bytes;
}

// Under a name of its own first.
std::string keep_file(const fs::path& path,
                      const std::function<std::string(const fs::path&)>& write)
{
    std::error_code failed;
    fs::create_directories(path.parent_path(), failed);
    // Any number will do that no other program draws at the same time.
    std::random_device draw;
    Hash name;
    for (int k = 0; k < 2; ++k) name.add(std::uint64_t{draw()});
    fs::path part = path;
    part.replace_extension("." + name.text() + ".part");
    std::string trouble = write(part);
    if (trouble.empty() && !seal(part)) trouble = part.string() + ": cannot be written";
    if (trouble.empty()) {
        fs::rename(part, path, failed);
        if (failed) trouble = path.string() + ": cannot be written: " + failed.message();
    }
    if (!trouble.empty()) fs::remove(part, failed);
    return trouble;
}

}  // namespace throng
