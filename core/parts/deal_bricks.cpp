// Boxes of bricks for parts, by recursive bisection.
#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <utility>

#include "lattice/brick_grid.hpp"
#include "meniscus/error.hpp"
#include "meniscus/parts.hpp"
#include "particles/positions.hpp"
#include "parts/brick_counts.hpp"
#include "parts/brick_deal.hpp"

namespace meniscus {
namespace {

using Loads = std::span<BrickLoad>;

std::uint64_t work_of(std::span<const BrickLoad> loads) {
    std::uint64_t work = 0;
    for (const BrickLoad& load : loads) work += load.work();
    return work;
}

/// A plane between two layers of bricks.
struct Cut {
    std::size_t axis = 0;
    std::int32_t at = 0;  ///< the first layer above
    double cost = std::numeric_limits<double>::infinity();
};

/// The bricks that lie at one place along an axis.
struct Layer {
    std::int32_t at = 0;
    double work = 0.0;
};

/// Ascending; some may have no work.
std::vector<Layer> layers_of(std::span<const BrickLoad> loads, std::size_t axis) {
    std::vector<Layer> layers;
    if (loads.empty()) return layers;
    const auto by_axis = [axis](const BrickLoad& a, const BrickLoad& b) { return a.brick[axis] < b.brick[axis]; };
    const auto [low, high] = std::minmax_element(loads.begin(), loads.end(), by_axis);
    const std::int32_t first = low->brick[axis];
    const auto place_of = [&](const BrickLoad& load) { return static_cast<std::size_t>(load.brick[axis] - first); };
    // A table where they lie close together: sorting takes longer than all else of the deal.
    if (const std::size_t places = place_of(*high) + 1; places <= 4 * loads.size()) {
        layers.resize(places);
        for (const BrickLoad& load : loads) {
            Layer& layer = layers[place_of(load)];
            layer = {load.brick[axis], layer.work + static_cast<double>(load.work())};
        }
        std::erase_if(layers, [](const Layer& layer) { return layer.work == 0.0; });
        return layers;
    }
    for (const BrickLoad& load : loads) layers.push_back({load.brick[axis], static_cast<double>(load.work())});
    std::sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) { return a.at < b.at; });
    std::size_t last = 0;
    for (std::size_t i = 1; i < layers.size(); ++i)
        if (layers[i].at == layers[last].at)
            layers[last].work += layers[i].work;
        else
            layers[++last] = layers[i];
    layers.resize(last + 1);
    return layers;
}

/// The best of the cuts along an axis through bricks with work. below, above: numbers of parts on either side.
Cut best_cut(std::span<const BrickLoad> loads, const BrickBox& box, std::size_t axis, double below, double above) {
    const std::vector<Layer> layers = layers_of(loads, axis);
    const auto all = static_cast<double>(work_of(loads));
    Cut best{axis};
    double under = 0.0, layer_before = 0.0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const auto [at, layer] = layers[i];
        // Below this layer; and above it, where the next one is empty.
        const auto consider = [&](std::int32_t place, double work, double last, double next) {
            const double cost = std::max((work + next / 2.0) / below, (all - work + last / 2.0) / above);
            if (place > box.low[axis] && place < box.high[axis] && cost < best.cost) best = {axis, place, cost};
        };
        consider(at, under, layer_before, layer);
        under += layer;
        const bool is_next = i + 1 < layers.size() && layers[i + 1].at == at + 1;
        if (!is_next) consider(at + 1, under, layer, 0.0);
        layer_before = is_next ? layer : 0.0;
    }
    return best;
}

/// Where there is nothing to weigh: the middle of the longest edge.
Cut middle_cut(const BrickBox& box) {
    Cut cut;
    std::int32_t longest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (const std::int32_t edge = box.high[axis] - box.low[axis]; edge > longest) {
            longest = edge;
            cut = {axis, box.low[axis] + edge / 2, 0.0};
        }
    return cut;
}

/// Deals the loads from `first` to `last`, which lie in the box, and puts them in the order of their parts.
void deal(BrickDeal& to, std::size_t first, std::size_t last, const BrickBox& box, std::size_t parts) {
    bool is_one_brick = true;
    for (std::size_t axis = 0; axis < 3; ++axis) is_one_brick = is_one_brick && box.high[axis] - box.low[axis] == 1;
    if (parts == 1 || is_one_brick) {
        to.boxes.push_back(box);
        to.ends.push_back(last);
        return;
    }
    const Loads loads = Loads(to.loads).subspan(first, last - first);
    const std::size_t below = parts / 2;
    Cut cut;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Cut other = best_cut(loads, box, axis, static_cast<double>(below), static_cast<double>(parts - below));
        if (other.cost < cut.cost) cut = other;
    }
    if (loads.empty() || cut.cost == std::numeric_limits<double>::infinity()) cut = middle_cut(box);
    const auto above = std::partition(loads.begin(), loads.end(),
                                      [&](const BrickLoad& load) { return load.brick[cut.axis] < cut.at; });
    const std::size_t middle = first + static_cast<std::size_t>(above - loads.begin());
    BrickBox low = box, high = box;
    low.high[cut.axis] = high.low[cut.axis] = cut.at;
    deal(to, first, middle, low, below);
    deal(to, middle, last, high, parts - below);
}

}  // namespace

std::vector<BrickLoad> brick_loads(const ParticleFrame& frame, const Settings& settings, std::uint32_t rank,
                                   std::size_t each_stands_for) {
    const PositionsView positions = positions_view(frame, units_per_cell / world_cell_size(settings));
    constexpr auto edge = static_cast<std::uint64_t>(units_per_base_cell * brick_size);
    static_assert(std::has_single_bit(edge));
    const auto brick = [&](std::int64_t unit) { return static_cast<std::int32_t>(unit >> std::countr_zero(edge)); };
    BrickCounts counts;
    // The same place in each group would be one layer of particles that lie in rows: places follow the golden ratio.
    std::uint32_t fraction = 0;  // of 2^32
    for (std::size_t first = 0; first < frame.count(); first += each_stands_for) {
        const std::size_t group = std::min(each_stands_for, frame.count() - first);
        const Units3 p = positions.snapped(first + static_cast<std::size_t>(group * std::uint64_t{fraction} >> 32));
        fraction += 0x9E3779B9U;
        counts.add(brick_key({brick(p.x), brick(p.y), brick(p.z)}), group);
    }
    std::vector<BrickCounts::Count> all = counts.take();
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    std::vector<BrickLoad> loads;
    loads.reserve(all.size());
    for (const BrickCounts::Count& count : all) {
        const Int3 at = brick_coordinate(count.key);
        loads.push_back({{at.x, at.y, at.z}, rank, static_cast<std::uint32_t>(count.particles), 0});
    }
    return loads;
}

BrickDeal deal_bricks(std::vector<BrickLoad> loads, std::size_t parts) {
    if (parts < 1 || parts > max_parts)
        throw InvalidInput("the parts are " + std::to_string(parts) + ", must be 1 to " + std::to_string(max_parts));
    BrickDeal dealt;
    dealt.loads = std::move(loads);
    deal(dealt, 0, dealt.loads.size(), all_bricks, parts);
    return dealt;
}

}  // namespace meniscus
