#include "narrowphase/solids/parts_cache.hpp"

#include "kernels/geometry/hull.hpp"
#include "narrowphase/solids/kept_file.hpp"

#include <cstring>
#include <fstream>
#include <optional>

namespace throng {
namespace {

namespace fs = std::filesystem;

// A change of what is computed or written is another version.
constexpr std::uint64_t kVersion = 2;

class Writer {
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

// Once it has run out of bytes everything it reads is 0 and `good` is false.
class Reader {
public:
    explicit Reader(std::string_view bytes) : rest_(bytes) { }
    std::uint64_t word() { return take<std::uint64_t>(); }
    double number() { return take<double>(); }
    // A count of things of so many bytes, no more than there can be.
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

std::string to_bytes(const ConvexParts& parts, const std::string& key)
{
    Writer out;
    out.text(key);
    for (const double value : {parts.error, parts.outside, parts.uncovered, parts.volume_error})
        out.number(value);
    out.word(parts.remarks.size());
    for (const std::string& remark : parts.remarks) out.text(remark);
    out.word(parts.points.size());
    for (const auto& points : parts.points) {
        out.word(points.size());
        for (const Vec3& point : points)
            for (const double x : point) out.number(x);
    }
    return std::move(out.bytes);
}

std::optional<ConvexParts> from_bytes(std::string_view bytes, const std::string& key)
{
    Reader in(bytes);
    if (in.text() != key) return std::nullopt;
    ConvexParts parts;
    for (double* value : {&parts.error, &parts.outside, &parts.uncovered, &parts.volume_error})
        *value = in.number();
    parts.remarks.resize(in.count(8));
    for (std::string& remark : parts.remarks) remark = in.text();
    parts.points.resize(in.count(8));
    for (auto& points : parts.points) {
        points.resize(in.count(24));
        for (Vec3& point : points)
            for (double& x : point) x = in.number();
        HullResult built = build_hull(points);
        if (!built.trouble.empty()) return std::nullopt;
        parts.hulls.push_back(std::move(built.hull));
    }
    if (!in.at_end() || parts.hulls.empty()) return std::nullopt;
    return parts;
}

std::string write_bytes(const fs::path& path, const std::string& bytes)
{
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    return file.fail() ? path.string() + ": cannot be written" : std::string();
}

}  // namespace

std::string parts_key(const Mesh& mesh, const PartsWanted& wanted)
{
    Hash hash;
    hash.add(kVersion);
    hash.add(static_cast<std::uint64_t>(wanted.max_parts));
    hash.add(wanted.error);
    add_mesh(mesh, hash);
    return hash.text();
}

ConvexParts cached_parts(const Mesh& mesh, const PartsWanted& wanted, const fs::path& folder)
{
    if (folder.empty()) return split_into_parts(mesh, wanted);
    const std::string key = parts_key(mesh, wanted);
    const fs::path path = folder / (key + ".parts");
    if (std::optional<ConvexParts> kept = from_bytes(kept_bytes(path), key))
        return std::move(*kept);
    ConvexParts parts = split_into_parts(mesh, wanted);
    if (!parts.trouble.empty()) return parts;
    const std::string trouble = keep_file(
        path, [&](const fs::path& part) { return write_bytes(part, to_bytes(parts, key)); });
    if (!trouble.empty()) parts.remarks.push_back("not kept for the next run: " + trouble);
    return parts;
}

}  // namespace throng
