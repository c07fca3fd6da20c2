#include "settings.hpp"

#include "row_dict.hpp"

namespace py = pybind11;

namespace meniscus::python {

py::dict to_dict(const Settings& settings) {
    py::dict out;
    out["particle_radius"] = settings.particle_radius;
    out.attr("update")(rows_dict(in_force(settings)));
    out["attributes"] = settings.all_attributes ? py::object(py::str("all")) : py::cast(settings.attributes);
    return out;
}

}  // namespace meniscus::python
