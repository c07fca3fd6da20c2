#include "statistics.hpp"

#include "row_dict.hpp"

namespace py = pybind11;

namespace meniscus::python {

py::dict to_dict(const Statistics& statistics) {
    py::dict out = rows_dict(statistics);
    const auto& cells = statistics.base_cells_by_level;
    out["base_cells_by_level"] = py::make_tuple(cells[0], cells[1], cells[2]);
    return out;
}

py::dict to_dict(const client::FrameStatistics& statistics) {
    py::dict out = to_dict(static_cast<const Statistics&>(statistics));
    out.attr("update")(rows_dict(statistics));
    return out;
}

}  // namespace meniscus::python
