// Scene schema: the file in the tree is what the tables of fields and dials say.
#include "scene/files/scene_schema.hpp"

#include "scene/files/json.hpp"
#include "throng/dials.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace throng {
namespace {

TEST(SceneSchema, IsTheFileInTheTree)
{
    const std::string path = THRONG_SCHEMA;
    if (std::getenv("THRONG_UPDATE_GOLDEN") != nullptr) std::ofstream(path) << scene_schema();
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    EXPECT_EQ(text.str(), scene_schema()) << "./throng scene --schema makes it";
}

TEST(SceneSchema, HasEveryDialWithItsDefault)
{
    const JsonDocument schema(scene_schema(), "schema");
    const auto below = [&](JsonDocument::Node node, std::initializer_list<const char*> keys) {
        for (const char* const key : keys) {
            node = schema.find(node, key);
            EXPECT_NE(node, JsonDocument::kRoot) << key;
        }
        return node;
    };
    const auto settings = below(JsonDocument::kRoot, {"$defs", "settings", "properties"});
    ASSERT_EQ(schema.size(settings), dials().size());
    for (const Dial& dial : dials()) {
        const auto standard = below(settings, {dial.name.data(), "default"});
        EXPECT_EQ(schema.text(standard), dial.default_value) << dial.name;
    }
}

}  // namespace
}  // namespace throng
