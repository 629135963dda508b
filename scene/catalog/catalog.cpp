#include "throng/catalog.hpp"

#include "scene/catalog/recipes.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace throng {

namespace {

// The greatest size keeps a scene to ten million bodies or so, which is what fits in memory.
constexpr int kMost = 10'000'000;

// clang-format off
constexpr CatalogEntry kCatalog[] = {
    // name          default least   most   about
    {"pile",           10000,  1, kMost, "SIZE boxes of all proportions dropped in a container",          make_pile},
    {"spheres",        10000,  1, kMost, "SIZE equal balls dropped in a container",                       make_spheres},
    {"hulls",          10000,  1, kMost, "SIZE stones of 24 corners dropped in a container",              make_hulls},
    {"pyramid",        10000,  1, kMost, "about SIZE cubes in a square pyramid of whole layers",          make_pyramid},
    {"wall",           10000,  1, kMost, "SIZE bricks in one wall",                                       make_wall},
    {"stacks",         10000, 10, kMost, "SIZE cubes in towers of ten",                                   make_stacks},
    {"tumbler",        10000,  1, kMost, "SIZE boxes in a hollow box that turns",                         make_tumbler},
    {"crowd",          10000,  1, kMost, "SIZE people who walk one way or the other among pillars",       make_crowd},
    {"sparse",         10000,  1, kMost, "SIZE boxes in free flight, far apart, without gravity",         make_sparse},
    {"mixed",          10000,  1, kMost, "SIZE balls and boxes from 5 mm to 5 m that slide and roll about", make_mixed},
    {"hills",          10000,  1, 100'000, "SIZE bodies dropped on hills of a hundred triangles for each",  make_hills},
    {"meshes",          1000,  1, kMost, "SIZE bodies of six kinds dropped on a terrain of triangles",    make_meshes},
    {"knots",            100,  1, kMost, "SIZE knots, tori and links of a chain dropped in a container",  make_knots, make_knots_of},
    {"chain",             10,  1, kMost, "a chain of SIZE links that hangs between two fixed ones",       make_chain},
    {"peg",                5,  1, kMost, "SIZE tori dropped over pegs, five over each",                   make_peg},
    {"bolt",               1,  1, kMost, "SIZE bolts that their weight turns down their nuts",            make_bolt},
    {"terrain",          100,  1, kMost, "SIZE bodies, solids among them, dropped on solid hills",        make_terrain, make_terrain_of},
    {"dominoes",         100,  2, kMost, "SIZE pieces in a row, the first one pushed",                    make_dominoes},
    {"card_house",         5,  1,  2000, "a house of cards SIZE levels high",                             make_card_house},
    {"arch",              25,  7, 10000, "an arch of SIZE stones that nothing but friction holds",        make_arch},
    {"cradle",             5,  2, kMost, "SIZE balls in a line, one flies at the others that touch",      make_cradle},
    {"bullet_plate",     100,  1, kMost, "SIZE bullets at 1 km/s against a plate of 1 mm",                make_bullet_plate},
    {"spring",             1,  1, kMost, "SIZE balls, each on a spring that nothing damps",               make_spring},
    {"rolling",           25,  1, kMost, "SIZE balls on a box that a force pulls along (SimBenchmark)",   make_rolling},
    {"bouncing",          49,  1, kMost, "SIZE balls that bounce and lose nothing (SimBenchmark)",        make_bouncing},
    {"ball_cube",        216,  1, kMost, "SIZE balls in a cube that comes apart (SimBenchmark's 666)",    make_ball_cube},
    {"elastic_ball_cube", 216, 1, kMost, "SIZE balls in a cube from 1 m up that lose nothing (elastic 666)", make_elastic_ball_cube},
    {"kapla",            102,  1, kMost, "a tower of SIZE planks, 17 to a floor (SimBenchmark's Kapla)",  make_kapla},
    {"washer",          8000,  1, kMost, "SIZE cubes in a ring with paddles that turns (Box3D)",          make_washer},
    {"large_pyramid",   5050,  1, kMost, "up to SIZE cubes in one pyramid, one cube thick (Box3D)",       make_large_pyramid},
    {"many_pyramids",  10780, 55, kMost, "up to SIZE cubes in pyramids of 55, one cube thick (Box3D)",    make_many_pyramids},
    {"junkyard",       10584,  1, kMost, "SIZE stones in a yard in which a pillar goes round (Box3D)",    make_junkyard},
    {"trees",             50,  1,  1000, "SIZE trees of 22 hulls that fall on waves of triangles (Box3D)", make_trees},
    {"large_world",  1000000,  1, kMost, "SIZE static slabs, and a hundred balls that fall on them (Box3D)", make_large_world},
};
// clang-format on

// How many letters must be put in, taken out or changed to make one word of the other.
std::size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row[b.size()];
}

std::string unknown_name(std::string_view name)
{
    // A name as far off as it is long is no misspelling of anything.
    const CatalogEntry* nearest = nullptr;
    std::size_t least = std::max<std::size_t>(1, name.size() / 2) + 1;
    for (const CatalogEntry& entry : kCatalog) {
        const std::size_t distance = edit_distance(name, entry.name);
        if (distance >= least) continue;
        least = distance;
        nearest = &entry;
    }
    std::string text = "no scene is called \"" + std::string(name) + '"';
    if (nearest != nullptr) text += "; did you mean \"" + std::string(nearest->name) + "\"?";
    text += nearest != nullptr ? " There are: " : "; there are: ";
    for (const CatalogEntry& entry : kCatalog) {
        if (&entry != &kCatalog[0]) text += ", ";
        text += entry.name;
    }
    return text;
}

std::string wrong_size(const CatalogEntry& entry, std::string_view size)
{
    return std::string(entry.name) + ": the size is \"" + std::string(size)
        + "\"; give a whole number from " + std::to_string(entry.least) + " to "
        + std::to_string(entry.most);
}

}  // namespace

std::span<const CatalogEntry> catalog() { return kCatalog; }

const CatalogEntry* find_scene(std::string_view name)
{
    const auto named = [&](const CatalogEntry& entry) { return entry.name == name; };
    const auto* found = std::find_if(std::begin(kCatalog), std::end(kCatalog), named);
    return found == std::end(kCatalog) ? nullptr : found;
}

ParsedScene parse_scene(std::string_view text)
{
    const std::size_t colon = text.find(':');
    const std::string_view name = text.substr(0, colon);
    const CatalogEntry* entry = find_scene(name);
    if (entry == nullptr) return {nullptr, 0, unknown_name(name)};
    if (colon == std::string_view::npos) return {entry, entry->default_size, {}};

    const std::string_view digits = text.substr(colon + 1);
    int size = 0;
    const auto [end, trouble] = std::from_chars(digits.data(), digits.data() + digits.size(), size);
    const bool whole = trouble == std::errc() && end == digits.data() + digits.size();
    if (!whole || size < entry->least || size > entry->most)
        return {nullptr, 0, wrong_size(*entry, digits)};
    return {entry, size, {}};
}

Scene make_scene(std::string_view name, int size, std::uint64_t seed)
{
    const CatalogEntry* entry = find_scene(name);
    if (entry == nullptr) throw std::invalid_argument(unknown_name(name));
    if (size < entry->least || size > entry->most)
        throw std::invalid_argument(wrong_size(*entry, std::to_string(size)));
    return entry->make(size, seed);
}

}  // namespace throng
