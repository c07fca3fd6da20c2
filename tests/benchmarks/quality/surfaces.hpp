// Where the surfaces that are judged come from: a reconstruction here, or files that another program has written.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/surface.hpp"
#include "meniscus/reconstructor.hpp"
#include "quality/shapes.hpp"

namespace meniscus::benchmarks::quality {

/// Particles with a name by which files of other programs are found.
struct Cloud {
    std::string name;
    std::vector<float> positions;  ///< x y z each, world units

    std::size_t count() const { return positions.size() / 3; }
    ParticleFrame frame() const {
        ParticleFrame view;
        view.positions = positions;
        return view;
    }
};

/// places: in radii.
Cloud make_cloud(std::string name, const std::vector<Point>& places, double radius);

/// Back in radii.
std::vector<Point> places_of(const Cloud& cloud, double radius);

/// A triangle mesh, in radii.
struct Surface {
    std::vector<Point> positions;
    std::vector<Normal> normals;  ///< empty, or one per position
    std::vector<Triangle> triangles;
    std::optional<Statistics> statistics;  ///< statistics of its reconstruction; none: read from a file

    compare::SurfaceView view() const { return {positions, triangles}; }
};

/// One way of making surfaces of particles.
struct Method {
    std::string field;       ///< "color", "smooth 6", or what the files are called
    std::string mode;        ///< "adaptive" or "uniform"
    double cell_size = 0.0;  ///< radii
    std::function<Surface(const Cloud&)> surface_of;
};

/// Reconstructs with these settings, on one thread, warm from one cloud to the next.
Method reconstructing(const Settings& settings);

/// Reads FOLDER/<name of the cloud>.ply, in world units, made with the radius and the cell size of the settings. label:
/// what the rows call it.
Method reading(std::string label, const std::filesystem::path& folder, const Settings& settings);

}  // namespace meniscus::benchmarks::quality
