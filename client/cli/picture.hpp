// A picture of a mesh.
#pragma once

#include "cli/camera.hpp"
#include "formats/mesh_file.hpp"
#include "formats/png.hpp"

namespace meniscus::cli {

struct PictureOptions {
    std::size_t width = 1200;  ///< pixels
    std::size_t height = 800;  ///< pixels
    bool wireframe = false;    ///< colored by level, hidden lines removed; else shaded water
    UpAxis up = UpAxis::y;
    double azimuth = 30.0;    ///< degrees
    double elevation = 25.0;  ///< degrees
};

formats::Image draw_picture(const formats::TriangleMesh& mesh, const PictureOptions& options);

}  // namespace meniscus::cli
