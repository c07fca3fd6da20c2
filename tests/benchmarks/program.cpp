#include "program.hpp"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "gpu/gpu.hpp"
#include "meniscus/error.hpp"
#include "report.hpp"

namespace meniscus::benchmarks {
namespace {

char* const* given_arguments = nullptr;
std::filesystem::path called_by;

int report_failure(const CLI::App& app, const std::exception& e, int code) {
    std::cerr << app.get_name() << ": " << e.what() << '\n';
    return code;
}

}  // namespace

char* const* program_arguments() {
    return given_arguments;
}

std::filesystem::path program_path() {
    return called_by;
}

int run_program(CLI::App& app, int argc, char** argv) {
    given_arguments = argv;
    const std::filesystem::path name = argv[0];
    // A name that was looked for in PATH is not where the file lies.
    called_by =
        name.has_parent_path() ? std::filesystem::absolute(name) : std::filesystem::read_symlink("/proc/self/exe");
    app.require_subcommand(1);
    try {
        remember_command(app.get_name(), argc, argv);
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& e) {
        return e.get_exit_code() == 0 ? app.exit(e) : report_failure(app, e, 2);
    } catch (const InvalidInput& e) {
        return report_failure(app, e, 2);
    } catch (const NoGpu& e) {
        return report_failure(app, e, no_gpu_exit_code);
    } catch (const std::exception& e) {
        return report_failure(app, e, 1);
    }
}

}  // namespace meniscus::benchmarks
