#include "compare/components.hpp"
#include "quality/cases.hpp"
#include "quality/roughness.hpp"

namespace meniscus::benchmarks::quality {

std::vector<Case> frame_cases(const FrameFiles& files, const std::vector<unsigned>& numbers) {
    std::vector<Case> cases;
    for (const unsigned number : numbers) {
        Case out;
        out.clouds.push_back(files.read(number));
        out.subject = {"frames", out.clouds[0].name, ""};
        out.judge = [](const std::vector<Surface>& surfaces) {
            const compare::SurfaceView surface = surfaces[0].view();
            const Roughness roughness = roughness_of(surface);
            return std::vector<Figure>{{"rms_degrees", roughness.rms},
                                       {"median_degrees", roughness.median},
                                       {"components", static_cast<double>(compare::find_components(surface).count())},
                                       {"triangles", static_cast<double>(surface.triangles.size())}};
        };
        cases.push_back(std::move(out));
    }
    return cases;
}

}  // namespace meniscus::benchmarks::quality
