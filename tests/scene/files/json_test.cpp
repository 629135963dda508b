// JSON: strict, places remembered, nothing lost.
#include "scene/files/json.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

namespace throng {
namespace {

std::string error_of(const std::string& text)
{
    try {
        const JsonDocument json(text, "t.json");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

std::string nested(int depth) { return std::string(static_cast<std::size_t>(depth), '['); }

TEST(Json, RefusesEachKindOfBadTextAtItsPlace)
{
    struct Bad {
        std::string text;
        const char* expected;  // after "t.json:"
    };
    const Bad all[] = {
        {"", "1:1: error: scene: wanted a value, not the end of the file"},
        {"  \n ", "2:2: error: scene: wanted a value, not the end of the file"},
        {"{} x", "1:4: error: scene: wanted nothing after the end, not \"x\""},
        {"{}{}", "1:3: error: scene: wanted nothing after the end, not \"{\""},
        {"{\"a\":1,}", "1:8: error: scene: wanted no comma before }"},
        {"[1,]", "1:4: error: [0]: wanted no comma before ]"},
        {"[,1]", "1:2: error: [0]: wanted a value, not \",\""},
        {"[1 2]", "1:4: error: [0]: wanted , or ], not \"2\""},
        {"[1", "1:3: error: [0]: wanted , or ], not the end of the file"},
        {"[", "1:2: error: [0]: wanted a value, not the end of the file"},
        {"{", "1:2: error: scene: wanted a key in quotes, not the end of the file"},
        {"{\"a\"", "1:5: error: a: wanted : after the key, not the end of the file"},
        {"{\"a\" 1}", "1:6: error: a: wanted : after the key, not \"1\""},
        {"{\"a\":", "1:6: error: a: wanted a value, not the end of the file"},
        {"{\"a\":1 \"b\":2}", "1:8: error: scene: wanted , or }, not \"\"\""},
        {"{a:1}", "1:2: error: scene: wanted a key in quotes, not \"a\""},
        {"{'a':1}", "1:2: error: scene: wanted a key in quotes, not \"'\""},
        {"{\"a\":1,\"b\":2,\"a\":3}", "1:14: error: a: wanted each key once, not \"a\" again"},
        {"{\"a\":1,\"\\u0061\":3}", "1:8: error: a: wanted each key once, not \"a\" again"},
        {"[NaN]", "1:2: error: [0]: wanted a value, not \"NaN\""},
        {"[-Infinity]", "1:2: error: [0]: wanted a number, not \"-Infinity\""},
        {"[Infinity]", "1:2: error: [0]: wanted a value, not \"Infinity\""},
        {"[1e999]", "1:2: error: [0]: wanted a number that a double can hold, not \"1e999\""},
        {"[-1e309]", "1:2: error: [0]: wanted a number that a double can hold, not \"-1e309\""},
        {"[01]", "1:2: error: [0]: wanted a number without leading zeros"},
        {"[-012]", "1:2: error: [0]: wanted a number without leading zeros"},
        {"[1.]", "1:2: error: [0]: wanted a number, not \"1.\""},
        {"[.5]", "1:2: error: [0]: wanted a value, not \".5\""},
        {"[+1]", "1:2: error: [0]: wanted a value, not \"+1\""},
        {"[1e]", "1:2: error: [0]: wanted a number, not \"1e\""},
        {"[1e+]", "1:2: error: [0]: wanted a number, not \"1e+\""},
        {"[0x10]", "1:3: error: [0]: wanted , or ], not \"x10\""},
        {"[-]", "1:2: error: [0]: wanted a number, not \"-\""},
        {"[tru]", "1:2: error: [0]: wanted a value, not \"tru\""},
        {"[nulls]", "1:2: error: [0]: wanted a value, not \"nulls\""},
        {"[True]", "1:2: error: [0]: wanted a value, not \"True\""},
        {"[\"abc", "1:2: error: [0]: wanted a closing quote for this text"},
        {"[\"a\\", "1:4: error: [0]: wanted one of the escapes"},
        {"[\"a\\x41\"]", "1:4: error: [0]: wanted one of the escapes"},
        {"[\"a\\u12g4\"]", "1:4: error: [0]: wanted four hexadecimal digits after \\u"},
        {"[\"a\\u12", "1:4: error: [0]: wanted four hexadecimal digits after \\u"},
        {"[\"a\\u-123\"]", "1:4: error: [0]: wanted four hexadecimal digits after \\u"},
        {"[\"\\ud800\"]", "1:3: error: [0]: wanted a pair of surrogates, not a lone one"},
        {"[\"\\udc00\"]", "1:3: error: [0]: wanted a pair of surrogates, not a lone one"},
        {"[\"\\ud800\\u0041\"]", "1:3: error: [0]: wanted a pair of surrogates, not a lone one"},
        {"[\"a\tb\"]", "1:4: error: [0]: wanted text without control characters"},
        {"[\"a\nb\"]", "1:4: error: [0]: wanted text without control characters"},
        {"[\"\xff\"]", "1:3: error: [0]: wanted text in UTF-8"},
        {"[\"\xc0\xaf\"]", "1:3: error: [0]: wanted text in UTF-8"},
        {"[\"\xed\xa0\x80\"]", "1:3: error: [0]: wanted text in UTF-8"},
        {"[\"\xf4\x90\x80\x80\"]", "1:3: error: [0]: wanted text in UTF-8"},
        {"[\"\xe2\x82\"]", "1:3: error: [0]: wanted text in UTF-8"},
        {"\xef\xbb\xbf{}", "1:1: error: scene: wanted no byte order mark"},
        {"[1] // no", "1:5: error: scene: wanted nothing after the end, not \"/\""},
        {"{\"a b\": [1, {\"c\": x}]}", "1:19: error: [\"a b\"][1].c: wanted a value, not \"x\""},
        {"[\"\u00e9\u00e9\", x]", "1:8: error: [1]: wanted a value, not \"x\""},
        {"[1,\r\n  x]", "2:3: error: [1]: wanted a value, not \"x\""},
    };
    for (const Bad& bad : all) {
        const std::string error = error_of(bad.text);
        const std::string expected = std::string("t.json:") + bad.expected;
        EXPECT_EQ(error.substr(0, expected.size()), expected) << bad.text;
    }
}

TEST(Json, RefusesTheSixtyFifthLevelAndTakesTheSixtyFourth)
{
    EXPECT_EQ(error_of(nested(64) + std::string(64, ']')), "no error");
    const std::string error = error_of(nested(65) + std::string(65, ']'));
    EXPECT_NE(error.find("t.json:1:65: error: "), error.npos) << error;
    EXPECT_NE(error.find("wanted at most 64 levels of nesting"), error.npos) << error;
    EXPECT_NE(error_of(nested(10'000'000)), "no error");
}

TEST(Json, ReadsNumbersToTheLastBit)
{
    const JsonDocument json("[0, -0, 1e308, 4.9e-324, 1e-999, 0.1, 123456789012345678901234567890, "
                            "-0.0e5, 1E+2, 0e99999999999999999999, 0.00000001e310]",
                            "t.json");
    const double expected[] = {
        0, -0.0, 1e308, 4.9e-324, 0, 0.1, 123456789012345678901234567890.0, -0.0, 100, 0, 1e302};
    JsonDocument::Node at = json.first(JsonDocument::kRoot);
    for (const double number : expected) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(json.number(at)),
                  std::bit_cast<std::uint64_t>(number))
            << json.text(at);
        at = json.next(at);
    }
    EXPECT_EQ(at, json.next(JsonDocument::kRoot));
}

TEST(Json, TellsTooGreatFromTooSmallHoweverSpelled)
{
    const std::string zeros(400, '0');
    EXPECT_EQ(error_of("[0." + zeros + "1]"), "no error");
    EXPECT_NE(error_of("[1" + zeros + "]"), "no error");
    EXPECT_NE(error_of("[1" + zeros + "e-1]"), "no error");
    EXPECT_EQ(error_of("[0." + zeros + "1e1]"), "no error");
    EXPECT_NE(error_of("[1e99999999999999999999999]"), "no error");
    EXPECT_NE(error_of("[88e9223372036854775807]"), "no error");
    EXPECT_EQ(error_of("[88e-9223372036854775807]"), "no error");
    EXPECT_EQ(error_of("[1e-99999999999999999999999]"), "no error");
}

TEST(Json, UndoesEscapes)
{
    const JsonDocument json(
        R"(["a\"\\\/\b\f\n\r\t\u00e9\u20AC\ud83d\ude00z", "", "plain", "\u0000"])", "t.json");
    JsonDocument::Node at = json.first(JsonDocument::kRoot);
    EXPECT_EQ(json.text(at), "a\"\\/\b\f\n\r\t\u00e9\u20ac\U0001F600z");
    at = json.next(at);
    EXPECT_EQ(json.text(at), "");
    at = json.next(at);
    EXPECT_EQ(json.text(at), "plain");
    at = json.next(at);
    EXPECT_EQ(json.text(at), std::string(1, '\0'));
}

TEST(Json, StringsReadBackAsWritten)
{
    std::string text = "\u00e9\u20ac\U0001F600\"\\/";
    for (char c = 1; c < 127; ++c) text += c;
    const JsonDocument json(json_string(text), "t.json");
    EXPECT_EQ(json.text(JsonDocument::kRoot), text);
    EXPECT_THROW(json_string("\xff"), std::invalid_argument);
}

TEST(Json, KnowsThePathOfEveryValueAndTheValueOfEveryPath)
{
    const JsonDocument json(R"({"a": {}, "b": [1, [], {"c": [true, null, "x"], "d e": 2}], "": 3})",
                            "t.json");
    JsonDocument::Node count = json.next(JsonDocument::kRoot);
    for (JsonDocument::Node node = 0; node < count; ++node) {
        const ScenePath path = json.path(node);
        const JsonDocument::Node found = json.resolve(path);
        // A key shares the path of its value.
        EXPECT_TRUE(found == node || found == node + 1) << node << ' ' << path_text(path);
    }
    EXPECT_EQ(path_text(json.path(json.find(json.resolve({"b", 2}), "d e"))), "b[2][\"d e\"]");
    // A path that leads further than the text stops where the text does.
    EXPECT_EQ(json.resolve({"b", 7, "c"}), json.resolve({"b"}));
    EXPECT_EQ(json.resolve({"a", "z"}), json.resolve({"a"}));
}

TEST(Json, CountsElementsAndMembers)
{
    const JsonDocument json(R"({"a": [], "b": [1], "c": [1, [2, 3], 4], "d": {}})", "t.json");
    EXPECT_EQ(json.size(JsonDocument::kRoot), 4u);
    EXPECT_EQ(json.size(json.resolve({"a"})), 0u);
    EXPECT_EQ(json.size(json.resolve({"b"})), 1u);
    EXPECT_EQ(json.size(json.resolve({"c"})), 3u);
    EXPECT_EQ(json.size(json.resolve({"d"})), 0u);
    EXPECT_EQ(json.find(JsonDocument::kRoot, "e"), JsonDocument::kRoot);
}

}  // namespace
}  // namespace throng
