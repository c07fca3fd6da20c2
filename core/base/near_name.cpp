#include "meniscus/near_name.hpp"

#include <algorithm>
#include <cstddef>

namespace meniscus {
namespace {

/// The least number of changes: the optimal string alignment distance.
std::size_t changes(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> least(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                least[i][j] = i + j;
                continue;
            }
            least[i][j] = std::min(
                {least[i - 1][j] + 1, least[i][j - 1] + 1, least[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                least[i][j] = std::min(least[i][j], least[i - 2][j - 2] + 1);
        }
    return least[a.size()][b.size()];
}

}  // namespace

std::string near_name(std::string_view name, const std::vector<std::string>& names) {
    constexpr std::size_t shortest_beginning = 3;
    std::size_t least = 2 + name.size() / 4;
    std::string nearest;
    for (const std::string& candidate : names) {
        // As many characters more or less take as many changes.
        if (name.size() >= candidate.size() + least) continue;
        const bool begun = name.size() >= shortest_beginning && candidate.starts_with(name);
        const std::size_t count = begun ? 1 : changes(name, candidate);
        if (count < least) {
            least = count;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string suggestion(const std::string& near, const std::string& list) {
    return near.empty() ? "; see " + list : ", did you mean " + near + "?";
}

}  // namespace meniscus
