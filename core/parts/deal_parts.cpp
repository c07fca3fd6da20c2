// Parts go to where most of their particles are, so that these need not be sent.
#include <algorithm>
#include <tuple>

#include "parts/brick_deal.hpp"

namespace meniscus {
namespace {

constexpr std::size_t nobody = ~std::size_t{0};

/// What a maker has of a part.
struct Share {
    std::uint64_t particles = 0;
    std::size_t part = 0;
    std::size_t maker = 0;  ///< its place among the makers

    /// The largest first.
    bool operator<(const Share& o) const {
        return std::tuple(o.particles, part, maker) < std::tuple(particles, o.part, o.maker);
    }
};

std::vector<Share> shares_of(const BrickDeal& deal, std::span<const std::size_t> makers) {
    std::vector<Share> shares;
    std::vector<std::uint64_t> particles(makers.size());
    std::vector<std::size_t> found;
    for (std::size_t part = 0; part < deal.boxes.size(); ++part) {
        for (const BrickLoad& load : deal.loads_of(part)) {
            if (load.particles == 0) continue;
            const auto after = std::upper_bound(makers.begin(), makers.end(), std::size_t{load.rank});
            const auto maker = static_cast<std::size_t>(std::max(after - makers.begin(), std::ptrdiff_t{1}) - 1);
            if (particles[maker] == 0) found.push_back(maker);
            particles[maker] += load.particles;
        }
        for (const std::size_t maker : found) {
            shares.push_back({particles[maker], part, maker});
            particles[maker] = 0;
        }
        found.clear();
    }
    std::sort(shares.begin(), shares.end());
    return shares;
}

}  // namespace

std::vector<std::size_t> deal_parts(const BrickDeal& deal, std::span<const std::size_t> makers) {
    const std::size_t parts = deal.boxes.size();
    if (makers.size() == 1) return std::vector<std::size_t>(parts, makers[0]);
    std::vector<std::size_t> left(makers.size());
    for (std::size_t part = 0; part < parts; ++part) ++left[part * makers.size() / parts];
    std::vector<std::size_t> rank_of(parts, nobody);
    for (const Share& share : shares_of(deal, makers))
        if (rank_of[share.part] == nobody && left[share.maker] != 0) {
            rank_of[share.part] = makers[share.maker];
            --left[share.maker];
        }
    std::size_t next = 0;
    for (std::size_t& rank : rank_of) {
        if (rank != nobody) continue;
        while (left[next] == 0) ++next;
        rank = makers[next];
        --left[next];
    }
    return rank_of;
}

}  // namespace meniscus
