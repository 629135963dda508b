// Cases: what the command prints and writes of hard cases.
#include "scene/files/json.hpp"
#include "tests/apps/throng/command.hpp"
#include "throng/convex_query.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <set>
#include <thread>

namespace throng {
namespace {

using Node = JsonDocument::Node;

// As a shell has it: `throng cases H1 | head -1`.
TEST(Cases, EndQuietlyWhenNobodyReadsOn)
{
    const TestFolder folder;
    const std::string command = std::string("'" THRONG_COMMAND "' cases H1 2>'") + folder / "err"
        + "' | head -1 >/dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT(concurrency-mt-unsafe)
    EXPECT_EQ(folder.read("err"), "");
}

TEST(Cases, MethodsAreSummedUpCaseByCase)
{
    const TestFolder folder;
    const Outcome done = run_throng({"cases", "h32", "H35", "--json", folder / "c.json"});
    ASSERT_EQ(done.err, "");
    const std::size_t table = done.out.find("\nmethod ");
    ASSERT_NE(table, std::string::npos) << done.out;
    EXPECT_NE(done.out.find(" H32  H35", table), std::string::npos) << done.out;
    for (const MethodDescription& method : known_methods())
        EXPECT_NE(done.out.find("\n" + std::string(method.name) + " ", table), std::string::npos)
            << method.name << " is not in the table of " << done.out;

    // Each line of a method names it, beside the keys that every line has.
    const JsonDocument json(folder.read("c.json"), "c.json");
    std::set<std::string> named;
    Node line = json.first(JsonDocument::kRoot);
    for (std::size_t i = 0; i < json.size(JsonDocument::kRoot); ++i, line = json.next(line)) {
        for (const char* key : {"case", "setting", "quantity", "figure", "bound", "unit", "status"})
            EXPECT_NE(json.find(line, key), JsonDocument::kRoot) << key;
        const Node method = json.find(line, "method");
        if (method != JsonDocument::kRoot) named.insert(std::string(json.text(method)));
    }
    for (const MethodDescription& method : known_methods())
        EXPECT_EQ(named.count(std::string(method.name)), 1u) << method.name;
}

TEST(Cases, WithoutMethodsThereIsNoTable)
{
    const Outcome done = run_throng({"cases", "H12"});
    EXPECT_EQ(done.code, 0) << done.out << done.err;
    EXPECT_EQ(done.out.find("\nmethod "), std::string::npos) << done.out;
}

TEST(Cases, AnInterruptEndsACaseAndKeepsItsLines)
{
    const TestFolder folder;
    // Of many runs, of which the first is over soon.
    const Outcome ended =
        run_throng({"cases", "H1", "--json", folder / "c.json"}, [&](pid_t process) {
            std::this_thread::sleep_for(std::chrono::seconds(1));
            ::kill(process, SIGINT);
        });
    EXPECT_EQ(ended.code, 130) << ended.err;
    const JsonDocument json(folder.read("c.json"), "c.json");
    std::size_t printed = 0;
    for (std::size_t at = 0; (at = ended.out.find("\nH1 ", at)) != std::string::npos; ++at)
        ++printed;
    printed += ended.out.starts_with("H1 ") ? 1 : 0;
    EXPECT_EQ(json.size(JsonDocument::kRoot), printed) << ended.out;
}

}  // namespace
}  // namespace throng
