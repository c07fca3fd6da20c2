#include "simulator/adaptive_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace meniscus::simulator {
namespace {

/// A full cell holds eight particles at rest; moving water is a little looser in places.
constexpr std::size_t filled = 6;
constexpr std::size_t eight = 8;

class MergeGrid {
public:
    MergeGrid(std::span<const float> positions, float particle_radius, const Tank& tank)
        : cell_(4.0F * particle_radius) {
        for (std::size_t a = 0; a < 3; ++a) count_[a] = std::max(1, static_cast<int>(std::ceil(tank.size[a] / cell_)));
        members_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                        static_cast<std::size_t>(count_[2]));
        for (std::size_t i = 0; 3 * i < positions.size(); ++i) {
            std::array<int, 3> c{};
            for (std::size_t a = 0; a < 3; ++a)
                c[a] = std::clamp(static_cast<int>(positions[3 * i + a] / cell_), 0, count_[a] - 1);
            members_[index(c[0], c[1], c[2])].push_back(static_cast<std::uint32_t>(i));
        }
    }

    /// Calls visit(members, center of the cell) for every cell that is deep and holds enough to merge.
    template <class Visit>
    void visit_deep(const Visit& visit) {
        for (int z = 0; z < count_[2]; ++z)
            for (int y = 0; y < count_[1]; ++y)
                for (int x = 0; x < count_[0]; ++x) {
                    std::vector<std::uint32_t>& members = members_[index(x, y, z)];
                    if (members.size() < eight || !is_deep(x, y, z)) continue;
                    visit(members, Vector3{center(x), center(y), center(z)});
                }
    }

private:
    float center(int cell) const { return (static_cast<float>(cell) + 0.5F) * cell_; }

    bool is_deep(int x, int y, int z) const {
        if (x == 0 || y == 0 || z == 0 || x + 1 == count_[0] || y + 1 == count_[1] || z + 1 == count_[2]) return false;
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    if (members_[index(x + dx, y + dy, z + dz)].size() < filled) return false;
        return true;
    }

    std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(count_[0]) +
               static_cast<std::size_t>(x);
    }

    float cell_;
    std::array<int, 3> count_{};
    std::vector<std::vector<std::uint32_t>> members_;
};

}  // namespace

std::vector<float> LeveledParticles::merged(const std::vector<float>& values, std::size_t components) const {
    if (sources.empty()) return values;
    std::vector<float> out;
    out.reserve(components * levels.size());
    auto source = sources.begin();
    for (const std::uint8_t level : levels) {
        const std::size_t count = level == 0 ? 1 : eight;
        for (std::size_t c = 0; c < components; ++c) {
            float sum = 0.0F;
            for (std::size_t m = 0; m < count; ++m)
                sum += values[components * source[static_cast<std::ptrdiff_t>(m)] + c];
            out.push_back(sum / static_cast<float>(count));
        }
        source += static_cast<std::ptrdiff_t>(count);
    }
    return out;
}

LeveledParticles merge_deep_particles(std::span<const float> positions, float particle_radius, const Tank& tank) {
    MergeGrid grid(positions, particle_radius, tank);
    std::vector<bool> gone(positions.size() / 3, false);
    std::vector<float> coarse;
    std::vector<std::uint32_t> merged_sources;
    grid.visit_deep([&](std::vector<std::uint32_t>& members, const Vector3& center) {
        const auto distance = [&](std::size_t i) {
            const Vector3 d{positions[3 * i] - center[0], positions[3 * i + 1] - center[1],
                            positions[3 * i + 2] - center[2]};
            return dot(d, d);
        };
        std::stable_sort(members.begin(), members.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
        Vector3 sum{};
        for (std::size_t m = 0; m < eight; ++m) {
            gone[members[m]] = true;
            merged_sources.push_back(members[m]);
            for (std::size_t a = 0; a < 3; ++a) sum[a] += positions[3 * std::size_t{members[m]} + a];
        }
        for (const float s : sum) coarse.push_back(s / static_cast<float>(eight));
    });
    LeveledParticles out;
    for (std::size_t i = 0; i < gone.size(); ++i)
        if (!gone[i]) {
            out.positions.insert(out.positions.end(), positions.begin() + static_cast<std::ptrdiff_t>(3 * i),
                                 positions.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
            out.sources.push_back(static_cast<std::uint32_t>(i));
        }
    out.levels.assign(out.positions.size() / 3, 0);
    out.positions.insert(out.positions.end(), coarse.begin(), coarse.end());
    out.levels.resize(out.positions.size() / 3, 1);
    out.sources.insert(out.sources.end(), merged_sources.begin(), merged_sources.end());
    return out;
}

}  // namespace meniscus::simulator
