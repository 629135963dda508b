// Run file: the run, written while it runs, in HDF5.
#include "throng/run_file.hpp"

#include "throng/dials.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <hdf5.h>
#include <sys/resource.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace throng {
namespace {

using Clock = std::chrono::steady_clock;

// The innermost reason that HDF5 knows for its last failure.
herr_t take_reason(unsigned depth, const H5E_error2_t* error, void* reason)
{
    if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(reason) = error->desc;
    return 0;
}

/// Hands the answer of an HDF5 call on, unless it is a failure.
template <class Answer>
Answer checked(Answer answer, const char* what)
{
    if (answer >= 0) return answer;
    std::string reason;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_reason, &reason);
    // Of a long account of a failed call, what the system said.
    constexpr std::string_view kSystem = "error message = '";
    if (const auto at = reason.find(kSystem); at != std::string::npos) {
        reason.erase(0, at + kSystem.size());
        reason.erase(std::min(reason.find('\''), reason.size()));
    }
    throw RunFileError("cannot write " + std::string(what) + (reason.empty() ? "" : ": ") + reason);
}

/// Something of HDF5's that has to be closed.
class Handle {
public:
    Handle() = default;
    Handle(hid_t id, herr_t (*closing)(hid_t), const char* what)
        : id_(checked(id, what)), close_(closing)
    { }
    ~Handle() { close(); }
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) { }
    Handle& operator=(Handle&& other) noexcept
    {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor)
    herr_t close() { return id_ < 0 ? 0 : close_(std::exchange(id_, -1)); }

private:
    hid_t id_ = -1;
    herr_t (*close_)(hid_t) = nullptr;
};

/// HDF5 prints its failures unless told not to; whoever uses it besides keeps its own ways.
class Silence {
public:
    Silence()
    {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Silence() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

private:
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

Handle new_group(hid_t file, const char* name)
{
    return {H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, name};
}

Handle text_type()
{
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "the type of text");
    checked(H5Tset_size(type, H5T_VARIABLE), "the type of text");
    checked(H5Tset_cset(type, H5T_CSET_UTF8), "the type of text");
    return type;
}

void add_attribute(
    hid_t owner, const char* name, hid_t type, const Handle& space, const void* value)
{
    const Handle attribute(H5Acreate2(owner, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                           name);
    checked(H5Awrite(attribute, type, value), name);
}

void add_text(hid_t owner, const char* name, const std::string& text)
{
    const char* letters = text.c_str();
    add_attribute(owner, name, text_type(), {H5Screate(H5S_SCALAR), H5Sclose, name}, &letters);
}

void add_number(hid_t owner, const char* name, hid_t type, const void* number)
{
    add_attribute(owner, name, type, {H5Screate(H5S_SCALAR), H5Sclose, name}, number);
}

/// A dataset that is written once, whole.
Handle
add_array(hid_t owner, const char* name, hid_t type, std::vector<hsize_t> size, const void* values)
{
    const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr),
                       H5Sclose, name);
    Handle array(H5Dcreate2(owner, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                 H5Dclose, name);
    checked(H5Dwrite(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
    return array;
}

// Kinds of shape, in the order of ShapeDescription::shape, after none.
constexpr const char* kKinds[] = {"none", "sphere", "capsule", "cylinder", "box",
                                  "hull", "plane",  "mesh",    "compound", "voxels"};
static_assert(std::size(kKinds) == 1 + std::variant_size_v<decltype(ShapeDescription::shape)>);

/// What does not change in a run, an entry a body.
struct BodyFacts {
    std::vector<const char*> name;
    std::vector<std::uint8_t> motion, kind;
    std::vector<double> mass, size;
};

Vec3 size_of(const SphereShape& sphere) { return {sphere.radius, 0, 0}; }
Vec3 size_of(const CapsuleShape& capsule) { return {capsule.radius, capsule.half_length, 0}; }
Vec3 size_of(const CylinderShape& can) { return {can.radius, can.half_length, 0}; }
Vec3 size_of(const BoxShape& box) { return box.half_extents; }
template <class Other>
Vec3 size_of(const Other&)
{
    return Vec3::Zero();
}

void add_shape(const Scene& scene, std::uint32_t shape, BodyFacts& facts)
{
    Vec3 size = Vec3::Zero();
    std::size_t kind = 0;
    if (shape != kNone) {
        const auto& described = scene.shapes[shape].shape;
        kind = 1 + described.index();
        size = std::visit([](const auto& known) { return size_of(known); }, described);
    }
    facts.kind.push_back(static_cast<std::uint8_t>(kind));
    facts.size.insert(facts.size.end(), {size.x(), size.y(), size.z()});
}

BodyFacts collect_facts(const Scene& scene, const World& world)
{
    BodyFacts facts;
    for (const BodyDescription& body : scene.bodies) add_shape(scene, body.shape, facts);
    for (const Instances& group : scene.instances)
        for (std::size_t i = 0; i < group.count(); ++i) {
            add_shape(scene, group.common.shape, facts);
            const double* const record = &group.records[i * group.stride()];
            if (group.own_sizes) std::copy(record + 13, record + 16, facts.size.end() - 3);
        }
    for (const BodyId body : world.bodies()) {
        const std::string& name = world.name(body);
        // Nothing at all is stored for a name that is null.
        facts.name.push_back(name.empty() ? nullptr : name.c_str());
        facts.motion.push_back(static_cast<std::uint8_t>(world.motion(body)));
        facts.mass.push_back(world.mass(body));
    }
    return facts;
}

void write_bodies(hid_t file, const Scene& scene, const World& world)
{
    const BodyFacts facts = collect_facts(scene, world);
    if (facts.kind.size() != facts.name.size())
        throw RunFileError("the world is not that of the scene");
    const hsize_t count = facts.name.size();
    const Handle bodies = new_group(file, "bodies");
    add_array(bodies, "name", text_type(), {count}, facts.name.data());
    const Handle motion =
        add_array(bodies, "motion", H5T_NATIVE_UINT8, {count}, facts.motion.data());
    add_text(motion, "meaning", "0 static, 1 kinematic, 2 dynamic");
    const Handle kind =
        add_array(bodies, "shape_kind", H5T_NATIVE_UINT8, {count}, facts.kind.data());
    const hsize_t kinds = std::size(kKinds);
    add_attribute(kind, "kinds", text_type(),
                  {H5Screate_simple(1, &kinds, nullptr), H5Sclose, "kinds"}, kKinds);
    add_text(add_array(bodies, "mass", H5T_NATIVE_DOUBLE, {count}, facts.mass.data()), "unit",
             "kg");
    add_text(add_array(bodies, "size", H5T_NATIVE_DOUBLE, {count, 3}, facts.size.data()), "unit",
             "m");
}

void write_effects_of(hid_t file, std::span<const EffectEntry> effects)
{
    const Handle group = new_group(file, "effects");
    const auto add = [&](const char* name, hid_t type, const auto& of) {
        std::vector<std::decay_t<decltype(of(effects.front()))>> values;
        for (const EffectEntry& entry : effects) values.push_back(of(entry));
        return add_array(group, name, type, {effects.size()}, values.data());
    };
    std::vector<std::string> names;
    for (const EffectEntry& entry : effects) names.emplace_back(name_of(entry.effect));
    const auto place = [&](const EffectEntry& entry) {
        return static_cast<std::size_t>(&entry - effects.data());
    };
    add("name", text_type(), [&](const EffectEntry& e) { return names[place(e)].c_str(); });
    add("on", H5T_NATIVE_UINT8, [](const EffectEntry& e) { return std::uint8_t{e.on}; });
    add("first", text_type(),
        [](const EffectEntry& e) { return e.first.empty() ? nullptr : e.first.c_str(); });
    add("callers", H5T_NATIVE_UINT64,
        [](const EffectEntry& e) { return std::uint64_t{e.callers}; });
    add_text(add("ms", H5T_NATIVE_DOUBLE, [](const EffectEntry& e) { return e.ms; }), "unit", "ms");
    add("rows", H5T_NATIVE_UINT64, [](const EffectEntry& e) { return std::uint64_t{e.rows}; });
    add("bytes", H5T_NATIVE_UINT64, [](const EffectEntry& e) { return std::uint64_t{e.bytes}; });
    add("neglected", H5T_NATIVE_UINT64,
        [](const EffectEntry& e) { return std::uint64_t{e.neglected}; });
    add("bound", H5T_NATIVE_DOUBLE, [](const EffectEntry& e) { return e.bound; });
}

void write_facts(hid_t file, const World& world, const RunFacts& facts)
{
    add_text(file, "throng", facts.version);
    add_text(file, "scene", facts.scene);
    add_number(file, "seed", H5T_NATIVE_UINT64, &facts.seed);
    add_number(file, "every", H5T_NATIVE_INT64, &facts.every);
    add_number(file, "dt", H5T_NATIVE_DOUBLE, &world.settings().dt);
    const Vec3 gravity = world.gravity();
    const hsize_t three = 3;
    add_attribute(file, "gravity", H5T_NATIVE_DOUBLE,
                  {H5Screate_simple(1, &three, nullptr), H5Sclose, "gravity"}, gravity.data());
    const Handle group = new_group(file, "dials");
    for (const Dial& dial : dials())
        add_text(group, std::string(dial.name).c_str(), dial.get(world.settings()));
}

/// A dataset with a slice for each frame; slices wait here until a chunk of them is full.
template <class Number>
class Track {
public:
    /// slice: bodies, and numbers for each; empty for one number a frame.
    Track(hid_t owner,
          const char* name,
          const char* unit,
          hid_t type,
          std::vector<hsize_t> slice,
          std::vector<hsize_t> chunk)
        : name_(name), type_(type), slice_(std::move(slice))
    {
        std::vector<hsize_t> none = {0}, most = {H5S_UNLIMITED};
        none.insert(none.end(), slice_.begin(), slice_.end());
        most.insert(most.end(), slice_.begin(), slice_.end());
        const int rank = static_cast<int>(none.size());
        const Handle space(H5Screate_simple(rank, none.data(), most.data()), H5Sclose, name);
        const Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
        checked(H5Pset_chunk(how, rank, chunk.data()), name);
        checked(H5Pset_shuffle(how), name);
        // Higher levels gain some percent on such numbers and take several times as long.
        checked(H5Pset_deflate(how, 1), name);
        // Chunks come whole or in turn, so that one in the cache is enough; there has to be room on
        // the disk for all that it holds.
        const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, name);
        std::size_t bytes = H5Tget_size(type);
        for (const hsize_t side : chunk) bytes *= side;
        checked(H5Pset_chunk_cache(access, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, bytes, 1), name);
        set_ = {H5Dcreate2(owner, name, type, space, H5P_DEFAULT, how, access), H5Dclose, name};
        add_text(set_, "unit", unit);
    }

    std::vector<Number> waiting;

    /// Writes the slices that wait after the first `frames`.
    void write(hsize_t frames, hsize_t more)
    {
        std::vector<hsize_t> size = {frames + more}, from = {frames}, count = {more};
        size.insert(size.end(), slice_.begin(), slice_.end());
        from.insert(from.end(), slice_.size(), 0);
        count.insert(count.end(), slice_.begin(), slice_.end());
        checked(H5Dset_extent(set_, size.data()), name_);
        const Handle there(H5Dget_space(set_), H5Sclose, name_);
        checked(
            H5Sselect_hyperslab(there, H5S_SELECT_SET, from.data(), nullptr, count.data(), nullptr),
            name_);
        const int rank = static_cast<int>(count.size());
        const Handle here(H5Screate_simple(rank, count.data(), nullptr), H5Sclose, name_);
        checked(H5Dwrite(set_, type_, here, there, H5P_DEFAULT, waiting.data()), name_);
        waiting.clear();
    }

private:
    const char* name_;
    hid_t type_;
    std::vector<hsize_t> slice_;
    Handle set_;
};

/// How the frames are cut into chunks: each a part of one big frame or some small ones.
struct Cut {
    // About 400 kB of positions: small enough for HDF5's cache, big enough to compress well.
    static constexpr hsize_t kBodies = 16384;
    hsize_t bodies, frames;

    explicit Cut(hsize_t count)
        : bodies(std::clamp<hsize_t>(count, 1, kBodies)),
          frames(std::clamp<hsize_t>(kBodies / std::max<hsize_t>(count, 1), 1, 64))
    { }
};

struct Frames {
    Frames(hid_t owner, hsize_t count)
        : cut(count),
          position(
              owner, "position", "m", H5T_NATIVE_DOUBLE, {count, 3}, {cut.frames, cut.bodies, 3}),
          orientation(
              owner, "orientation", "1", H5T_NATIVE_FLOAT, {count, 4}, {cut.frames, cut.bodies, 4}),
          velocity(
              owner, "velocity", "m/s", H5T_NATIVE_FLOAT, {count, 3}, {cut.frames, cut.bodies, 3}),
          angular_velocity(owner,
                           "angular_velocity",
                           "rad/s",
                           H5T_NATIVE_FLOAT,
                           {count, 3},
                           {cut.frames, cut.bodies, 3}),
          error(owner, "error", "m", H5T_NATIVE_DOUBLE, {}, {1024}),
          greatest_error(owner, "greatest_error", "m", H5T_NATIVE_DOUBLE, {}, {1024}),
          worst_body(owner, "worst_body", "1", H5T_NATIVE_UINT32, {}, {1024}),
          step(owner, "step", "1", H5T_NATIVE_UINT64, {}, {1024}),
          time(owner, "time", "s", H5T_NATIVE_DOUBLE, {}, {1024})
    { }

    void add(const World& world, const std::vector<BodyId>& bodies, const StepError& told)
    {
        const auto append = [](const auto& from, auto& to) {
            using Number = typename std::remove_reference_t<decltype(to)>::value_type;
            for (int i = 0; i < from.size(); ++i) to.push_back(static_cast<Number>(from[i]));
        };
        for (const BodyId body : bodies) {
            const Pose pose = world.pose(body);
            const Quat& q = pose.orientation;
            append(pose.position, position.waiting);
            append(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()), orientation.waiting);
            append(world.velocity(body), velocity.waiting);
            append(world.angular_velocity(body), angular_velocity.waiting);
        }
        error.waiting.push_back(told.rms);
        greatest_error.waiting.push_back(told.greatest);
        const auto worst = std::find(bodies.begin(), bodies.end(), told.worst);
        worst_body.waiting.push_back(
            worst == bodies.end() ? kNone : static_cast<std::uint32_t>(worst - bodies.begin()));
        const std::uint64_t steps = world.report().step;
        step.waiting.push_back(steps);
        time.waiting.push_back(static_cast<double>(steps) * world.settings().dt);
    }

    hsize_t waiting() const { return time.waiting.size(); }
    bool chunk_is_full() const { return (written + waiting()) % cut.frames == 0; }

    void write()
    {
        const hsize_t more = waiting();
        position.write(written, more);
        orientation.write(written, more);
        velocity.write(written, more);
        angular_velocity.write(written, more);
        error.write(written, more);
        greatest_error.write(written, more);
        worst_body.write(written, more);
        step.write(written, more);
        time.write(written, more);
        written += more;
    }

    Cut cut;
    Track<double> position;
    Track<float> orientation, velocity, angular_velocity;
    Track<double> error, greatest_error;
    Track<std::uint32_t> worst_body;
    Track<std::uint64_t> step;
    Track<double> time;
    hsize_t written = 0;
};

/// Room on the disk behind what a file holds. Asked for before HDF5 writes anything: what it has
/// once failed to write it forgets, and chunks that were whole with it.
class DiskSpace {
public:
    explicit DiskSpace(const std::string& path)
    {
        if (std::filesystem::is_regular_file(path))
            file_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    }
    ~DiskSpace()
    {
        if (file_ >= 0) ::close(file_);
    }
    DiskSpace(const DiskSpace&) = delete;
    DiskSpace& operator=(const DiskSpace&) = delete;

    /// Throws RunFileError where so many bytes cannot be added to so many that there are. Where the
    /// file system cannot keep room there is no promise.
    void keep(std::size_t bytes, std::size_t more) const
    {
        if (file_ < 0) return;
        struct rlimit limit = {};
        if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && bytes + more > limit.rlim_cur) fail(EFBIG);
        const bool kept = ::fallocate(file_, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(bytes),
                                      static_cast<off_t>(more))
            == 0;
        if (!kept && (errno == ENOSPC || errno == EDQUOT || errno == EFBIG)) fail(errno);
    }
    /// Gives back what is behind so many bytes.
    void give_back(std::size_t bytes) const
    {
        // Where it does not, the file is only larger on the disk than it says.
        if (file_ >= 0 && ::ftruncate(file_, static_cast<off_t>(bytes)) != 0) return;
    }

private:
    [[noreturn]] static void fail(int error)
    {
        throw RunFileError("cannot write the frames: " + std::generic_category().message(error));
    }

    int file_ = -1;
};

// What writing frames may add to the file at the most: a chunk of each track, old ones that come
// out of the cache, and HDF5's own tables.
std::size_t most_bytes(const Cut& cut, std::size_t bodies)
{
    constexpr std::size_t kTables = 512 << 10;
    const std::size_t chunks = (bodies + cut.bodies - 1) / cut.bodies;
    const auto numbers = static_cast<double>(chunks * cut.bodies * cut.frames);
    return kTables + 2 * static_cast<std::size_t>(numbers * RunFile::kBytesPerBody);
}

Handle create_file(const std::string& path)
{
    return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, "the file"};
}

}  // namespace

struct RunFile::Inside {
    Inside(const std::string& path, const Scene& scene, const World& world, const RunFacts& facts)
        : file(create_file(path)), disk_space(path), bodies(world.bodies())
    {
        write_facts(file, world, facts);
        write_bodies(file, scene, world);
        frames = std::make_unique<Frames>(new_group(file, "frames"), bodies.size());
        flush();
    }

    void add(const World& world, const StepError& error)
    {
        frames->add(world, bodies, error);
        const bool stale = Clock::now() - flushed > std::chrono::seconds(1);
        if (frames->chunk_is_full() || stale) write();
        if (stale) flush();
    }

    void write() const
    {
        disk_space.keep(size(), most_bytes(frames->cut, bodies.size()));
        frames->write();
    }

    void flush()
    {
        checked(H5Fflush(file, H5F_SCOPE_GLOBAL), "the file");
        flushed = Clock::now();
    }

    std::size_t size() const
    {
        hsize_t bytes = 0;
        checked(H5Fget_filesize(file, &bytes), "the file");
        return bytes;
    }

    Handle file;
    DiskSpace disk_space;
    std::vector<BodyId> bodies;
    std::unique_ptr<Frames> frames;  // closed before the file
    Clock::time_point flushed;
    bool failed = false;
};

RunFile::RunFile(const std::string& path,
                 const Scene& scene,
                 const World& world,
                 const RunFacts& facts)
{
    // Files are closed here. At exit HDF5 would only try a full disk again, many times and aloud.
    H5dont_atexit();
    const Silence silence;
    inside_ = std::make_unique<Inside>(path, scene, world, facts);
}

RunFile::~RunFile()
{
    const Silence silence;
    inside_.reset();
}

RunFile::RunFile(RunFile&&) noexcept = default;
RunFile& RunFile::operator=(RunFile&&) noexcept = default;

void RunFile::write_frame(const World& world, const StepError& error)
{
    if (!inside_ || inside_->failed) throw RunFileError("cannot write a frame: the file is closed");
    const Silence silence;
    try {
        inside_->add(world, error);
    } catch (const RunFileError&) {
        inside_->failed = true;
        throw;
    }
}

void RunFile::write_effects(std::span<const EffectEntry> effects)
{
    if (!inside_ || inside_->failed) throw RunFileError("cannot add effects: the file is closed");
    const Silence silence;
    constexpr std::size_t kMost = std::size_t{1} << 16;  // bytes
    inside_->disk_space.keep(inside_->size(), kMost);
    write_effects_of(inside_->file, effects);
}

void RunFile::close()
{
    if (!inside_) return;
    const Silence silence;
    std::exception_ptr trouble;
    try {
        if (!inside_->failed && inside_->frames->waiting() > 0) inside_->write();
    } catch (const RunFileError&) {
        trouble = std::current_exception();
    }
    inside_->flush();
    whole_frames_ = inside_->frames->written;
    inside_->frames.reset();
    const std::size_t bytes = inside_->size();
    checked(inside_->file.close(), "the file");
    inside_->disk_space.give_back(bytes);
    inside_.reset();
    if (trouble) std::rethrow_exception(trouble);
}

std::size_t RunFile::whole_frames() const
{
    return inside_ ? inside_->frames->written : whole_frames_;
}

}  // namespace throng
