#include <algorithm>

#include "compare/components.hpp"
#include "meniscus/error.hpp"
#include "quality/cases.hpp"
#include "quality/judge.hpp"
#include "quality/sampling.hpp"

namespace meniscus::benchmarks::quality {
namespace {

void refuse_unknown(const std::vector<std::string>& names, const std::vector<Shape>& shapes) {
    std::string known;
    for (const Shape& shape : shapes) known += (known.empty() ? "" : ", ") + shape.name;
    const auto unknown = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
        return std::none_of(shapes.begin(), shapes.end(), [&](const Shape& shape) { return shape.name == name; });
    });
    if (unknown != names.end()) throw InvalidInput("--shapes is " + *unknown + ", but must be of " + known);
}

Case make_case(const Shape& shape, Sampling sampling, double radius) {
    const std::string text(name_of(sampling));
    Case out;
    out.subject = {"shapes", shape.name, text};
    out.clouds.push_back(make_cloud(shape.name + "-" + text, sample(shape, sampling), radius));
    out.judge = [shape, particles = out.clouds[0].count()](const std::vector<Surface>& surfaces) {
        const compare::SurfaceView surface = surfaces[0].view();
        const Deviation d = judge(shape, surface, surfaces[0].normals, particles);
        std::vector<Figure> figures{{"offset_radii", d.offset},
                                    {"rms_radii", d.rms},
                                    {"worst_radii", d.worst},
                                    {"degrees", d.degrees},
                                    {"triangle_degrees", d.triangle_degrees},
                                    {"volume", d.volume},
                                    {"volume_of_particles", d.particle_volume},
                                    {"components", static_cast<double>(compare::find_components(surface).count())}};
        if (shape.layer && !shape.layer->level)
            figures.push_back({"thickness_at_end_radii", thickness_at_end(*shape.layer, surface)});
        return figures;
    };
    return out;
}

}  // namespace

std::vector<Case> shape_cases(const std::vector<std::string>& names, double radius) {
    const std::vector<Shape> shapes = make_shapes();
    refuse_unknown(names, shapes);
    std::vector<Case> cases;
    for (const Shape& shape : shapes) {
        if (!names.empty() && std::find(names.begin(), names.end(), shape.name) == names.end()) continue;
        for (const Sampling sampling : choices<Sampling>) cases.push_back(make_case(shape, sampling, radius));
    }
    return cases;
}

}  // namespace meniscus::benchmarks::quality
