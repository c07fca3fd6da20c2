// What the vertices of a mesh have, as a picture shows it: numbers, colors or ids.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/meshes/triangle_mesh.hpp"
#include "picture/color_maps.hpp"
#include "picture/value_range.hpp"

namespace meniscus::cli {

struct ShownValues {
    std::string title;
    std::vector<float> numbers;       ///< one per vertex, or none where each vertex has its own color
    std::vector<Rgb> colors;          ///< one per vertex, or none
    bool nearest = false;             ///< colors are not mixed: they stand for ids
    std::optional<ValueRange> range;  ///< of the numbers; none without any
};

/// what: NAME of an attribute, or NAME.x, .y, .z or .w. Of a vector without a component: its magnitude. uint8 of 3 or 4
/// named color, rgb or rgba are colors themselves, int32 and uint32 are ids. Throws InvalidInput for an attribute that
/// the mesh does not have, with those that it has.
ShownValues values_to_show(const formats::TriangleMesh& mesh, const std::string& what);

}  // namespace meniscus::cli
