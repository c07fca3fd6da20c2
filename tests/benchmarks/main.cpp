// meniscus-bench: measurements, each with the machine, the commit and the command that gave them.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "benchmarks.hpp"
#include "meniscus/error.hpp"
#include "report.hpp"

namespace {

int report_failure(const std::exception& e, int code) {
    std::cerr << "meniscus-bench: " << e.what() << '\n';
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures what reconstruction, encoding, uploads and the service cost, and how good surfaces are",
                 "meniscus-bench");
    app.require_subcommand(1);
    meniscus::benchmarks::add_experiment(app);
    meniscus::benchmarks::add_scaling(app);
    meniscus::benchmarks::add_encoding(app);
    meniscus::benchmarks::add_goals(app);
    meniscus::benchmarks::add_upload(app);
    meniscus::benchmarks::add_service(app);
    meniscus::benchmarks::add_quality(app);
    try {
        meniscus::benchmarks::remember_command(argc, argv);
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& e) {
        return e.get_exit_code() == 0 ? app.exit(e) : report_failure(e, 2);
    } catch (const meniscus::InvalidInput& e) {
        return report_failure(e, 2);
    } catch (const std::exception& e) {
        return report_failure(e, 1);
    }
}
