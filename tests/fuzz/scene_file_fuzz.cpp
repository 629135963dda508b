// Scene file, fuzzed: any bytes are a scene, or an error of one line that says where and what.
//
// The part after "%%%" is what every file holds that the scene names; nothing is read from the
// disk. What begins as a .vdb does is left out: OpenVDB, which reads it, does not expect any bytes.
#include "throng/scene_file.hpp"

#include "scene/rules/scene_check.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>

namespace {

void expect(bool good)
{
    if (!good) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace throng;
    const std::string input(reinterpret_cast<const char*>(data), size);
    const std::size_t cut = input.find("%%%");
    const std::string files = cut == input.npos ? "" : input.substr(cut + 3);
    const FileReader reader = [&](const std::string&, std::uint64_t limit) {
        if (files.starts_with(" BDV")) return FileContent{{}, 0, "it is for another fuzzer"};
        return FileContent{files.substr(0, limit), files.size(), {}};
    };
    try {
        const Scene scene = read_scene_text(input.substr(0, cut), "s.json", "in", reader);
        expect(check_scene(scene).empty());
    } catch (const SceneError& error) {
        const std::string what = error.what();
        expect(what.find(": error: ") != what.npos && what.find("wanted ") != what.npos);
        expect(what.find('\n') == what.npos && what.size() < 10000);
    }
    return 0;
}
