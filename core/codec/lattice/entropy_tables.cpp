// The numbers lie in tables/, which meniscus-bench lattice-tables writes, with the SHA-256 of the frames that they were
// made of: frequencies of symbols, context by context, whose sum is 4096. MENISCUS_EVEN_TABLES does without them, for
// the program that makes them after their sizes have changed: all symbols are alike likely then, and bricks are not to
// be sent.
#include "codec/lattice/entropy_tables.hpp"

#include <cstddef>
#include <iterator>

namespace meniscus {
namespace {

#ifdef MENISCUS_EVEN_TABLES

template <int symbols, int contexts>
constexpr void make_even(Distributions<symbols, contexts>& table) {
    for (auto& of_context : table.start)
        for (int symbol = 0; symbol < symbols; ++symbol)
            of_context[symbol] = static_cast<std::uint16_t>(probability_one * static_cast<unsigned>(symbol) / symbols);
}

constexpr EntropyTables make_tables() {
    EntropyTables tables{};
    make_even(tables.only_level);
    make_even(tables.rows);
    make_even(tables.cells);
    make_even(tables.levels);
    make_even(tables.fours);
    make_even(tables.twos);
    make_even(tables.ones);
    make_even(tables.coarser);
    make_even(tables.halves);
    make_even(tables.offsets);
    make_even(tables.normals);
    return tables;
}

#else

namespace numbers {

constexpr std::uint16_t only_level[] = {
#include "codec/lattice/tables/only_level.inc"
};
constexpr std::uint16_t rows[] = {
#include "codec/lattice/tables/rows.inc"
};
constexpr std::uint16_t cells[] = {
#include "codec/lattice/tables/cells.inc"
};
constexpr std::uint16_t levels[] = {
#include "codec/lattice/tables/levels.inc"
};
constexpr std::uint16_t fours_after_outside[] = {
#include "codec/lattice/tables/fours_after_outside.inc"
};
constexpr std::uint16_t fours_after_inside[] = {
#include "codec/lattice/tables/fours_after_inside.inc"
};
constexpr std::uint16_t twos[] = {
#include "codec/lattice/tables/twos.inc"
};
constexpr std::uint16_t ones[] = {
#include "codec/lattice/tables/ones.inc"
};
constexpr std::uint16_t coarser[] = {
#include "codec/lattice/tables/coarser.inc"
};
constexpr std::uint16_t halves[] = {
#include "codec/lattice/tables/halves.inc"
};
constexpr std::uint16_t offsets[] = {
#include "codec/lattice/tables/offsets.inc"
};
constexpr std::uint16_t normals[] = {
#include "codec/lattice/tables/normals.inc"
};
constexpr std::int16_t weights[] = {
#include "codec/lattice/tables/weights.inc"
};
constexpr std::uint8_t expected[] = {
#include "codec/lattice/tables/expected.inc"
};

}  // namespace numbers

/// Sets as many contexts as there are frequencies for, from `first` on. Returns the one behind them.
template <int symbols, int contexts, std::size_t count>
constexpr int set_some(Distributions<symbols, contexts>& table, const std::uint16_t (&frequencies)[count], int first) {
    static_assert(count % symbols == 0);
    int context = first;
    for (const std::uint16_t* frequency = frequencies; frequency != frequencies + count; ++context) {
        unsigned start = 0;
        for (std::uint16_t& of_symbol : table.start[context]) {
            of_symbol = static_cast<std::uint16_t>(start);
            start += *frequency++;
        }
    }
    return context;
}
template <int symbols, int contexts, std::size_t count>
constexpr void set(Distributions<symbols, contexts>& table, const std::uint16_t (&frequencies)[count]) {
    static_assert(count == std::size_t{symbols} * contexts,
                  "make the tables anew: tests/benchmarks/lattice_tables/train");
    set_some(table, frequencies, 0);
}

constexpr EntropyTables make_tables() {
    EntropyTables tables{};
    set(tables.only_level, numbers::only_level);
    set(tables.rows, numbers::rows);
    set(tables.cells, numbers::cells);
    set(tables.levels, numbers::levels);
    static_assert(std::size(numbers::fours_after_outside) + std::size(numbers::fours_after_inside) ==
                      std::size_t{tables.fours.symbol_count} * tables.fours.context_count,
                  "make the tables anew: tests/benchmarks/lattice_tables/train");
    set_some(tables.fours, numbers::fours_after_inside, set_some(tables.fours, numbers::fours_after_outside, 0));
    set(tables.twos, numbers::twos);
    set(tables.ones, numbers::ones);
    set(tables.coarser, numbers::coarser);
    set(tables.halves, numbers::halves);
    set(tables.offsets, numbers::offsets);
    set(tables.normals, numbers::normals);
    static_assert(std::size(numbers::weights) == sizeof tables.weights / sizeof(std::int16_t) &&
                      std::size(numbers::expected) == sizeof tables.expected,
                  "make the tables anew: tests/benchmarks/lattice_tables/train");
    const std::int16_t* weight = numbers::weights;
    const std::uint8_t* expected_class = numbers::expected;
    for (int length = 0; length < edge_lengths; ++length)
        for (int regime = 0; regime < regimes; ++regime)
            for (int neighbors = 0; neighbors < neighbor_sets; ++neighbors) {
                for (std::int16_t& of_neighbor : tables.weights[length][regime][neighbors]) of_neighbor = *weight++;
                tables.expected[length][regime][neighbors] = *expected_class++;
            }
    return tables;
}

#endif

}  // namespace

// While the program is compiled: the viewer's decoder starts at once.
constinit const EntropyTables entropy_tables = make_tables();

}  // namespace meniscus
