#include "simulator/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace meniscus::simulator {

CellGrid::CellGrid(const Vector3& size, float cell) : inverse_cell_(1.0F / cell) {
    std::size_t cells = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        count_[a] = std::max(1, static_cast<std::int32_t>(std::ceil(size[a] * inverse_cell_)));
        cells *= static_cast<std::size_t>(count_[a]);
    }
    starts_.resize(cells + 1);
}

std::array<std::int32_t, 3> CellGrid::cell_of(const Vector3& position) const {
    std::array<std::int32_t, 3> cell{};
    for (std::size_t a = 0; a < 3; ++a)
        cell[a] =
            static_cast<std::int32_t>(std::clamp(position[a] * inverse_cell_, 0.0F, static_cast<float>(count_[a] - 1)));
    return cell;
}

std::size_t CellGrid::index(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(x);
}

const std::vector<std::uint32_t>& CellGrid::sort(std::span<const Vector3> positions) {
    std::fill(starts_.begin(), starts_.end(), 0U);
    cells_.resize(positions.size());
    order_.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const auto [x, y, z] = cell_of(positions[i]);
        cells_[i] = static_cast<std::uint32_t>(index(x, y, z));
        ++starts_[cells_[i]];
    }
    std::uint32_t sum = 0;
    for (std::uint32_t& start : starts_) start = (sum += start);  // the end of each cell, for now
    for (std::size_t i = positions.size(); i-- > 0;) order_[--starts_[cells_[i]]] = static_cast<std::uint32_t>(i);
    return order_;
}

std::array<CellGrid::Run, 9> CellGrid::around(const Vector3& position) const {
    std::array<Run, 9> runs{};
    const auto [cx, cy, cz] = cell_of(position);
    const std::int32_t left = std::max(cx - 1, 0);
    const std::int32_t right = std::min(cx + 1, count_[0] - 1);
    std::size_t used = 0;
    for (std::int32_t z = std::max(cz - 1, 0); z <= std::min(cz + 1, count_[2] - 1); ++z)
        for (std::int32_t y = std::max(cy - 1, 0); y <= std::min(cy + 1, count_[1] - 1); ++y)
            runs[used++] = {starts_[index(left, y, z)], starts_[index(right, y, z) + 1]};
    return runs;
}

}  // namespace meniscus::simulator
