#include "sessions/intake/open_edges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

/// An edge from its lower end to its upper one, or back.
template <class Vertex>
struct DirectedEdge {
    Vertex low{};
    Vertex high{};
    int direction = 0;  ///< 1 from low to high, -1 back

    static DirectedEdge of(const Vertex& from, const Vertex& to) {
        return from < to ? DirectedEdge{from, to, 1} : DirectedEdge{to, from, -1};
    }
    auto ends() const { return std::tie(low, high); }
};

/// Calls visit(edge, count) for each edge that goes `count` times more often from low to high than back, not 0. edges:
/// those of the same ends one behind the other.
template <class Vertex, class Visit>
void for_each_open(const Array<DirectedEdge<Vertex>>& edges, const Visit& visit) {
    for (std::size_t i = 0; i < edges.size();) {
        std::int64_t count = 0;
        const DirectedEdge<Vertex>& first = edges[i];
        for (; i < edges.size() && edges[i].ends() == first.ends(); ++i) count += edges[i].direction;
        if (count != 0) visit(first, count);
    }
}

/// All edges of the triangles, those of the same ends one behind the other. A vertex has few edges: once they are
/// counted into their places, little is left to sort.
Array<DirectedEdge<std::uint32_t>> grouped_edges(const DecodedBrick& brick,
                                                 const std::shared_ptr<MemoryAccount>& account) {
    using Edge = DirectedEdge<std::uint32_t>;
    const auto for_each_edge = [&](const auto& visit) {
        for (const Triangle& triangle : brick.triangles)
            for (std::size_t i = 0; i < 3; ++i) visit(Edge::of(triangle[i], triangle[(i + 1) % 3]));
    };
    // Of the edges before a vertex's own, then of these.
    Array<std::size_t> end(brick.vertices.size() + 1, 0, AccountAllocator<std::size_t>(account));
    for_each_edge([&](const Edge& edge) { ++end[edge.low + 1]; });
    std::partial_sum(end.begin(), end.end(), end.begin());
    Array<Edge> edges(3 * brick.triangles.size(), AccountAllocator<Edge>(account));
    for_each_edge([&](const Edge& edge) { edges[end[edge.low]++] = edge; });
    std::size_t first = 0;
    for (std::size_t vertex = 0; vertex < brick.vertices.size(); ++vertex) {
        std::sort(edges.begin() + static_cast<std::ptrdiff_t>(first),
                  edges.begin() + static_cast<std::ptrdiff_t>(end[vertex]),
                  [](const Edge& a, const Edge& b) { return a.high < b.high; });
        first = end[vertex];
    }
    return edges;
}

}  // namespace

OpenEdges open_edges(const DecodedBrick& brick, const std::shared_ptr<MemoryAccount>& account) {
    OpenEdges open(OpenEdges::allocator_type{account});
    for_each_open(grouped_edges(brick, account), [&](const DirectedEdge<std::uint32_t>& edge, std::int64_t count) {
        const LatticePosition& low = brick.vertices[edge.low];
        const LatticePosition& high = brick.vertices[edge.high];
        for (; count > 0; --count) open.push_back({low, high});
        for (; count < 0; ++count) open.push_back({high, low});
    });
    return open;
}

void require_closed(const std::vector<std::shared_ptr<const OpenEdges>>& bricks, const Mesh& mesh,
                    const std::shared_ptr<MemoryAccount>& account) {
    using Edge = DirectedEdge<LatticePosition>;
    Array<Edge> edges{AccountAllocator<Edge>(account)};
    std::size_t count = 0;
    for (const auto& open : bricks) count += open->size();
    edges.reserve(count);
    for (const auto& open : bricks)
        for (const auto& [from, to] : *open) edges.push_back(Edge::of(from, to));
    std::ranges::sort(edges, {}, [](const auto& edge) { return edge.ends(); });
    std::size_t unmatched = 0;
    std::array<double, 3> place{};
    for_each_open(edges, [&](const Edge& edge, std::int64_t /*count*/) {
        if (unmatched++ == 0) place = mesh.world(edge.low);
    });
    if (unmatched != 0)
        throw InvalidInput(
            fmt::format("the surface is not closed: {} edges have a triangle on one side alone, one of them at ({}, "
                        "{}, {}); publish "
                        "all bricks of the surface, each made from the particles of its surroundings",
                        unmatched, place[0], place[1], place[2]));
}

}  // namespace meniscus::server
