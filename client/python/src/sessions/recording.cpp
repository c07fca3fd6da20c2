#include "sessions/recording.hpp"

#include "bindings.hpp"

namespace meniscus::python {

void bind_recording(pybind11::module_& module) {
    bind_source<RecordingSource>(module, "RecordingReader");
}

}  // namespace meniscus::python
