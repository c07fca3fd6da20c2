#include "settings.hpp"

#include <pybind11/stl.h>

#include <variant>

#include "meniscus/names.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

py::object value_or_none(bool has_meaning, const py::object& value) {
    return has_meaning ? value : py::none();
}

py::tuple point(const std::array<double, 3>& p) {
    return py::make_tuple(p[0], p[1], p[2]);
}

}  // namespace

py::dict to_dict(const Settings& settings) {
    const auto* curvature = std::get_if<CurvatureCriterion>(&settings.criterion);
    const auto* count = std::get_if<CountCriterion>(&settings.criterion);
    const auto* bisection = std::get_if<Bisection>(&settings.edge_points);
    const bool is_smooth = settings.field == Field::smooth;
    py::dict out;
    out["particle_radius"] = settings.particle_radius;
    out["cell_size"] = settings.cell_size;
    out["iso"] = settings.iso;
    out["field"] = name_of(settings.field);
    out["smoothness"] = value_or_none(is_smooth, py::int_(smoothness(settings)));
    out["spray"] = name_of(settings.spray);
    out["smoothing_length"] = value_or_none(!is_smooth, py::float_(smoothing_length(settings)));
    out["mode"] = name_of(settings.mode);
    out["criterion"] = name_of(settings.criterion);
    out["tolerance"] = value_or_none(curvature != nullptr, py::float_(tolerance(settings)));
    out["count_threshold"] = count != nullptr ? py::object(py::int_(count->threshold)) : py::none();
    out["edge_points"] = name_of(settings.edge_points);
    out["bisection_steps"] = bisection != nullptr ? py::object(py::int_(bisection->steps)) : py::none();
    out["normals"] = settings.normals;
    out["domain"] = py::none();
    if (settings.domain) out["domain"] = py::make_tuple(point(settings.domain->min), point(settings.domain->max));
    out["attributes"] = settings.all_attributes ? py::object(py::str("all")) : py::cast(settings.attributes);
    return out;
}

}  // namespace meniscus::python
