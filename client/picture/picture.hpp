// A picture of a mesh.
#pragma once

#include <optional>
#include <string>

#include "formats/meshes/triangle_mesh.hpp"
#include "formats/pictures/png.hpp"
#include "picture/camera.hpp"
#include "picture/color_maps.hpp"
#include "picture/value_range.hpp"

namespace meniscus::cli {

struct PictureOptions {
    std::size_t width = 1200;  ///< pixels
    std::size_t height = 800;  ///< pixels
    bool wireframe = false;    ///< colored by level, hidden lines removed; else shaded water
    /// What the surface is colored by, as values_to_show() takes it; empty: it is water. With a legend; not with a
    /// wireframe.
    std::string color{};
    ColorMap color_map = ColorMap::viridis;
    std::optional<ValueRange> range{};  ///< none: that of the mesh; of a diverging map with zero in the middle
    UpAxis up = UpAxis::y;
    double azimuth = 30.0;    ///< degrees
    double elevation = 25.0;  ///< degrees
};

/// Throws InvalidInput where the mesh does not have what it is to be colored by.
formats::Image draw_picture(const formats::TriangleMesh& mesh, const PictureOptions& options);

}  // namespace meniscus::cli
