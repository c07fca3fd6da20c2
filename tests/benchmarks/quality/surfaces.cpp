#include "quality/surfaces.hpp"

#include <memory>
#include <sstream>
#include <utility>

#include "backend_options.hpp"
#include "formats/meshes/mesh_file.hpp"

namespace meniscus::benchmarks::quality {
namespace {

Surface in_radii(formats::TriangleMesh mesh, double radius) {
    Surface surface;
    surface.positions = std::move(mesh.positions);
    surface.normals = std::move(mesh.normals);
    surface.triangles = std::move(mesh.triangles);
    for (Point& p : surface.positions)
        for (double& coordinate : p) coordinate /= radius;
    return surface;
}

std::string field_text(const Settings& settings) {
    std::ostringstream text;
    text << name_of(settings.field);
    if (settings.field == Field::smooth) text << ' ' << smoothness(settings);
    return text.str();
}

}  // namespace

Cloud make_cloud(std::string name, const std::vector<Point>& places, double radius) {
    Cloud cloud;
    cloud.name = std::move(name);
    for (const Point& p : places)
        for (const double coordinate : p) cloud.positions.push_back(static_cast<float>(coordinate * radius));
    return cloud;
}

std::vector<Point> places_of(const Cloud& cloud, double radius) {
    std::vector<Point> places(cloud.count());
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        places[i / 3][i % 3] = static_cast<double>(cloud.positions[i]) / radius;
    return places;
}

Method reconstructing(const Settings& settings) {
    struct State {
        Reconstructor reconstructor;
        Mesh mesh{};
    };
    auto state = std::make_shared<State>(State{Reconstructor(settings, one_cpu_thread)});
    return {field_text(settings), std::string(name_of(settings.mode)), settings.cell_size, [state](const Cloud& cloud) {
                state->reconstructor.reconstruct(cloud.frame(), state->mesh);
                Surface surface =
                    in_radii(formats::to_triangles(state->mesh), state->reconstructor.settings().particle_radius);
                surface.statistics = state->reconstructor.statistics();
                return surface;
            }};
}

Method reading(std::string label, const std::filesystem::path& folder, const Settings& settings) {
    return {std::move(label), "uniform", settings.cell_size,
            [folder, radius = settings.particle_radius](const Cloud& cloud) {
                return in_radii(formats::read_mesh(folder / (cloud.name + ".ply")), radius);
            }};
}

}  // namespace meniscus::benchmarks::quality
