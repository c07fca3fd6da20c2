#include <algorithm>

#include "quality/cases.hpp"
#include "quality/groups.hpp"

namespace meniscus::benchmarks::quality {
namespace {

std::vector<Figure> judge_placements(const Group& group, const std::vector<Surface>& surfaces) {
    double sum = 0.0;
    std::vector<double> volumes;
    std::size_t lost = 0;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const GroupFigures found = judge_group(place(group, static_cast<int>(i)), surfaces[i].view());
        sum += found.volume;
        volumes.push_back(found.volume);
        lost = std::max(lost, found.lost);
    }
    return {{"volume", sum / static_cast<double>(volumes.size())},
            {"least_volume", *std::min_element(volumes.begin(), volumes.end())},
            {"most_volume", *std::max_element(volumes.begin(), volumes.end())},
            {"lost_particles", static_cast<double>(lost)}};
}

}  // namespace

std::vector<Case> group_cases(double radius) {
    std::vector<Case> cases;
    for (const Group& group : make_groups()) {
        Case out;
        out.subject = {"groups", group.name, ""};
        std::string file = "group-" + group.name;
        std::replace(file.begin(), file.end(), ' ', '-');
        for (int i = 0; i < placements; ++i)
            out.clouds.push_back(make_cloud(file + "-" + std::to_string(i), place(group, i), radius));
        out.judge = [group](const std::vector<Surface>& surfaces) { return judge_placements(group, surfaces); };
        cases.push_back(std::move(out));
    }
    return cases;
}

}  // namespace meniscus::benchmarks::quality
