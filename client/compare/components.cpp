#include "compare/components.hpp"

#include <limits>
#include <numeric>

namespace meniscus::compare {
namespace {

/// The vertex that stands for the part to which `vertex` belongs; shortens the way for later calls.
std::uint32_t find_root(std::vector<std::uint32_t>& parents, std::uint32_t vertex) {
    while (parents[vertex] != vertex) {
        parents[vertex] = parents[parents[vertex]];
        vertex = parents[vertex];
    }
    return vertex;
}

}  // namespace

Components find_components(SurfaceView surface) {
    std::vector<std::uint32_t> parents(surface.positions.size());
    std::iota(parents.begin(), parents.end(), 0U);
    for (const Triangle& t : surface.triangles)
        for (std::size_t i = 1; i < 3; ++i) {
            const std::uint32_t a = find_root(parents, t[0]);
            const std::uint32_t b = find_root(parents, t[i]);
            // The smaller root wins: with paths halved that is fast enough, and needs no ranks.
            if (a < b)
                parents[b] = a;
            else
                parents[a] = b;
        }

    constexpr std::uint32_t unnumbered = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> numbers(surface.positions.size(), unnumbered);
    std::vector<std::uint32_t> component_of;
    component_of.reserve(surface.triangles.size());
    Components components;
    components.starts.push_back(0);
    for (const Triangle& t : surface.triangles) {
        std::uint32_t& number = numbers[find_root(parents, t[0])];
        if (number == unnumbered) {
            number = static_cast<std::uint32_t>(components.starts.size() - 1);
            components.starts.push_back(0);
        }
        component_of.push_back(number);
        ++components.starts[number + 1];
    }
    std::partial_sum(components.starts.begin(), components.starts.end(), components.starts.begin());

    std::vector<std::uint32_t> ends(components.starts.begin(), components.starts.end() - 1);
    components.triangles.resize(surface.triangles.size());
    for (std::uint32_t i = 0; i < component_of.size(); ++i) components.triangles[ends[component_of[i]]++] = i;
    return components;
}

}  // namespace meniscus::compare
