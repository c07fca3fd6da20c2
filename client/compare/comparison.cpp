#include "compare/comparison.hpp"

#include <algorithm>

#include "compare/vector_math.hpp"

namespace meniscus::compare {
namespace {

Side look_at(SurfaceView surface, const Components& components, const Samples& samples, const TriangleTree& other) {
    const SurfaceDistance distance = measure(samples, other);
    Side side;
    side.vertices = surface.positions.size();
    side.triangles = surface.triangles.size();
    side.samples = samples.points.size();
    side.area = samples.area();
    side.defects = find_defects(surface);
    side.distance = distance.summary;
    for (std::size_t k = 0; k < components.count(); ++k) {
        Part part;
        part.triangles = components.starts[k + 1] - components.starts[k];
        part.distance = distance.nearest[k];
        const std::size_t count = samples.starts[k + 1] - samples.starts[k];
        for (std::size_t i = samples.starts[k]; i < samples.starts[k + 1]; ++i) {
            part.area += samples.weights[i];
            part.center = add_scaled(part.center, 1.0 / static_cast<double>(count), samples.points[i]);
        }
        side.parts.push_back(part);
    }
    return side;
}

}  // namespace

std::vector<Part> Side::missing(double cell_size) const {
    std::vector<Part> out;
    for (const Part& part : parts)
        if (part.missing(cell_size)) out.push_back(part);
    return out;
}

double Side::farthest_part() const {
    double farthest = 0.0;
    for (const Part& part : parts) farthest = std::max(farthest, part.distance);
    return farthest;
}

DistanceSummary Comparison::distance() const {
    return {std::max(a.distance.rms, b.distance.rms), std::max(a.distance.percentile_99, b.distance.percentile_99),
            std::max(a.distance.max, b.distance.max)};
}

double Comparison::triangle_ratio() const {
    return static_cast<double>(a.triangles) / static_cast<double>(b.triangles);
}

Comparison compare_surfaces(SurfaceView a, SurfaceView b, std::size_t samples) {
    const Components components_a = find_components(a);
    const Components components_b = find_components(b);
    const Samples samples_a = sample(a, components_a, samples);
    const Samples samples_b = sample(b, components_b, samples);
    return {look_at(a, components_a, samples_a, TriangleTree(b)), look_at(b, components_b, samples_b, TriangleTree(a))};
}

}  // namespace meniscus::compare
