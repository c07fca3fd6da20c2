#include "settings.hpp"

#include "row_dict.hpp"

namespace py = pybind11;

namespace meniscus::python {

py::dict to_dict(const Settings& settings) {
    py::dict out = rows_dict(in_force(settings));
    // The keyword for both has another name than the option.
    out.attr("pop")("attribute");
    out.attr("pop")("all_attributes");
    out["attributes"] = settings.all_attributes ? py::object(py::str("all")) : py::cast(settings.attributes);
    return out;
}

}  // namespace meniscus::python
