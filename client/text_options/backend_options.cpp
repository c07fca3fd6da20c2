#include "text_options/backend_options.hpp"

namespace meniscus::text_options {

BackendOptions read_backend(OptionReader& options) {
    BackendOptions backend;
    options.read_choice("backend", backend.backend);
    options.read("threads", backend.threads);
    options.read("memory-limit", backend.memory_limit);
    options.read("device", backend.device);
    options.read("device-memory-limit", backend.device_memory_limit);
    return backend;
}

}  // namespace meniscus::text_options
