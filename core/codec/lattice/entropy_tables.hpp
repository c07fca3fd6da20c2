// The constant tables of the entropy profile. They are part of the format.
#pragma once

#include <cstdint>

#include "codec/lattice/rans.hpp"

namespace meniscus {

/// The neighbors by which an offset is predicted: edges beside it, coded before it. Coarse edges also have far ones.
inline constexpr int near_neighbors = 4;
inline constexpr int far_neighbors = 2;
inline constexpr int predictor_neighbors = near_neighbors + far_neighbors;
inline constexpr int neighbor_sets = 1 << predictor_neighbors;
inline constexpr int edge_lengths = 3;  ///< 1, 2, 4 finest cells
inline constexpr int regimes = 4;       ///< of the error nearby
inline constexpr int error_classes = 11;
inline constexpr int expected_classes = 6;
inline constexpr int flatness_classes = 6;
inline constexpr int normal_error_classes = 7;
inline constexpr int residuals = 63;  ///< symbols of a residual
inline constexpr int largest_residual = residuals / 2;

struct EntropyTables {
    // Numbers of contexts: without those of rows whose sign is known, two at each table's end.
    static constexpr int fours_of_both = 16 * 16 * 2 * 3;  ///< rows before along y and z, point before, corner between
    static constexpr int fours_of_one = 16 * 2;            ///< one of these rows, point before
    static constexpr int fours_known = fours_of_both + 2 * fours_of_one + 2;
    static constexpr int twos_known = 128 * 3;                 ///< the same in one number, corner between
    static constexpr int ones_of_corners = 3 * 3 * 3 * 5 * 3;  ///< neighbors, sum of nine more, seven alike
    static constexpr int ones_of_faces = 3 * 3 * 3 * 3;        ///< neighbors, kind of face

    Distributions<4, 1> only_level;                              ///< of all cells, where they have the same; less 1
    Distributions<2, 8> rows;                                    ///< whether a row of cells has any that draws
    Distributions<2, 8 * 7> cells;                               ///< whether a cell draws, where all have one level
    Distributions<5, 64 * 8 * 4> levels;                         ///< of a cell; 0: draws nothing
    Distributions<16, fours_known + 2> fours;                    ///< signs of four points in a row
    Distributions<4, twos_known + 2> twos;                       ///< signs of two points, two apart
    Distributions<2, ones_of_corners + ones_of_faces + 2> ones;  ///< sign of a single point
    Distributions<2, 4> coarser;                      ///< whether beyond the brick's face lies a coarser cell
    Distributions<2, 2 * 16 * error_classes> halves;  ///< whether a coarse edge crosses in its upper half
    Distributions<residuals, edge_lengths * error_classes * expected_classes> offsets;
    Distributions<residuals, 2 * flatness_classes * normal_error_classes> normals;
    /// Weights of the neighbors' places, in 1/4096, by length, regime and set of neighbors; their sum is 4096.
    std::int16_t weights[edge_lengths][regimes][neighbor_sets][predictor_neighbors];
    /// Class of the error to be expected of that prediction.
    std::uint8_t expected[edge_lengths][regimes][neighbor_sets];
};

extern const EntropyTables entropy_tables;

}  // namespace meniscus
