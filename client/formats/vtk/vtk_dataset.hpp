// The content of a file of VTK, legacy or XML, on its way to particles or to a mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_limits.hpp"
#include "formats/containers/array_collector.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::formats {

/// The use of a file. For particles, faces are only counted; for a mesh, levels of points are not read.
enum class VtkUse { particles, mesh };

struct VtkDataset {
    explicit VtkDataset(const ByteCursor& at) : arrays(at) {}

    std::vector<std::array<double, 3>> points;
    bool wide = false;                        ///< the points are float64
    std::size_t faces = 0;                    ///< polygons and strips of triangles
    std::vector<Triangle> triangles;          ///< these faces, cut; of a mesh
    std::vector<std::size_t> triangle_cells;  ///< the cell that each of them is of
    std::vector<std::uint8_t> cell_levels;    ///< empty, or one per cell; of a mesh
    std::vector<std::uint8_t> levels;         ///< empty, or one per point; of particles
    std::vector<Normal> normals;              ///< empty, or one per point; of a mesh
    ArrayCollector arrays;
};

/// A type of a cell, by VTK's number.
enum class VtkCell : std::uint8_t { strip = 6, polygon = 7, pixel = 8, triangle = 5, quad = 9 };
/// The type of this number, if it is a face. Points and lines are none, and volumes have other uses.
std::optional<VtkCell> face_of(double number);

/// Appends a face as triangles. corners: indices of points, checked.
void append_face(VtkDataset& out, VtkCell kind, const std::vector<std::uint32_t>& corners, std::size_t cell);

/// An array of the points: levels, normals, or values.
class VtkPointArray {
public:
    /// The caller has checked that values for all points can be there.
    VtkPointArray(VtkDataset& out, VtkUse use, std::string_view name, ScalarType type, std::size_t components,
                  const ByteCursor& at);
    /// False: its values need not be read.
    bool wanted() const { return !values_ || values_->wanted(); }
    void add(double value);
    /// Behind the last value, or the array that is not wanted.
    void finish();

private:
    VtkDataset& out_;
    const ByteCursor& at_;
    bool levels_ = false;
    std::optional<ArrayBuilder> values_;  ///< neither levels nor normals
    std::size_t component_ = 0;
};

/// Whether this array of the cells holds the levels of triangles, as our writers write them.
bool is_cell_levels(VtkUse use, std::string_view name, ScalarType type, std::size_t components);
/// A level of a cell: 1 to 3; other numbers are crack filling.
inline std::uint8_t to_cell_level(double value) {
    return value >= 1.0 && value <= 3.0 ? static_cast<std::uint8_t>(value) : std::uint8_t{0};
}

/// The readers. name: the file, for messages. Throw InvalidInput in one line.
VtkDataset read_legacy_vtk(const std::string& name, std::string_view bytes, const ReadLimits& limits, VtkUse use);
VtkDataset read_xml_vtk(const std::string& name, std::string_view bytes, const ReadLimits& limits, VtkUse use);

}  // namespace meniscus::formats
