#include "cli/command_line.hpp"

#include <google/protobuf/stubs/logging.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "cli/commands.hpp"
#include "cli/warnings.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {
namespace {

int report(std::string message, ExitCode code) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    std::cerr << "meniscus: " << message << '\n';
    return code;
}

}  // namespace

int run(int argc, const char* const* argv) {
    // What is wrong is said once, in a line of this program: protobuf has one of its own for bytes that do not parse.
    google::protobuf::SetLogHandler(nullptr);
    CLI::App app("Adaptive surfaces of simulated fluid particles", "meniscus");
    app.set_version_flag("--version", std::string("meniscus ") + std::string(version()));
    app.require_subcommand(0, 1);  // none is refused below, after anything that is not known
    add_reconstruct(app);
    add_simulate(app);
    add_watch(app);
    add_picture(app);
    add_compare(app);
    add_info(app);
    add_sessions(app);
    add_top(app);
    add_recordings(app);
    add_replay(app);
    add_convert(app);
    try {
        app.parse(argc, argv);
        if (app.get_subcommands().empty()) throw InvalidInput("a subcommand is needed; meniscus --help lists them");
        return success;
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return app.exit(e);  // --help and --version
        return report(e.what(), bad_input);
    } catch (const Warned&) {
        return warned;
    } catch (const InvalidInput& e) {
        return report(e.what(), bad_input);
    } catch (const LimitExceeded& e) {
        return report(e.what(), bad_input);
    } catch (const std::bad_alloc&) {
        return report("out of memory", failure);
    } catch (const std::exception& e) {
        return report(e.what(), failure);
    }
}

}  // namespace meniscus::cli
