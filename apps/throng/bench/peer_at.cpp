#include "apps/throng/bench/peer_at.hpp"

#include "apps/peers/adapters/adapter.hpp"
#include "apps/throng/bench/peers.hpp"
#include "apps/throng/options.hpp"
#include "apps/throng/run_program.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <array>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>

namespace throng::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEngines[] = {"box3d", "jolt", "physx"};
constexpr std::size_t kWords = 512;  // of what an adapter says, bytes

// A folder of its own, gone with it.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string name = (fs::temp_directory_path() / "throng-adapter-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr)
            throw BadInput("--peer-at: cannot make a folder in "
                           + fs::temp_directory_path().string()
                           + " to build the adapter in; TMPDIR says where else to");
        path_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code trouble;
        fs::remove_all(path_, trouble);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

// The lines of a log that tell of trouble, else its last.
std::string trouble_of(const fs::path& log)
{
    std::ifstream in(log);
    std::vector<std::string> lines, telling;
    for (std::string line; std::getline(in, line);) {
        lines.push_back(line);
        const bool tells = line.find("rror") != std::string::npos
            || line.find("fPIC") != std::string::npos || line.starts_with("  no ");
        if (tells) telling.push_back(line);
    }
    constexpr std::size_t kMost = 12;
    if (telling.empty()) telling = lines;
    if (telling.size() > kMost) telling.resize(kMost);
    std::string text;
    for (const std::string& line : telling) text += "\n  " + line;
    if (text.find("fPIC") != std::string::npos)
        text += "\n  build the engine with -DCMAKE_POSITION_INDEPENDENT_CODE=ON";
    return text.empty() ? " cmake did not run; is it installed?" : text;
}

// Beside the command, or where it is installed.
fs::path adapter_sources()
{
    std::error_code trouble;
    const fs::path self = fs::read_symlink("/proc/self/exe", trouble).parent_path();
    for (const char* const place : {"adapters", "../share/throng/adapters"}) {
        const fs::path sources = self / place / "apps/peers/adapters";
        if (fs::exists(sources / "CMakeLists.txt", trouble)) return sources;
    }
    throw BadInput("--peer-at: the sources of the adapters are not beside the command");
}

// Its functions; they stay loaded for as long as the process.
const adapters::Door& build(const PeerAt& peer)
{
    const fs::path sources = adapter_sources();
    const TemporaryFolder folder;
    const fs::path log = folder.path() / "log.txt";
    const std::string into = (folder.path() / "build").string();
    std::cerr << "note: building the adapter for " << peer.name << " in " << peer.directory
              << std::endl;
    const bool built =
        run_program({"cmake", "-S", sources.string(), "-B", into, "-DTHRONG_PEER=" + peer.name,
                     "-DTHRONG_PEER_AT=" + peer.directory},
                    log)
        && run_program({"cmake", "--build", into, "--parallel"}, log);
    if (!built)
        throw BadInput("--peer-at: the adapter for " + peer.name
                       + " cannot be built:" + trouble_of(log));
    void* const module = ::dlopen((into + "/adapter.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const door = module == nullptr ? nullptr : ::dlsym(module, adapters::kAdapterSymbol);
    if (door == nullptr)
        throw BadInput("--peer-at: the adapter for " + peer.name
                       + " cannot be loaded: " + ::dlerror());  // NOLINT(concurrency-mt-unsafe)
    return *reinterpret_cast<adapters::AdapterFunction>(door)();
}

void copy(const Vec3& from, double* to) { std::copy_n(from.data(), 3, to); }
adapters::Pose plain(const Pose& pose)
{
    adapters::Pose to = {};
    copy(pose.position, to.position);
    std::copy_n(pose.orientation.coeffs().data(), 4, to.orientation);
    return to;
}

adapters::ShapeKind plain(ShapeKind kind, const std::string& name)
{
    switch (kind) {
    case ShapeKind::sphere:
        return adapters::ShapeKind::sphere;
    case ShapeKind::capsule:
        return adapters::ShapeKind::capsule;
    case ShapeKind::cylinder:
        return adapters::ShapeKind::cylinder;
    case ShapeKind::box:
        return adapters::ShapeKind::box;
    case ShapeKind::hull:
        return adapters::ShapeKind::hull;
    case ShapeKind::plane:
        return adapters::ShapeKind::plane;
    case ShapeKind::mesh:
        return adapters::ShapeKind::mesh;
    case ShapeKind::triangle:
    case ShapeKind::solid:
        break;
    }
    throw std::invalid_argument(name + ": is not given such a shape here");
}

adapters::Body plain(const PeerBody& body)
{
    adapters::Body to = {};
    to.motion = body.motion == Motion::static_ ? adapters::Motion::static_
        : body.motion == Motion::kinematic     ? adapters::Motion::kinematic
                                               : adapters::Motion::dynamic;
    to.mass = body.mass;
    const Sym3& i = body.inertia;
    const double inertia[] = {i.xx, i.yy, i.zz, i.xy, i.xz, i.yz};
    std::copy(std::begin(inertia), std::end(inertia), to.inertia);
    to.pose = plain(body.pose);
    copy(body.velocity, to.velocity);
    copy(body.angular_velocity, to.angular_velocity);
    to.friction = body.friction;
    to.restitution = body.restitution;
    to.lock_rotation = body.lock_rotation;
    copy(body.force, to.force);
    for (std::size_t k = 0; k < 3; ++k)
        to.drive[k] = body.drive[k].value_or(std::numeric_limits<double>::quiet_NaN());
    to.first_shape = body.first_shape;
    to.shapes = body.shapes;
    return to;
}

// A scene as adapters take it.
class PlainScene {
public:
    PlainScene(const PeerScene& scene, const std::string& name)
    {
        copy(scene.gravity, plain_.gravity);
        for (const PeerShape& shape : scene.shapes) {
            adapters::Shape to = {
                plain(shape.kind, name), shape.index, {}, plain(shape.local), shape.is_centered()};
            copy(shape.size, to.size);
            shapes_.push_back(to);
        }
        std::transform(scene.bodies.begin(), scene.bodies.end(), std::back_inserter(bodies_),
                       [](const PeerBody& body) { return plain(body); });
        add(scene.hulls, hulls_);
        add(scene.meshes, meshes_);
        plain_.hulls = hulls_.data();
        plain_.hull_count = hulls_.size();
        plain_.meshes = meshes_.data();
        plain_.mesh_count = meshes_.size();
        plain_.shapes = shapes_.data();
        plain_.shape_count = shapes_.size();
        plain_.bodies = bodies_.data();
        plain_.body_count = bodies_.size();
    }

    const adapters::Scene& view() const { return plain_; }

private:
    void add(const std::vector<PeerTriangles>& from, std::vector<adapters::Triangles>& to)
    {
        for (const PeerTriangles& one : from) {
            std::vector<double>& vertices = vertices_.emplace_back();
            for (const Vec3& vertex : one.vertices)
                vertices.insert(vertices.end(), vertex.data(), vertex.data() + 3);
            std::vector<std::uint32_t>& corners = corners_.emplace_back();
            for (const auto& triangle : one.triangles)
                corners.insert(corners.end(), triangle.begin(), triangle.end());
            to.push_back(
                {vertices.data(), one.vertices.size(), corners.data(), one.triangles.size()});
        }
    }

    adapters::Scene plain_ = {};
    std::vector<adapters::Triangles> hulls_, meshes_;
    std::vector<adapters::Shape> shapes_;
    std::vector<adapters::Body> bodies_;
    std::vector<std::vector<double>> vertices_;
    std::vector<std::vector<std::uint32_t>> corners_;
};

class AdaptedPeer final : public perf::Peer {
public:
    AdaptedPeer(const adapters::Door& door,
                const std::string& name,
                int threads,
                const PeerScene& scene)
        : door_(door), plain_(scene, name)
    {
        std::array<char, kWords> why = {};
        engine_ = door_.make(&plain_.view(), threads, why.data(), why.size());
        if (engine_ == nullptr) throw std::invalid_argument(name + ": " + why.data());
    }
    ~AdaptedPeer() override { door_.destroy(engine_); }
    AdaptedPeer(const AdaptedPeer&) = delete;
    AdaptedPeer& operator=(const AdaptedPeer&) = delete;

    void step(double dt) override { door_.step(engine_, dt); }
    std::size_t contacts() const override { return door_.contacts(engine_); }

    std::vector<PeerState> states() const override
    {
        std::vector<adapters::State> plain(plain_.view().body_count);
        door_.read(engine_, plain.data());
        std::vector<PeerState> states;
        states.reserve(plain.size());
        for (const adapters::State& state : plain) {
            const double* const q = state.pose.orientation;
            states.push_back({{Vec3(state.pose.position), Quat(q[3], q[0], q[1], q[2])},
                              Vec3(state.velocity),
                              Vec3(state.angular_velocity)});
        }
        return states;
    }

    std::string settings() const override
    {
        std::array<char, kWords> text = {};
        door_.settings(engine_, text.data(), text.size());
        return text.data();
    }

private:
    const adapters::Door& door_;
    PlainScene plain_;
    adapters::Engine* engine_ = nullptr;
};

}  // namespace

PeerAt peer_at(std::string_view text)
{
    const std::size_t equals = text.find('=');
    const std::string_view name = text.substr(0, equals);
    if (equals == std::string_view::npos
        || std::find(std::begin(kEngines), std::end(kEngines), name) == std::end(kEngines))
        throw BadInput("--peer-at: wanted NAME=DIR, the name " + either_of(kEngines) + ", not "
                       + in_quotes(text));
    const fs::path directory(text.substr(equals + 1));
    std::error_code trouble;
    if (!fs::is_directory(directory, trouble))
        throw BadInput("--peer-at: there is no folder " + in_quotes(directory.string()));
    return {std::string(name), fs::canonical(directory).string()};
}

std::vector<EngineKind> engines_at(const PeerAt& peer, const std::vector<int>& threads)
{
    const adapters::Door& door = build(peer);
    std::vector<EngineKind> kinds;
    kinds.reserve(threads.size());
    for (const int count : threads)
        kinds.push_back(
            peer_kind(peer.name, count, [&door, name = peer.name, count](const PeerScene& scene) {
                return std::make_unique<AdaptedPeer>(door, name, count, scene);
            }));
    return kinds;
}

}  // namespace throng::bench
