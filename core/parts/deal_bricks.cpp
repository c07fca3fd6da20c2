// Boxes of bricks for parts, by recursive bisection.
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

#include "lattice/brick_grid.hpp"
#include "meniscus/error.hpp"
#include "meniscus/parts.hpp"
#include "parts/brick_deal.hpp"

namespace meniscus {
namespace {

/// Few parts of few bricks, of which a cut can miss much, are cut by what can be made of both sides, which may get any
/// number of parts. Others are cut into halves, by what each side has for each part: many parts stay the most compact,
/// and many bricks take long to search.
constexpr std::size_t searched_parts = 4, searched_bricks = 512;
/// Cuts that are tried at most, the most promising ones first.
constexpr std::size_t most_tried = 16;

/// What all processes have in a brick.
struct Brick {
    BrickCoordinate at{};
    double work = 0.0;         ///< of the part whose it is
    double work_beside = 0.0;  ///< of each part that touches it, which gets its particles, too

    void add(const Brick& o) {
        work += o.work;
        work_beside += o.work_beside;
    }
};
using Bricks = std::vector<Brick>;

/// Makes one of those that lie at one place.
template <class T>
void add_up(std::vector<T>& sorted) {
    std::size_t last = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i].at == sorted[last].at)
            sorted[last].add(sorted[i]);
        else
            sorted[++last] = sorted[i];
    sorted.resize(std::min(sorted.size(), last + 1));
}

/// Those with work, by (z, y, x), so that sums do not depend on the order of the loads.
Bricks bricks_of(std::span<const BrickLoad> loads) {
    Bricks bricks;
    bricks.reserve(loads.size());
    for (const BrickLoad& load : loads)
        if (load.work() != 0)
            bricks.push_back({load.brick, static_cast<double>(load.work()), static_cast<double>(load.work_beside())});
    const auto key = [](const Brick& b) { return brick_key({b.at[0], b.at[1], b.at[2]}); };
    std::sort(bricks.begin(), bricks.end(), [&](const Brick& a, const Brick& b) { return key(a) < key(b); });
    add_up(bricks);
    return bricks;
}

/// A box that is to be cut, with the bricks in it and those that touch it.
struct Piece {
    BrickBox box;
    Bricks own, around;
    std::size_t parts = 1;
};

bool is_searched(const Piece& piece) {
    return piece.parts <= searched_parts && piece.parts <= piece.own.size() && piece.own.size() <= searched_bricks;
}

/// Without surface and particles there is nothing to do, whatever lies around.
double cost_of(double work, double beside) {
    return work == 0.0 ? 0.0 : work + beside;
}
double cost_of(const Piece& piece) {
    double work = 0.0, beside = 0.0;
    for (const Brick& brick : piece.own) work += brick.work;
    for (const Brick& brick : piece.around) beside += brick.work_beside;
    return cost_of(work, beside);
}

/// A plane between two layers of bricks.
struct Cut {
    std::size_t axis = 0;
    std::int32_t at = 0;  ///< the first layer above
    std::size_t parts_below = 0;
    double least = 0.0;  ///< that the part with most work has, however the sides are cut
};

/// The bricks that lie at one place along an axis.
struct Layer {
    std::int32_t at = 0;
    std::size_t bricks = 0;
    double work = 0.0, work_beside = 0.0;
    double around = 0.0;  ///< work_beside of those around the box

    void add(const Layer& o) {
        bricks += o.bricks;
        work += o.work;
        work_beside += o.work_beside;
        around += o.around;
    }
};

/// Ascending; some may have nothing.
std::vector<Layer> layers_of(const Piece& piece, std::size_t axis) {
    std::vector<Layer> layers;
    layers.reserve(piece.own.size() + piece.around.size());
    std::int32_t first = std::numeric_limits<std::int32_t>::max(), last = std::numeric_limits<std::int32_t>::min();
    for (const Bricks* const bricks : {&piece.own, &piece.around})
        for (const Brick& brick : *bricks) {
            first = std::min(first, brick.at[axis]);
            last = std::max(last, brick.at[axis]);
        }
    const auto own_layer = [axis](const Brick& b) { return Layer{b.at[axis], 1, b.work, b.work_beside, 0.0}; };
    const auto around_layer = [axis](const Brick& b) { return Layer{b.at[axis], 0, 0.0, 0.0, b.work_beside}; };
    // A table where they lie close together: sorting takes longer than all else of the deal.
    if (std::int64_t{last} - first < static_cast<std::int64_t>(piece.own.size())) {
        for (std::int32_t at = first; at <= last; ++at) layers.push_back({at});
        const auto layer_of = [&](const Brick& b) -> Layer& {
            return layers[static_cast<std::size_t>(b.at[axis] - first)];
        };
        for (const Brick& brick : piece.own) layer_of(brick).add(own_layer(brick));
        for (const Brick& brick : piece.around) layer_of(brick).add(around_layer(brick));
        return layers;
    }
    for (const Brick& brick : piece.own) layers.push_back(own_layer(brick));
    for (const Brick& brick : piece.around) layers.push_back(around_layer(brick));
    std::sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) { return a.at < b.at; });
    add_up(layers);
    return layers;
}

/// Numbers of parts.
struct PartCounts {
    std::size_t least = 1, most = 0;  ///< none if most is less
};

/// The numbers of parts that the lower side of a cut may get. share: of its work.
PartCounts counts_below(const Piece& piece, std::size_t bricks_below, double share) {
    const std::size_t parts = piece.parts, bricks_above = piece.own.size() - bricks_below;
    if (!is_searched(piece)) return {parts / 2, parts / 2};
    // So that no part need be empty.
    const std::size_t least = std::max<std::size_t>(parts - std::min(bricks_above, parts), 1);
    const std::size_t most = std::min(parts - 1, bricks_below);
    if (least > most) return {};
    const std::size_t even = std::clamp(static_cast<std::size_t>(static_cast<double>(parts) * share), least, most);
    return {even, std::min(even + 1, most)};
}

/// Adds those along an axis through or beside bricks.
void add_cuts(const Piece& piece, std::size_t axis, std::vector<Cut>& cuts) {
    const std::vector<Layer> layers = layers_of(piece, axis);
    Layer all;
    for (const Layer& layer : layers) all.add(layer);
    Layer under;  // all below the place
    const auto add = [&](std::int32_t at, const Layer& below, const Layer& above) {
        if (at <= piece.box.low[axis] || at >= piece.box.high[axis]) return;
        const double low = cost_of(under.work, under.around + above.around + above.work_beside);
        const double high =
            cost_of(all.work - under.work, all.around - under.around + below.around + below.work_beside);
        const PartCounts counts = counts_below(piece, under.bricks, low / (low + high));
        for (std::size_t k = counts.least; k <= counts.most; ++k)
            cuts.push_back(
                {axis, at, k, std::max(low / static_cast<double>(k), high / static_cast<double>(piece.parts - k))});
    };
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::int32_t at = layers[i].at;
        const bool is_after = i > 0 && layers[i - 1].at == at - 1;
        add(at, is_after ? layers[i - 1] : Layer{}, layers[i]);
        under.add(layers[i]);
        // Above it, where the next one is empty.
        if (i + 1 == layers.size() || layers[i + 1].at != at + 1) add(at + 1, layers[i], {});
    }
}

/// The most promising first.
std::vector<Cut> cuts_of(const Piece& piece) {
    std::vector<Cut> cuts;
    if (piece.own.empty()) return cuts;
    for (std::size_t axis = 0; axis < 3; ++axis) add_cuts(piece, axis, cuts);
    std::stable_sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.least < b.least; });
    return cuts;
}

/// Where there is nothing to weigh: the middle of the longest edge.
Cut middle_cut(const Piece& piece) {
    Cut cut;
    std::int32_t longest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (const std::int32_t edge = piece.box.high[axis] - piece.box.low[axis]; edge > longest) {
            longest = edge;
            cut = {axis, piece.box.low[axis] + edge / 2, piece.parts / 2};
        }
    return cut;
}

/// Below the cut, and above it.
std::array<Piece, 2> sides_of(const Piece& piece, const Cut& cut) {
    std::array<Piece, 2> sides;
    auto& [low, high] = sides;
    low.box = high.box = piece.box;
    low.box.high[cut.axis] = high.box.low[cut.axis] = cut.at;
    low.parts = cut.parts_below;
    high.parts = piece.parts - cut.parts_below;
    for (const Brick& brick : piece.own) {
        const std::int32_t at = brick.at[cut.axis];
        (at < cut.at ? low : high).own.push_back(brick);
        if (at == cut.at) low.around.push_back(brick);
        if (at == cut.at - 1) high.around.push_back(brick);
    }
    for (const Brick& brick : piece.around) {
        const std::int32_t at = brick.at[cut.axis];
        if (at <= cut.at) low.around.push_back(brick);
        if (at >= cut.at - 1) high.around.push_back(brick);
    }
    return sides;
}

double most_work_of(const Piece& piece);

/// The first of those whose part with most work has least.
Cut best_cut(const Piece& piece, const std::vector<Cut>& cuts) {
    // Of two parts a cut's least is what they have.
    if (piece.parts == 2 || !is_searched(piece)) return cuts.front();
    Cut best;
    best.least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < std::min(cuts.size(), most_tried) && cuts[i].least < best.least; ++i) {
        const std::array<Piece, 2> sides = sides_of(piece, cuts[i]);
        const double most = std::max(most_work_of(sides[0]), most_work_of(sides[1]));
        if (most >= best.least) continue;
        best = cuts[i];
        best.least = most;
    }
    return best;
}

double most_work_of(const Piece& piece) {
    if (piece.parts == 1) return cost_of(piece);
    const std::vector<Cut> cuts = cuts_of(piece);
    return cuts.empty() ? cost_of(piece) : best_cut(piece, cuts).least;
}

/// Deals the loads from `first` to `last`, which lie in the piece, and puts them in the order of their parts.
void deal(BrickDeal& to, std::size_t first, std::size_t last, const Piece& piece) {
    bool is_one_brick = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
        is_one_brick = is_one_brick && piece.box.high[axis] - piece.box.low[axis] == 1;
    if (piece.parts == 1 || is_one_brick) {
        to.boxes.push_back(piece.box);
        to.ends.push_back(last);
        return;
    }
    const std::vector<Cut> cuts = cuts_of(piece);
    const Cut cut = cuts.empty() ? middle_cut(piece) : best_cut(piece, cuts);
    const auto loads = std::span<BrickLoad>(to.loads).subspan(first, last - first);
    const auto above = std::partition(loads.begin(), loads.end(),
                                      [&](const BrickLoad& load) { return load.brick[cut.axis] < cut.at; });
    const std::size_t middle = first + static_cast<std::size_t>(above - loads.begin());
    const std::array<Piece, 2> sides = sides_of(piece, cut);
    deal(to, first, middle, sides[0]);
    deal(to, middle, last, sides[1]);
}

}  // namespace

BrickDeal deal_bricks(std::vector<BrickLoad> loads, std::size_t parts) {
    if (parts < 1 || parts > max_parts)
        throw InvalidInput("the parts are " + std::to_string(parts) + ", must be 1 to " + std::to_string(max_parts));
    BrickDeal dealt;
    dealt.loads = std::move(loads);
    deal(dealt, 0, dealt.loads.size(), {all_bricks, bricks_of(dealt.loads), {}, parts});
    return dealt;
}

}  // namespace meniscus
