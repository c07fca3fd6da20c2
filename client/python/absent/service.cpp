// The functions that need a server, or the messages of its files, in a build without the service.
#include "bindings.hpp"
#include "meniscus/error.hpp"
#include "surfaces/figures.hpp"

namespace py = pybind11;

namespace meniscus::python {

void bind_service(py::module_& module) {
    const auto absent = [&module](const char* function, const char* what) {
        module.def(function, [what](const py::args&, const py::kwargs&) -> py::object {
            throw NotBuilt(what, "the service: build it without -DMENISCUS_SERVICE=OFF, where gRPC is installed");
        });
    };
    absent("connect", "a server's client");
    absent("read_bricks", "reading .bricks");
    absent("open_recording_file", "reading recordings");
    for (const char* function : {"open_publication", "make_publication_writer", "write_site", "single_page"})
        absent(function, "a publication");
}

std::string figure_bytes(const Statistics& /*figures*/) {
    return {};
}

std::optional<Statistics> figures_of(const std::string& /*bytes*/) {
    return Statistics{};
}

}  // namespace meniscus::python
