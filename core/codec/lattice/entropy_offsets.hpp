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

/// In place of a function that takes each prediction and what came of it: the program that makes the tables has one.
struct NoTraining {};

template <class Coder, class Training = NoTraining>
class OffsetCoder {
public:
    OffsetCoder(Coder& coder, const EntropyTables& tables) : coder_(coder), tables_(tables) {}

    Training training;

    /// All corners' signs are known. When it decodes, it fills the lattice's edges and the
    /// signs of their middles. offsets: by vertex number,
    /// in steps of c / 2^bits, bits at most most_coded_bits; read when it encodes.
    void run(BrickLattice& lattice, int bits, std::vector<std::uint8_t>& offsets) {
        lattice_ = &lattice;
        unit_ = 1 << bits;
        for (const std::uint16_t place : lattice.blocks()) middles_[place] = 0;
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

    static constexpr int column(int i, int j) { return (i + margin) + (j + margin) * side; }
    static constexpr int lateral_u(int axis) { return axis == 0 ? 1 : 0; }
    static constexpr int lateral_v(int axis) { return axis == 2 ? 1 : 2; }
    static int along(const Int3& at, int axis) { return axis == 0 ? at.x : axis == 1 ? at.y : at.z; }

    /// Calls visit(column, place along it, bit) for the edges of a block.
    template <class Visit>
    static void for_each_edge(int place, int axis, BlockMask edges, const Visit& visit) {
        if (edges == 0) return;
        const Int3 at = closed_coordinate(place);
        const int first =
            column(along(at, lateral_u(axis)) * base_cell_size, along(at, lateral_v(axis)) * base_cell_size);
        const int low = along(at, axis) * base_cell_size;
        for (; edges != 0; edges &= edges - 1) {
            const int bit = lowest_bit(edges);
            visit(first + point_coordinate(bit, lateral_u(axis)) + point_coordinate(bit, lateral_v(axis)) * side,
                  low + point_coordinate(bit, axis), bit);
        }
    }

    void take_offsets(int axis, const std::vector<std::uint8_t>& offsets) {
        std::array<std::uint8_t, std::size_t{columns}* points>& of_axis = (*offset_)[static_cast<std::size_t>(axis)];
        for (const std::uint16_t place : lattice_->blocks()) {
            const EdgeMasks& edges = lattice_->edges[place];
            const std::uint8_t* offset = offsets.data() + lattice_->first_vertex[place];
            for (int earlier = 0; earlier < axis; ++earlier) offset += popcount(edges.axis[earlier]);
            for_each_edge(place, axis, edges.axis[axis], [&](int col, int k, int) {
                of_axis[static_cast<std::size_t>(col * points + k)] = *offset++;
            });
        }
    }
    void give_offsets(std::vector<std::uint8_t>& offsets) const {
        std::uint8_t* offset = offsets.data();
        for (const std::uint16_t place : lattice_->blocks())
            for (int axis = 0; axis < 3; ++axis)
                for_each_edge(place, axis, lattice_->edges[place].axis[axis], [&](int col, int k, int) {
                    *offset++ = (*offset_)[static_cast<std::size_t>(axis)][static_cast<std::size_t>(col * points + k)];
                });
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
            if (levels.at_least[2] == 0) {  // level-1 edges alone
                list(place, axis, 2, used_edges(levels, axis, 1) & (own ^ next), own);
                continue;
            }
            const CrossedEdges crossed(own, next, levels, axis);
            list(place, axis, 2, crossed.length4, own);
            list(place, axis, 1, crossed.length2, own);
            list(place, axis, 0, crossed.length1, own);
        }
    }
    void list(int place, int axis, int length_index, BlockMask edges, BlockMask inside) {
        for_each_edge(place, axis, edges, [&](int col, int k, int bit) {
            to_code_[col].of_length[length_index] |= std::uint64_t{1} << k;
            low_inside_[col] |= (inside >> bit & 1) << k;
            listed_[static_cast<std::size_t>(col >> 6)] |= std::uint64_t{1} << (col & 63);
        });
    }
    /// The block and the bit of a column's lowest point.
    static std::array<int, 2> lowest_point(int axis, int col) {
        const int i = col % side - margin;
        const int j = col / side - margin;
        return {
            (i / base_cell_size) * closed_step(lateral_u(axis)) + (j / base_cell_size) * closed_step(lateral_v(axis)),
            i % base_cell_size * bit_step(lateral_u(axis)) + j % base_cell_size * bit_step(lateral_v(axis))};
    }
    /// Puts the finest edges of a column, which are known now, into their blocks.
    void give_edges(int axis, int col) {
        const auto [first, bit] = lowest_point(axis, col);
        for (std::uint64_t left = crossed_[col]; left != 0; left &= left - 1) {
            const int k = lowest_bit(left);
            lattice_->edges[first + k / base_cell_size * closed_step(axis)].axis[axis] |=
                BlockMask{1} << (bit + k % base_cell_size * bit_step(axis));
        }
    }

    void code_axis(int axis) {
        for (std::size_t w = 0; w < listed_.size(); ++w)
            for (std::uint64_t left = listed_[w]; left != 0; left &= left - 1) {
                const int col = static_cast<int>(64 * w) + lowest_bit(left);
                Edges& edges = to_code_[col];
                lowest_point_ = lowest_point(axis, col);
                coder_.reserve(static_cast<std::size_t>(
                    3 * (popcount(edges.of_length[0]) + popcount(edges.of_length[1]) + popcount(edges.of_length[2]))));
                for (std::uint64_t k = edges.of_length[2]; k != 0; k &= k - 1) code_edge<2>(axis, col, lowest_bit(k));
                for (std::uint64_t k = edges.of_length[1]; k != 0; k &= k - 1) code_edge<1>(axis, col, lowest_bit(k));
                for (std::uint64_t k = edges.of_length[0]; k != 0; k &= k - 1) code_edge<0>(axis, col, lowest_bit(k));
                edges = {};
            }
        for (std::size_t w = 0; w < listed_.size(); ++w) {
            for (std::uint64_t left = listed_[w]; left != 0; left &= left - 1) {
                const int col = static_cast<int>(64 * w) + lowest_bit(left);
                if constexpr (!Coder::encodes) give_edges(axis, col);
                crossed_[col] = low_inside_[col] = 0;
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
            const std::uint64_t alike = crossed_[beside] & (low_inside_[beside] ^ flip);
            const int up = std::countr_zero(alike >> middle);
            const int down = std::countl_zero(alike << (points - 1 - middle));
            const int there = (up <= down ? middle + up : middle - down) & (points - 1);
            const int has = std::min(up, down) <= reach ? 1 : 0;
            x[n] = unit_ * (there - k) + offsets[beside * points + there] - unit_ * length / 2;
            set |= has << n;
            return std::pair{has, static_cast<std::size_t>(beside * points + there)};
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
        const int regime = mean < 0 ? 2 : mean <= 2 * length ? 0 : mean <= 8 * length ? 1 : mean <= 26 * length ? 2 : 3;
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
        p.error_class = mean < 0      ? 10
                        : mean <= 1   ? 0
                        : mean <= 3   ? 1
                        : mean <= 6   ? 2
                        : mean <= 11  ? 3
                        : mean <= 20  ? 4
                        : mean <= 36  ? 5
                        : mean <= 64  ? 6
                        : mean <= 112 ? 7
                        : mean <= 200 ? 8
                                      : 9;
        p.expected_class = tables_.expected[length_index][regime][set];
        if constexpr (trains) seen_ = {set, regime, x};
        return p;
    }

    template <int length_index>
    void code_edge(int axis, int col, int k) {
        constexpr int length = 1 << length_index;
        const bool low_is_inside = (low_inside_[col] >> k & 1) != 0;
        const Prediction p = predict<length_index>(axis, col, k, low_is_inside);
        int at = k;
        for (int half = length / 2; half >= 1; half /= 2)
            if (crosses_upper_half(axis, at, half, low_is_inside, p, p.place - unit_ * (at - k))) at += half;
        const std::uint64_t bit = std::uint64_t{1} << at;
        if ((crossed_[col] & bit) != 0) return;  // a longer edge has come down to it
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
        crossed_[col] |= bit;
        if (low_is_inside) low_inside_[col] |= bit;
        const int place = unit_ * (at - k) + found;
        error_[static_cast<std::size_t>(col * points + at)] =
            static_cast<std::uint8_t>(std::min(std::abs(place - p.place), 255));
        if constexpr (trains)
            training(length_index, seen_.regime, seen_.set, seen_.x, place - unit_ * length / 2, unit_ * length);
    }

    /// Whether the sign changes in the upper half of the edge from `at` on, of twice the length `half`. Its middle is a
    /// corner, or is coded.
    bool crosses_upper_half(int axis, int at, int half, bool low_is_inside, const Prediction& p, int predicted) {
        const int place = lowest_point_[0] + at / base_cell_size * closed_step(axis);
        const int bit = lowest_point_[1] + (at % base_cell_size + half) * bit_step(axis);
        const BlockMask middle = BlockMask{1} << bit;
        BlockMask& inside = lattice_->inside[place];
        if (((lattice_->corners[place] | middles_[place]) & middle) != 0)
            return ((inside & middle) != 0) == low_is_inside;
        const int distance = (predicted - unit_ * half) * 64 / unit_;
        const int size = std::abs(distance);
        const int far = size < 1    ? 0
                        : size < 3  ? 1
                        : size < 5  ? 2
                        : size < 8  ? 3
                        : size < 12 ? 4
                        : size < 18 ? 5
                        : size < 28 ? 6
                                    : 7;
        const int context = ((half - 1) * 16 + (distance < 0 ? 7 - far : 8 + far)) * error_classes + p.error_class;
        bool upper = false;
        if constexpr (Coder::encodes) upper = ((inside & middle) != 0) == low_is_inside;
        upper = coder_.code(tables_.halves, context, upper ? 1 : 0) != 0;
        middles_[place] |= middle;
        if (upper == low_is_inside)
            inside |= middle;
        else
            inside &= ~middle;
        return upper;
    }

    struct Edges {
        std::uint64_t of_length[edge_lengths] = {};  ///< lower ends of those to be coded, by length index
    };
    using Bytes = std::array<std::uint8_t, std::size_t{columns} * points>;

    Coder& coder_;
    const EntropyTables& tables_;
    const SymbolIndex<residuals, edge_lengths * error_classes * expected_classes> index_{tables_.offsets};
    BrickLattice* lattice_ = nullptr;
    int unit_ = 0;
    ClosedArray<BlockMask> middles_;  ///< those coded so far
    Edges to_code_[columns];
    std::uint64_t crossed_[columns] = {};     ///< finest edges whose offset is known, of the axis that is being coded
    std::uint64_t low_inside_[columns] = {};  ///< edges whose low end is inside
    std::array<std::uint64_t, columns / 64 + 1> listed_{};
    std::unique_ptr<std::array<Bytes, 3>> offset_ = std::make_unique<std::array<Bytes, 3>>();
    Bytes error_{};                      ///< of the predictions
    std::array<int, 2> lowest_point_{};  ///< of the column that is being coded
    struct Seen {
        int set, regime;
        std::array<std::int32_t, predictor_neighbors> x;
    } seen_{};  ///< what the last prediction was made of, for a training
};

}  // namespace meniscus
