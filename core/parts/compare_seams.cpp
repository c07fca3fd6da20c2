// A seam is equal where both of its parts have it, with the same hash.
#include "parts/compare_seams.hpp"

#include <algorithm>

namespace meniscus {
namespace {

std::size_t owner_of(const BrickCoordinate& brick, std::span<const BrickBox> own) {
    return static_cast<std::size_t>(
        std::find_if(own.begin(), own.end(), [&](const BrickBox& box) { return box.holds(brick); }) - own.begin());
}

}  // namespace

UnequalSeams compare_seams(std::vector<PartSeam> seams, std::span<const BrickBox> own) {
    const auto are_one = [](const PartSeam& a, const PartSeam& b) {
        return a.seam.first == b.seam.first && a.seam.second == b.seam.second;
    };
    std::sort(seams.begin(), seams.end(), [&](const PartSeam& a, const PartSeam& b) {
        return a.seam.first != b.seam.first     ? a.seam.first < b.seam.first
               : a.seam.second != b.seam.second ? a.seam.second < b.seam.second
                                                : a.part < b.part;
    });
    UnequalSeams unequal;
    for (std::size_t i = 0; i < seams.size();) {
        const bool are_two = i + 1 < seams.size() && are_one(seams[i], seams[i + 1]);
        const PartSeam& one = seams[i];
        i += are_two ? 2 : 1;
        if (are_two && seams[i - 1].seam.hash == one.seam.hash) continue;
        ++unequal.count;
        for (const BrickCoordinate& brick : {one.seam.first, one.seam.second})
            unequal.parts.push_back(owner_of(brick, own));
    }
    std::sort(unequal.parts.begin(), unequal.parts.end());
    unequal.parts.erase(std::unique(unequal.parts.begin(), unequal.parts.end()), unequal.parts.end());
    return unequal;
}

}  // namespace meniscus
