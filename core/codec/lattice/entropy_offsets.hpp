// The entropy profile's main section: the place of each vertex on its edge, predicted from edges beside it.
//
// Edges are coded axis by axis, column by column, in a column by length. A column is the line of lattice edges along
// the axis at two lateral coordinates. The surface is locally a height field over the lateral plane: an edge's
// neighbors are the nearest crossings of its orientation in columns coded before. One body codes and decodes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "codec/lattice/brick_lattice.hpp"
#include "codec/lattice/entropy_tables.hpp"

namespace meniscus {

/// Steps between two places on a finest edge that the coder tells apart: of finer ones the lowest bits are sent as they
/// are.
inline constexpr int most_coded_bits = 6;

/// For each number from 0 on how many of these ascending bounds lie below it. The last entry holds for all beyond.
template <int... bounds>
class Classes {
public:
    constexpr Classes() {
        for (int number = 0; number < count; ++number)
            class_[number] = static_cast<std::uint8_t>(((number > bounds) + ...));
    }
    constexpr int operator()(int number) const { return class_[std::min(number, count - 1)]; }

private:
    static constexpr int count = std::max({bounds...}) + 2;
    std::uint8_t class_[count] = {};
};

/// In place of a function that takes each prediction and what came of it: the program that makes the tables has one.
struct NoTraining {};

template <class Coder, class Training = NoTraining>
class OffsetCoder {
public:
    OffsetCoder(Coder& coder, const EntropyTables& tables) : coder_(coder), tables_(tables) {}

    Training training;

    /// All corners' signs are known. When it decodes, it fills the lattice's edges and the signs of their middles.
    /// offsets: by vertex number, in steps of c / 2^bits, bits at most most_coded_bits; read when it encodes.
    void run(BrickLattice& lattice, int bits, std::vector<std::uint8_t>& offsets) {
        lattice_ = &lattice;
        unit_ = 1 << bits;
        finest_steps_ = 1 << (most_coded_bits - bits);
        for (int axis = 0; axis < 3; ++axis) {
            if constexpr (Coder::encodes) take_offsets(axis, offsets);
            list_edges(axis);
            code_axis(axis);
        }
        if constexpr (!Coder::encodes) {
            offsets.resize(lattice.number_vertices());
            give_offsets(offsets);
        }
    }

private:
    static constexpr bool trains = !std::is_same_v<Training, NoTraining>;
    static constexpr int margin = 8;  ///< columns beyond the brick's sides that neighbors of its edges lie in
    static constexpr int side = closed_side * base_cell_size - base_cell_size + 1 + 2 * margin;
    static constexpr int columns = side * side;
    static constexpr int points = brick_cells;  ///< edges of a column

    /// Edges of a column to be coded, by their low ends.
    struct Edges {
        std::uint64_t of_length[edge_lengths] = {};  ///< by length index
        std::uint64_t finest = 0;                    ///< that they come down to, when it encodes
    };
    /// The known part of a column.
    struct Line {
        std::uint64_t crossed = 0;  ///< finest edges whose offset is known, by their low ends
        std::uint64_t inside = 0;   ///< points inside: low ends and middles of crossed edges
    };

    /// The number of an edge: points times its column, and its low end's place along that.
    static constexpr int edge_number(const Int3& at, int axis) {
        const int coordinate[3] = {at.x, at.y, at.z};
        const int col = (coordinate[lateral_u(axis)] + margin) + (coordinate[lateral_v(axis)] + margin) * side;
        return col * points + coordinate[axis];
    }
    /// Of the edge from a block's first point.
    static int first_edge(const Int3& block, int axis) {
        return edge_number({block.x * base_cell_size, block.y * base_cell_size, block.z * base_cell_size}, axis);
    }
    /// How much higher the number of the edge from that bit is.
    static int edge_step(int axis, int bit) {
        static constexpr auto steps = [] {
            std::array<std::array<std::int32_t, 64>, 3> all{};
            for (int along = 0; along < 3; ++along)
                for (int point = 0; point < 64; ++point)
                    all[static_cast<std::size_t>(along)][static_cast<std::size_t>(point)] =
                        edge_number(
                            {point_coordinate(point, 0), point_coordinate(point, 1), point_coordinate(point, 2)},
                            along) -
                        edge_number({0, 0, 0}, along);
            return all;
        }();
        return steps[static_cast<std::size_t>(axis)][static_cast<std::size_t>(bit)];
    }

    void take_offsets(int axis, const std::vector<std::uint8_t>& offsets) {
        std::array<std::uint8_t, std::size_t{columns}* points>& of_axis = (*offset_)[static_cast<std::size_t>(axis)];
        for (const std::uint16_t place : lattice_->blocks()) {
            const EdgeMasks& edges = lattice_->edges[place];
            const std::uint8_t* offset = offsets.data() + lattice_->first_vertex[place];
            for (int earlier = 0; earlier < axis; ++earlier) offset += popcount(edges.axis[earlier]);
            if (edges.axis[axis] == 0) continue;
            const int first = first_edge(closed_coordinate(place), axis);
            for (BlockMask left = edges.axis[axis]; left != 0; left &= left - 1) {
                const int edge = first + edge_step(axis, lowest_bit(left));
                of_axis[static_cast<std::size_t>(edge)] = *offset++;
                to_code_[edge / points].finest |= std::uint64_t{1} << edge % points;
            }
        }
    }
    void give_offsets(std::vector<std::uint8_t>& offsets) const {
        std::uint8_t* offset = offsets.data();
        for (const std::uint16_t place : lattice_->blocks()) {
            const EdgeMasks& edges = lattice_->edges[place];
            if (edges.count() == 0) continue;
            const Int3 at = closed_coordinate(place);
            for (int axis = 0; axis < 3; ++axis) {
                const std::uint8_t* const of_axis =
                    (*offset_)[static_cast<std::size_t>(axis)].data() + first_edge(at, axis);
                for (BlockMask left = edges.axis[axis]; left != 0; left &= left - 1)
                    *offset++ = of_axis[edge_step(axis, lowest_bit(left))];
            }
        }
    }

    /// Puts the crossed edges of all lengths into their columns, which are empty.
    void list_edges(int axis) {
        for (const std::uint16_t place : lattice_->blocks()) {
            const BlockMask own = lattice_->inside[place];
            const BlockMask next = lattice_->inside[place + closed_step(axis)];
            if (own == next && (own == 0 || own == ~BlockMask{0})) continue;
            const LevelsAround levels = lattice_->around(place);
            if (levels.own_is_finest()) {
                list(place, axis, 0, own ^ shifted(own, next, axis, 1), own);
                continue;
            }
            if (levels.at_least[2] == 0) {  // level-1 cells alone: one edge, which those without a step along it use
                static constexpr int beside[3] = {0x55, 0x33, 0x0F};
                if ((levels.at_least[1] & beside[axis]) != 0) list(place, axis, 2, (own ^ next) & 1, own);
                continue;
            }
            const CrossedEdges crossed(own, next, levels, axis);
            list(place, axis, 2, crossed.length4, own);
            list(place, axis, 1, crossed.length2, own);
            list(place, axis, 0, crossed.length1, own);
        }
    }
    void list(int place, int axis, int length_index, BlockMask edges, BlockMask inside) {
        if (edges == 0) return;
        const int first = first_edge(closed_coordinate(place), axis);
        for (; edges != 0; edges &= edges - 1) {
            const int bit = lowest_bit(edges);
            const int edge = first + edge_step(axis, bit);
            const int col = edge / points;
            to_code_[col].of_length[length_index] |= std::uint64_t{1} << edge % points;
            lines_[col].inside |= (inside >> bit & 1) << edge % points;
            listed_[static_cast<std::size_t>(col >> 6)] |= std::uint64_t{1} << (col & 63);
        }
    }
    /// Puts the finest edges of a column, which are known now, and the signs of the middles into their blocks.
    void give_edges(int axis, int col) {
        const int i = col % side - margin;
        const int j = col / side - margin;
        const int first =
            i / base_cell_size * closed_step(lateral_u(axis)) + j / base_cell_size * closed_step(lateral_v(axis));
        const int bit = i % base_cell_size * bit_step(lateral_u(axis)) + j % base_cell_size * bit_step(lateral_v(axis));
        const Line& line = lines_[col];
        for (std::uint64_t left = line.crossed; left != 0;) {
            const int low = lowest_bit(left) & -base_cell_size;
            const int place = first + low / base_cell_size * closed_step(axis);
            lattice_->edges[place].axis[axis] |= spread(axis, line.crossed >> low & ones(base_cell_size)) << bit;
            lattice_->inside[place] |= spread(axis, line.inside >> low & ones(base_cell_size)) << bit;
            left &= ~(ones(base_cell_size) << low);
        }
    }
    /// The points of a block's line along an axis, of one bit each.
    static BlockMask spread(int axis, std::uint64_t line) {
        static constexpr auto points_of_lines = [] {
            std::array<std::array<BlockMask, 1 << base_cell_size>, 3> all{};
            for (std::size_t along = 0; along < 3; ++along)
                for (std::size_t bits = 0; bits < all[along].size(); ++bits)
                    for (int i = 0; i < base_cell_size; ++i)
                        all[along][bits] |= BlockMask{bits >> i & 1} << i * bit_step(static_cast<int>(along));
            return all;
        }();
        return points_of_lines[static_cast<std::size_t>(axis)][line];
    }

    static constexpr std::uint64_t ones(int count) { return (std::uint64_t{1} << count) - 1; }

    void code_axis(int axis) {
        for (std::size_t w = 0; w < listed_.size(); ++w)
            for (std::uint64_t left = listed_[w]; left != 0; left &= left - 1) {
                const int col = static_cast<int>(64 * w) + lowest_bit(left);
                Edges& edges = to_code_[col];
                coder_.reserve(static_cast<std::size_t>(
                    3 * (popcount(edges.of_length[0]) + popcount(edges.of_length[1]) + popcount(edges.of_length[2]))));
                for (std::uint64_t k = edges.of_length[2]; k != 0; k &= k - 1)
                    code_edge<2>(axis, col, lowest_bit(k), edges);
                for (std::uint64_t k = edges.of_length[1]; k != 0; k &= k - 1)
                    code_edge<1>(axis, col, lowest_bit(k), edges);
                for (std::uint64_t k = edges.of_length[0]; k != 0; k &= k - 1)
                    code_edge<0>(axis, col, lowest_bit(k), edges);
                edges = {};
            }
        for (std::size_t w = 0; w < listed_.size(); ++w) {
            for (std::uint64_t left = listed_[w]; left != 0; left &= left - 1) {
                const int col = static_cast<int>(64 * w) + lowest_bit(left);
                if constexpr (!Coder::encodes) give_edges(axis, col);
                lines_[col] = {};
            }
            listed_[w] = 0;
        }
    }

    /// The prediction of a vertex's place on an edge of length 2^length_index finest cells.
    struct Prediction {
        int place;           ///< from the edge's low end, in steps of c / 2^bits
        int error_class;     ///< by the errors of the neighbors' predictions
        int expected_class;  ///< by the errors of such predictions in training
    };

    template <int length_index>
    Prediction predict(int axis, int col, int k, bool low_is_inside) {
        constexpr int length = 1 << length_index;
        const int middle = k + length / 2;
        const std::uint64_t flip = low_is_inside ? 0 : ~std::uint64_t{0};
        const std::uint8_t* const offsets = (*offset_)[static_cast<std::size_t>(axis)].data();
        std::array<std::int32_t, predictor_neighbors> x;
        if constexpr (trains) x = {};
        int set = 0;
        // Looks for a neighbor in the column `beside`. Returns its place as an index.
        const auto look = [&](std::size_t n, int beside, int reach) {
            const std::uint64_t alike = lines_[beside].crossed & (lines_[beside].inside ^ flip);
            const int up = std::countr_zero(alike >> middle);
            const int down = std::countl_zero(alike << (points - 1 - middle));
            const int there = (up <= down ? middle + up : middle - down) & (points - 1);
            const int has = std::min(up, down) <= reach ? 1 : 0;
            // A neighbor that is not there has no weight: any number does.
            const auto edge = static_cast<std::size_t>(-has & (beside * points + there));
            x[n] = unit_ * (there - k) + offsets[edge] - unit_ * length / 2;
            set |= has << n;
            return std::pair{has, edge};
        };
        constexpr int near[near_neighbors] = {-length, -length * side, -length * side - length,
                                              -length * side + length};
        int error = 0;
        for (std::size_t n = 0; n < near_neighbors; ++n) {
            const auto [has, at] = look(n, col + near[n], 3 * length);
            error += -has & error_[at];
        }
        const int count = popcount(static_cast<unsigned>(set));
        static constexpr int quarters[5] = {0, 48, 24, 16, 12};
        const int mean = count != 0 ? error * quarters[count] / 12 : -1;  // in quarters of a step
        static constexpr Classes<2 * length, 8 * length, 26 * length> regime_of;
        int regime = 2;
        if (mean >= 0) {
            if constexpr (length == 1)  // mostly the last edge's: branches let the processor run ahead of the sum
                regime = mean <= 2 ? 0 : mean <= 8 ? 1 : mean <= 26 ? 2 : 3;
            else
                regime = regime_of(mean);
        }
        const auto weighted_sum = [&](std::size_t neighbors) {
            const std::int16_t(&weight)[predictor_neighbors] = tables_.weights[length_index][regime][set];
            std::int32_t sum = 0;
            for (std::size_t n = 0; n < neighbors; ++n) sum += x[n] * weight[n];
            return sum;
        };
        std::int32_t sum = 0;
        if (length > 1 && count != 0) {
            // They tell how the surface bends, which is below the noise between finest edges.
            constexpr int far[far_neighbors] = {-2 * length, -2 * length * side};
            for (std::size_t n = 0; n < far_neighbors; ++n) look(near_neighbors + n, col + far[n], 4 * length);
            sum = weighted_sum(predictor_neighbors);
        } else {
            sum = weighted_sum(near_neighbors);
        }
        Prediction p;
        p.place = std::clamp(unit_ * length / 2 + ((sum + 2048) >> 12), 1, unit_ * length - 1);
        static constexpr Classes<1, 3, 6, 11, 20, 36, 64, 112, 200> error_class_of;
        p.error_class = mean < 0 ? error_classes - 1 : error_class_of(mean);
        p.expected_class = tables_.expected[length_index][regime][set];
        if constexpr (trains) seen_ = {set, regime, x};
        return p;
    }

    template <int length_index>
    void code_edge(int axis, int col, int k, const Edges& edges) {
        constexpr int length = 1 << length_index;
        Line& line = lines_[col];
        if ((line.crossed >> k & ones(length)) != 0) return;  // a longer edge has come down to it
        const bool low_is_inside = (line.inside >> k & 1) != 0;
        const Prediction p = predict<length_index>(axis, col, k, low_is_inside);
        int at = k;
        if constexpr (length == 4)
            if (crosses_upper_half<2>(edges, at, low_is_inside, p, p.place, line)) at += 2;
        if constexpr (length >= 2)
            if (crosses_upper_half<1>(edges, at, low_is_inside, p, p.place - unit_ * (at - k), line)) at += 1;
        const int predicted = p.place - unit_ * (at - k);
        const int inside_edge = std::clamp(predicted, 1, unit_ - 1);
        std::uint8_t& offset = (*offset_)[static_cast<std::size_t>(axis)][static_cast<std::size_t>(col * points + at)];
        // Beyond the upper end errors are turned, so that they point to the edge in both cases.
        const bool above = predicted > unit_ - 1;
        const int values = unit_ - 1;
        const int context = (length_index * error_classes + p.error_class) * expected_classes +
                            (predicted != inside_edge ? expected_classes - 1 : p.expected_class);
        int residual = 0;
        if constexpr (Coder::encodes) {
            residual = offset - inside_edge;
            if (above) residual = -residual;
            if (residual > values / 2) residual -= values;
            if (residual < -(values / 2)) residual += values;
        }
        residual = coder_.code(tables_.offsets, index_, context, residual + largest_residual) - largest_residual;
        int found = inside_edge + (above ? -residual : residual);
        if (found < 1) found += values;
        if (found > values) found -= values;
        // Only bytes that no encoder has written can be out of range still.
        found = std::clamp(found, 1, values);
        offset = static_cast<std::uint8_t>(found);
        line.crossed |= std::uint64_t{1} << at;
        line.inside |= std::uint64_t{low_is_inside} << at;
        const int place = unit_ * (at - k) + found;
        error_[static_cast<std::size_t>(col * points + at)] =
            static_cast<std::uint8_t>(std::min(std::abs(place - p.place), 255));
        if constexpr (trains)
            training(length_index, seen_.regime, seen_.set, seen_.x, place - unit_ * length / 2, unit_ * length);
    }

    /// Whether the sign changes in the upper half of the edge from `at` on, of twice the length `half`. Shorter edges
    /// on it tell, for then its middle is a corner; else it is coded.
    template <int half>
    bool crosses_upper_half(const Edges& edges, int at, bool low_is_inside, const Prediction& p, int predicted,
                            Line& line) {
        const std::uint64_t finest = edges.of_length[0] >> at;
        if constexpr (half == 2) {
            const std::uint64_t shorter = edges.of_length[1] >> at;
            if (((shorter | finest) & ones(4)) != 0) return ((shorter >> 2 | (finest >> 2 ^ finest >> 3)) & 1) != 0;
        } else {
            if ((finest & ones(2)) != 0) return (finest >> 1 & 1) != 0;
        }
        const int distance = (predicted - unit_ * half) * finest_steps_;
        static constexpr Classes<0, 2, 4, 7, 11, 17, 27> far_of;
        const int far = far_of(std::abs(distance));
        const int context = ((half - 1) * 16 + (distance < 0 ? 7 - far : 8 + far)) * error_classes + p.error_class;
        bool upper = false;
        if constexpr (Coder::encodes) upper = (edges.finest >> (at + half) & ones(half)) != 0;
        upper = coder_.code(tables_.halves, context, upper ? 1 : 0) != 0;
        line.inside |= std::uint64_t{upper == low_is_inside} << (at + half);
        return upper;
    }

    using Bytes = std::array<std::uint8_t, std::size_t{columns} * points>;

    Coder& coder_;
    const EntropyTables& tables_;
    const SymbolIndex<residuals, edge_lengths * error_classes * expected_classes> index_{tables_.offsets};
    BrickLattice* lattice_ = nullptr;
    int unit_ = 0;          ///< steps of a finest edge
    int finest_steps_ = 0;  ///< steps of the most coded bits in one of these
    Edges to_code_[columns];
    Line lines_[columns];  ///< of the axis that is being coded
    std::array<std::uint64_t, columns / 64 + 1> listed_{};
    std::unique_ptr<std::array<Bytes, 3>> offset_ = std::make_unique<std::array<Bytes, 3>>();
    Bytes error_{};  ///< of the predictions
    struct Seen {
        int set, regime;
        std::array<std::int32_t, predictor_neighbors> x;
    } seen_{};  ///< what the last prediction was made of, for a training
};

}  // namespace meniscus
