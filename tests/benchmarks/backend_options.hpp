// The backend and the threads of a benchmark.
#pragma once

#include <nlohmann/json.hpp>

#include "meniscus/reconstructor.hpp"

namespace CLI {
class App;
}

namespace meniscus::benchmarks {

/// The default.
inline const BackendOptions one_cpu_thread{.backend = Backend::cpu, .threads = 1};

/// The flags --backend and --threads.
void add_backend_options(CLI::App& command, BackendOptions& options);

/// Adds backend, device and threads to a summary. Throws InvalidInput if the backend cannot be used here.
void add_backend(nlohmann::ordered_json& summary, const BackendOptions& options);

}  // namespace meniscus::benchmarks
