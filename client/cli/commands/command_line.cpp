#include "cli/commands/command_line.hpp"

#include <google/protobuf/stubs/logging.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/refusal.hpp"
#include "cli/print/visible_errors.hpp"
#include "cli/print/warnings.hpp"
#include "cli/surfaces/mesh_check.hpp"
#include "meniscus/client/errors.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {
namespace {

/// One empty line above each heading, where CLI11 has two.
class HelpFormatter : public CLI::Formatter {
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, std::move(name), mode), "\n\n\n", "\n\n");
    }
};

/// Below the options that a command has of its own.
void move_help_last(CLI::App& command) {
    command.set_help_flag();
    const OptionGroup group(command, other_heading);
    command.set_help_flag("-h,--help", "Print this help message and exit");
}

/// In the order in which CLI11 takes them, the last one first. It would take the value of "-r=3" to be "=3".
std::vector<std::string> arguments(int argc, const char* const* argv) {
    std::vector<std::string> taken;
    bool are_options = true;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        are_options = are_options && argument != "--";
        if (are_options && argument.size() > 2 && argument[0] == '-' && argument[1] != '-' && argument[2] == '=') {
            taken.push_back(argument.substr(0, 2));
            taken.push_back(argument.substr(3));
        } else {
            taken.push_back(argument);
        }
    }
    std::reverse(taken.begin(), taken.end());
    return taken;
}

int report(std::string message, ExitCode code) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    std::cerr << "meniscus: " << message << '\n';
    return code;
}

/// Flushes the output, which is buffered: a full disk shows late.
int end_of_printing() {
    errno = 0;
    std::cout.flush();
    if (std::cout) return success;
    // More than a buffer has failed before, and left no reason: one more byte has the same.
    [[maybe_unused]] const ssize_t written = errno == 0 ? ::write(STDOUT_FILENO, "\n", 1) : 0;
    const int error = errno;
    return report("standard output: writing failed" + (error == 0 ? "" : ": " + std::generic_category().message(error)),
                  failure);
}

}  // namespace

int run(int argc, const char* const* argv) {
    const VisibleErrors visible_errors;
    // An error is one line of this program: protobuf would add one of its own for bytes that do not parse.
    google::protobuf::SetLogHandler(nullptr);
    CLI::App app("Adaptive surfaces of simulated fluid particles", "meniscus");
    app.set_version_flag("--version", std::string("meniscus ") + std::string(version()));
    app.formatter(std::make_shared<HelpFormatter>());  // of the commands, too
    app.require_subcommand(0, 1);                      // none is refused below, after anything that is not known
    add_reconstruct(app);
    add_simulate(app);
    add_watch(app);
    add_picture(app);
    add_compare(app);
    add_check(app);
    add_info(app);
    add_sessions(app);
    add_top(app);
    add_recordings(app);
    add_replay(app);
    add_push(app);
    add_convert(app);
    add_publish(app);
    add_completion(app);
    add_help(app);
    for (CLI::App* command : app.get_subcommands({})) move_help_last(*command);
    app.footer("meniscus help COMMAND explains a command, with examples.");
    try {
        app.parse(arguments(argc, argv));
        if (app.get_subcommands().empty()) throw InvalidInput("a subcommand is needed; meniscus --help lists them");
        return end_of_printing();
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() != 0) return report(refusal(app, e), bad_input);
        app.exit(e);  // prints --help or --version
        return end_of_printing();
    } catch (const Defective&) {
        return defective;
    } catch (const Warned&) {
        return warned;
    } catch (const InvalidInput& e) {
        return report(e.what(), bad_input);
    } catch (const LimitExceeded& e) {
        return report(e.what(), bad_input);
    } catch (const client::ServerError& e) {
        const bool is_a_stranger = e.code() == client::ErrorCode::unauthenticated;
        return report(e.what() + std::string(is_a_stranger ? "; --token-file or MENISCUS_TOKEN gives a token" : ""),
                      failure);
    } catch (const std::bad_alloc&) {
        return report("out of memory", failure);
    } catch (const std::exception& e) {
        return report(e.what(), failure);
    }
}

}  // namespace meniscus::cli
