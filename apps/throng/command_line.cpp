// Command line: finds the command, and turns whatever stops it into a sentence and an exit code.
#include "apps/throng/commands.hpp"
#include "apps/throng/launcher.hpp"
#include "scene/files/scene_error.hpp"
#include "scene/names.hpp"
#include "throng/version.hpp"

#include <array>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>
#include <poll.h>
#include <unistd.h>

namespace throng {
namespace {

using Commands = std::span<const Command* const>;

void print_help(Commands commands, std::ostream& out)
{
    out << "usage: throng COMMAND [options]\n\n"
           "Simulates large, crowded scenes of rigid bodies, and says what its answers are "
           "worth.\n\n";
    std::vector<std::pair<std::string, std::string>> rows;
    for (const Command* command : commands)
        rows.emplace_back(command->usage.name, command->usage.about);
    rows.emplace_back("--help", "this text; throng COMMAND --help says more of a command");
    rows.emplace_back("--version", "the version");
    print_columns(rows, out);
    out << "\nA SCENE is a scene file (JSON), or the name of a scene of the catalogue with its "
           "size:\n"
           "pile:10000. `throng scene` lists the catalogue.\n\n"
           "exit codes\n"
           "  0    done\n"
           "  1    a case failed, or a body was quarantined (outputs are written all the same)\n"
           "  2    bad input or usage, or an output that cannot be written\n"
           "  3    a fault of throng\n"
           "  130  interrupted (files are closed and readable)\n";
}

void print_help_of(const Command& command)
{
    print_usage(command.usage, std::cout);
    if (command.more_help != nullptr) command.more_help(std::cout);
}

const Command& find_command(Commands commands, std::string_view name)
{
    std::vector<std::string_view> names;
    for (const Command* command : commands) {
        if (command->usage.name == name) return *command;
        names.push_back(command->usage.name);
    }
    const std::string near = nearest_names(name, names);
    throw BadInput(
        "there is no command " + in_quotes(name)
        + (near.empty() ? "; there are: " + either_of(names) : "; did you mean " + near + "?")
        + " (throng --help says more)");
}

// Before any work: a wrong environment is the user's to mend, and no fault of throng.
void check_environment()
{
    try {
        lane_width();
    } catch (const std::runtime_error& error) {
        throw BadInput(error.what());
    }
}

// A command that is a program of its own takes this process over; it comes back only where there is
// no such program.
[[noreturn]] void become(const char* program, std::span<const std::string_view> arguments)
{
    std::vector<std::string> words = {program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> passed;
    passed.reserve(words.size() + 1);
    for (std::string& word : words) passed.push_back(word.data());
    passed.push_back(nullptr);
    std::error_code trouble;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", trouble).parent_path();
    for (const auto& folder : {self, self / ".." / "libexec" / "throng"}) {
        std::cout.flush();
        ::execv((folder / program).c_str(), passed.data());
    }
    std::string asked = "throng";
    for (const std::string_view word : arguments) asked += ' ' + std::string(word);
    throw BadInput(in_quotes(asked) + " is for a program of its own, " + program
                   + ", which is not beside this one; build that target, or install it");
}

int run_command(Commands commands, std::span<const std::string_view> arguments)
{
    if (arguments.empty()) {
        print_help(commands, std::cerr);
        return kBadInput;
    }
    const std::string_view first = arguments.front();
    if (first == "--help" || first == "-h" || first == "help") {
        if (first != "help" || arguments.size() < 2) {
            print_help(commands, std::cout);
            return kDone;
        }
        const Command& command = find_command(commands, arguments[1]);
        if (command.program != nullptr && command.by_program == nullptr)
            become(command.program, std::array{command.usage.name, std::string_view("--help")});
        print_help_of(command);
        return kDone;
    }
    if (first == "--version") {
        std::cout << "throng " << version() << "\n";
        return kDone;
    }
    const Command& command = find_command(commands, first);
    if (command.program != nullptr && command.by_program == nullptr)
        become(command.program, arguments);
    const Options options(command.usage, arguments.subspan(1));
    if (!options.wants_help()) {
        if (command.program != nullptr && command.by_program(options))
            become(command.program, arguments);
        check_environment();
        return command.run(options);
    }
    print_help_of(command);
    return kDone;
}

// Of a pipe that standard output goes to: `throng cases | head` is no error.
bool reader_left()
{
    struct pollfd out = {STDOUT_FILENO, POLLOUT, 0};
    return ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

int complain(std::string_view what, int code)
{
    std::cerr << what << std::endl;
    return code;
}

/// What stopped the command, in words. Call it while the exception is being handled.
int explain_exception()
{
    try {
        throw;
    } catch (const SceneError& error) {
        return complain(error.what(), kBadInput);
    } catch (const BadInput& error) {
        return complain(std::string("error: ") + error.what(), kBadInput);
    } catch (const std::bad_alloc&) {
        return complain("error: not enough memory for this; a smaller scene may fit", kBadInput);
    } catch (const std::exception& error) {
        return complain(std::string("error: a fault of throng: ") + error.what()
                            + "\nPlease report it with the command and its scene.",
                        kFault);
    } catch (...) {
        return complain("error: a fault of throng, of a kind it does not know."
                        "\nPlease report it with the command and its scene.",
                        kFault);
    }
}

}  // namespace

int run_program(Commands commands, int count, char** words)
{
    // A reader that left early is seen when stdout is flushed, and files are still finished.
    std::signal(SIGPIPE, SIG_IGN);
    // A file that may grow no further is seen as a full disk is.
    std::signal(SIGXFSZ, SIG_IGN);
    build_by_launcher();
    int code = kDone;
    try {
        const std::vector<std::string_view> arguments(words + (count > 0 ? 1 : 0), words + count);
        code = run_command(commands, arguments);
    } catch (...) {
        code = explain_exception();
    }
    std::cout.flush();
    if (!std::cout && code == kDone && !reader_left())
        code = complain("error: standard output: cannot be written", kBadInput);
    return code;
}

}  // namespace throng
