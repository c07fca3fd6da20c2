#include "backend_options.hpp"

#include <CLI/CLI.hpp>

namespace meniscus::benchmarks {

void add_backend_options(CLI::App& command, BackendOptions& options) {
    command
        .add_option_function<std::string>(
            "--backend", [&options](const std::string& name) { options.backend = by_name<Backend>(name, "backend"); },
            listed(names<Backend>))
        ->default_str(std::string(name_of(options.backend)));
    command.add_option("--threads", options.threads, "Worker threads; 0: one per processor")->capture_default_str();
}

void add_backend(nlohmann::ordered_json& summary, const BackendOptions& options) {
    const BackendDescription backend = describe_backend(options.backend);
    summary["backend"] = backend.name;
    summary["device"] = backend.device;
    summary["threads"] = options.threads;
}

}  // namespace meniscus::benchmarks
