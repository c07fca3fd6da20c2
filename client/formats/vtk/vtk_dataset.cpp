#include "formats/vtk/vtk_dataset.hpp"

#include <utility>

#include "formats/containers/point_numbers.hpp"

namespace meniscus::formats {
namespace {

bool is_normals(VtkUse use, std::string_view name, ScalarType type, std::size_t components) {
    const std::string plain = array_name(name);
    return use == VtkUse::mesh && (plain == "normals" || plain == "normal") && components == 3 && !is_integer(type);
}

}  // namespace

std::optional<VtkCell> face_of(double number) {
    constexpr auto first = static_cast<int>(VtkCell::triangle), last = static_cast<int>(VtkCell::quad);
    if (!(number >= first && number <= last)) return std::nullopt;
    return static_cast<VtkCell>(static_cast<int>(number));
}

void append_face(VtkDataset& out, VtkCell kind, const std::vector<std::uint32_t>& corners, std::size_t cell) {
    const auto append = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        out.triangles.push_back({a, b, c});
        out.triangle_cells.push_back(cell);
    };
    if (kind == VtkCell::strip) {
        for (std::size_t i = 2; i < corners.size(); ++i)
            append(corners[i - 2 + i % 2], corners[i - 1 - i % 2], corners[i]);
    } else if (kind == VtkCell::pixel && corners.size() == 4) {
        append(corners[0], corners[1], corners[3]);
        append(corners[0], corners[3], corners[2]);
    } else {
        for (std::size_t i = 2; i < corners.size(); ++i) append(corners[0], corners[i - 1], corners[i]);
    }
}

VtkPointArray::VtkPointArray(VtkDataset& out, VtkUse use, std::string_view name, ScalarType type,
                             std::size_t components, const ByteCursor& at)
    : out_(out), at_(at) {
    if (use == VtkUse::particles && name == "level" && components == 1 && is_integer(type)) {
        levels_ = true;
        out.levels.clear();
        out.levels.reserve(out.points.size());
    } else if (out.normals.empty() && is_normals(use, name, type, components)) {
        out.normals.reserve(out.points.size());
    } else {
        values_.emplace(name, type, components, out.points.size());
    }
}

void VtkPointArray::add(double value) {
    if (values_) return values_->add(value);
    if (levels_) return out_.levels.push_back(to_level(value, out_.levels.size(), at_));
    if (component_ == 0) out_.normals.emplace_back();
    out_.normals.back()[component_] = to_coordinate(value, out_.normals.size() - 1, at_);
    component_ = (component_ + 1) % 3;
}

void VtkPointArray::finish() {
    if (values_) out_.arrays.add(std::move(*values_));
}

bool is_cell_levels(VtkUse use, std::string_view name, ScalarType type, std::size_t components) {
    return use == VtkUse::mesh && name == "level" && components == 1 && is_integer(type);
}

}  // namespace meniscus::formats
