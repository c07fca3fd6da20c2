// A seam is equal where both of its parts have it, with the same hash.
#include "parts/compare_seams.hpp"

#include <algorithm>

#include "lattice/brick_grid.hpp"

namespace meniscus {
namespace {

std::size_t owner_of(const BrickCoordinate& brick, std::span<const BrickBox> own) {
    return static_cast<std::size_t>(
        std::find_if(own.begin(), own.end(), [&](const BrickBox& box) { return box.holds(brick); }) - own.begin());
}

}  // namespace

UnequalSeams compare_seams(std::span<const PartSeam> seams, std::span<const BrickBox> own) {
    /// Small, for the sort.
    struct Place {
        std::uint64_t first, second;  ///< brick_key
        std::uint64_t part;
        const PartSeam* seam;
        bool is_of(const Place& o) const { return first == o.first && second == o.second; }
    };
    const auto key = [](const BrickCoordinate& b) { return brick_key({b[0], b[1], b[2]}); };
    std::vector<Place> places;
    places.reserve(seams.size());
    for (const PartSeam& its : seams) places.push_back({key(its.seam.first), key(its.seam.second), its.part, &its});
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
        return a.first != b.first ? a.first < b.first : a.second != b.second ? a.second < b.second : a.part < b.part;
    });
    UnequalSeams unequal;
    for (std::size_t i = 0; i < places.size();) {
        const bool are_two = i + 1 < places.size() && places[i].is_of(places[i + 1]);
        const Seam& one = places[i].seam->seam;
        i += are_two ? 2 : 1;
        if (are_two && places[i - 1].seam->seam.hash == one.hash) continue;
        ++unequal.count;
        for (const BrickCoordinate& brick : {one.first, one.second}) unequal.parts.push_back(owner_of(brick, own));
    }
    std::sort(unequal.parts.begin(), unequal.parts.end());
    unequal.parts.erase(std::unique(unequal.parts.begin(), unequal.parts.end()), unequal.parts.end());
    return unequal;
}

}  // namespace meniscus
