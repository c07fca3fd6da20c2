#include "trainer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iostream>
#include <map>
#include <span>
#include <stdexcept>
#include <string>

#include "codec/lattice/brick_header.hpp"
#include "codec/lattice/brick_mesh.hpp"
#include "codec/lattice/entropy_normals.hpp"
#include "codec/lattice/entropy_offsets.hpp"
#include "codec/lattice/entropy_signs.hpp"
#include "codec/lattice/packed.hpp"

namespace meniscus::benchmarks {
namespace {

constexpr int offset_bits = 6;

/// A coder that counts the symbols of each context.
class Counter {
public:
    static constexpr bool encodes = true;

    explicit Counter(const EntropyTables& tables) : tables_(reinterpret_cast<const std::uint16_t*>(&tables)) {}
    void reserve(std::size_t) {}
    template <int symbols, int contexts>
    int code(const Distributions<symbols, contexts>& table, int context, int symbol) {
        ++counts_[static_cast<std::size_t>(&table.start[context][symbol] - tables_)];
        return symbol;
    }
    template <int symbols, int contexts>
    int code(const Distributions<symbols, contexts>& table, const SymbolIndex<symbols, contexts>&, int context,
             int symbol) {
        return code(table, context, symbol);
    }
    void clear() { std::fill(counts_.begin(), counts_.end(), 0); }
    std::span<const std::uint64_t> counts_of(const void* table, std::size_t size) const {
        return {counts_.data() + (static_cast<const std::uint16_t*>(table) - tables_), size};
    }

private:
    const std::uint16_t* tables_;
    std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(sizeof(EntropyTables) / 2);
};

/// Least squares for the weights of one set of neighbors: places relative to the first neighbor's.
struct Sums {
    double count = 0.0;
    std::array<double, predictor_neighbors> xy{};
    std::array<std::array<double, predictor_neighbors>, predictor_neighbors> xx{};
    double squared_errors = 0.0;  ///< of the present weights, per finest cell

    void add(int set, const std::array<std::int32_t, predictor_neighbors>& x, std::int32_t y, int length_in_steps,
             const std::int16_t (&weight)[predictor_neighbors]) {
        const double unit = length_in_steps;
        const auto base = static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(set)));
        const double from_base = (y - x[base]) / unit;
        double predicted = 0.0;
        count += 1.0;
        for (std::size_t i = 0; i < predictor_neighbors; ++i) {
            if ((set >> i & 1) == 0) continue;
            predicted += x[i] * (weight[i] / 4096.0);
            const double xi = (x[i] - x[base]) / unit;
            xy[i] += xi * from_base;
            for (std::size_t j = 0; j < predictor_neighbors; ++j)
                if ((set >> j & 1) != 0) xx[i][j] += xi * ((x[j] - x[base]) / unit);
        }
        squared_errors += (predicted - y) / unit * ((predicted - y) / unit);
    }
    /// Differences from the first neighbor, solved by elimination with a ridge that decides where nothing is known.
    std::array<double, predictor_neighbors> weights(int set) const {
        std::array<std::array<double, predictor_neighbors + 1>, predictor_neighbors> rows{};
        const auto base = static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(set)));
        for (std::size_t i = 0; i < predictor_neighbors; ++i) {
            const bool takes_part = (set >> i & 1) != 0 && i != base;
            for (std::size_t j = 0; j < predictor_neighbors; ++j)
                rows[i][j] = takes_part && (set >> j & 1) != 0 && j != base ? xx[i][j] : 0.0;
            rows[i][i] += takes_part ? 1e-3 * count + 1e-6 : 1.0;
            rows[i][predictor_neighbors] = takes_part ? xy[i] : 0.0;
        }
        for (std::size_t i = 0; i < predictor_neighbors; ++i)
            for (std::size_t r = 0; r < predictor_neighbors; ++r) {
                if (r == i) continue;
                const double factor = rows[r][i] / rows[i][i];
                for (std::size_t c = 0; c <= predictor_neighbors; ++c) rows[r][c] -= factor * rows[i][c];
            }
        std::array<double, predictor_neighbors> result{};
        double rest = 1.0;
        for (std::size_t i = 0; i < predictor_neighbors; ++i) {
            if ((set >> i & 1) == 0 || i == base) continue;
            result[i] = rows[i][predictor_neighbors] / rows[i][i];
            rest -= result[i];
        }
        result[base] = rest;
        return result;
    }
};

struct Training {
    using AllSums = std::array<std::array<std::array<Sums, neighbor_sets>, regimes>, edge_lengths>;
    std::shared_ptr<AllSums> sums = std::make_shared<AllSums>();
    const EntropyTables* tables = nullptr;

    void operator()(int length_index, int regime, int set, const std::array<std::int32_t, predictor_neighbors>& x,
                    std::int32_t y, int length_in_steps) const {
        if (set == 0) return;
        (*sums)[static_cast<std::size_t>(length_index)][static_cast<std::size_t>(regime)][static_cast<std::size_t>(set)]
            .add(set, x, y, length_in_steps, tables->weights[length_index][regime][set]);
    }
};

/// Weights of sets of which too little was seen: a plane through three neighbors, else their mean.
void set_default_weights(EntropyTables& tables) {
    for (auto& of_length : tables.weights)
        for (auto& of_regime : of_length)
            for (unsigned set = 0; set < neighbor_sets; ++set) {
                std::int16_t(&weight)[predictor_neighbors] = of_regime[set];
                const int count = std::popcount(set);
                int rest = 4096;
                for (unsigned n = predictor_neighbors; n-- > 0;) {
                    const bool has = (set >> n & 1) != 0;
                    const bool is_last = (set & ((1U << n) - 1)) == 0;
                    int w = has ? is_last ? rest : 4096 / count : 0;
                    if ((set & 7) == 7) w = n == 2 ? -4096 : n < 2 ? 4096 : 0;  // W, N, NW
                    weight[n] = static_cast<std::int16_t>(w);
                    rest -= w;
                }
            }
}

int expected_class(double rms_in_steps) {
    return rms_in_steps < 0.9 ? 0 : rms_in_steps < 2 ? 1 : rms_in_steps < 4 ? 2 : rms_in_steps < 8 ? 3 : 4;
}

class Trainer {
public:
    explicit Trainer(const std::vector<EncodedBrick>& bricks) : bricks_(bricks) {}

    std::unique_ptr<EntropyTables> run() {
        set_default_weights(tables());
        for (auto& of_length : tables().expected)
            for (auto& of_regime : of_length)
                for (std::uint8_t& expected : of_regime) expected = 4;
        // Regimes follow from errors, and errors from weights: a few rounds settle both.
        for (int round = 0; round < 3; ++round) {
            count_all();
            take_weights();
        }
        count_all();
        take_expected();
        count_all();
        take_distributions();
        return std::move(tables_);
    }

    std::vector<std::pair<std::string, double>> cost() {
        *tables_ = entropy_tables;
        count_all();
        std::vector<std::pair<std::string, double>> bits;
        const auto add = [&](const char* name, const auto& table) { bits.emplace_back(name, cost_of(table)); };
        add("rows", tables_->rows);
        add("cells", tables_->cells);
        add("levels", tables_->levels);
        add("fours", tables_->fours);
        add("twos", tables_->twos);
        add("ones", tables_->ones);
        add("coarser", tables_->coarser);
        add("halves", tables_->halves);
        add("offsets", tables_->offsets);
        add("normals", tables_->normals);
        return bits;
    }

private:
    EntropyTables& tables() { return *tables_; }

    template <int symbols, int contexts>
    double cost_of(const Distributions<symbols, contexts>& table) const {
        const auto counts = counter_.counts_of(&table, std::size_t{symbols} * contexts);
        double bits = 0.0;
        for (int c = 0; c < contexts; ++c)
            for (int s = 0; s < symbols; ++s) {
                const double frequency = table.end(c, s) - std::uint32_t{table.start[c][s]};
                const double count = static_cast<double>(counts[static_cast<std::size_t>(c * symbols + s)]);
                if (count > 0.0) bits += count * (probability_bits - std::log2(frequency));
            }
        return bits;
    }

    void count_all() {
        counter_.clear();
        offset_coder_->training.sums = std::make_shared<Training::AllSums>();
        offset_coder_->training.tables = tables_.get();
        for (const EncodedBrick& encoded : bricks_) {
            LatticeBrick& brick = *brick_;
            brick.clear();
            const auto header = BrickHeader::read(encoded.data);
            const char* const fault = read_packed(*header, std::span(encoded.data).subspan(BrickHeader::size),
                                                  {.vertices = encoded.vertices,
                                                   .triangles = encoded.triangles,
                                                   .offset_bits = offset_bits,
                                                   .attribute_bytes = {}},
                                                  brick);
            if (fault != nullptr) throw std::runtime_error(std::string("a training brick ") + fault);
            make_mesh(brick, {}, encoded.triangles);
            BrickLattice& lattice = brick.lattice;
            const int level = lattice.only_level();
            if (level != 0) counter_.code(tables().only_level, 0, level - 1);
            code_cells(counter_, tables(), lattice, level);
            sign_coder_->run(lattice);
            code_coarser_faces(counter_, tables(), lattice);
            offset_coder_->run(lattice, offset_bits, brick.offsets);
            if (brick.normal_bits != 0) {
                const auto keep = [](std::uint32_t value, int) { return static_cast<int>(value); };
                code_normals(counter_, tables(), *normal_index_, keep, normals_, brick);
            }
        }
    }

    void take_weights() {
        for (std::size_t length = 0; length < edge_lengths; ++length)
            for (std::size_t regime = 0; regime < regimes; ++regime)
                for (std::size_t set = 1; set < neighbor_sets; ++set) {
                    const Sums& sums = (*offset_coder_->training.sums)[length][regime][set];
                    if (sums.count < 100) continue;
                    const auto weights = sums.weights(static_cast<int>(set));
                    std::int16_t(&out)[predictor_neighbors] = tables().weights[length][regime][set];
                    int rest = 4096;
                    const auto base = static_cast<std::size_t>(std::countr_zero(set));
                    for (std::size_t n = 0; n < predictor_neighbors; ++n) {
                        out[n] =
                            n == base
                                ? std::int16_t{0}
                                : static_cast<std::int16_t>(std::lround(std::clamp(weights[n], -4.0, 4.0) * 4096.0));
                        rest -= out[n];
                    }
                    out[base] = static_cast<std::int16_t>(rest);
                }
    }

    void take_expected() {
        for (std::size_t length = 0; length < edge_lengths; ++length)
            for (std::size_t regime = 0; regime < regimes; ++regime)
                for (std::size_t set = 0; set < neighbor_sets; ++set) {
                    const Sums& sums = (*offset_coder_->training.sums)[length][regime][set];
                    tables().expected[length][regime][set] =
                        set == 0 || sums.count < 50
                            ? std::uint8_t{4}
                            : static_cast<std::uint8_t>(
                                  expected_class(std::sqrt(sums.squared_errors / sums.count) * 64.0 * (1U << length)));
                }
    }

    template <int symbols, int contexts>
    void take(Distributions<symbols, contexts>& table, double prior, bool symmetric = false) {
        const auto counts = counter_.counts_of(&table, std::size_t{symbols} * contexts);
        std::array<double, symbols> all{};
        double total = 1e-9;
        for (std::size_t i = 0; i < counts.size(); ++i) all[i % symbols] += static_cast<double>(counts[i]);
        for (double& a : all) total += a += 1e-3;
        for (int c = 0; c < contexts; ++c) {
            std::array<double, symbols> p{};
            double sum = 0.0;
            for (std::size_t s = 0; s < symbols; ++s) {
                const std::size_t at = static_cast<std::size_t>(c) * symbols;
                p[s] = static_cast<double>(counts[at + s]) + prior * all[s] / total;
                if (symmetric)
                    p[s] += static_cast<double>(counts[at + symbols - 1 - s]) + prior * all[symbols - 1 - s] / total;
                sum += p[s];
            }
            // Every symbol keeps some probability, and the likeliest gives or takes what rounding leaves.
            std::array<int, symbols> frequency{};
            int left = static_cast<int>(probability_one);
            std::size_t likeliest = 0;
            for (std::size_t s = 0; s < symbols; ++s) {
                frequency[s] = 1 + static_cast<int>(p[s] / sum * (probability_one - symbols));
                left -= frequency[s];
                if (frequency[s] > frequency[likeliest]) likeliest = s;
            }
            frequency[likeliest] += left;
            int start = 0;
            for (std::size_t s = 0; s < symbols; ++s) {
                table.start[c][s] = static_cast<std::uint16_t>(start);
                start += frequency[s];
            }
        }
    }
    void take_distributions() {
        take(tables().only_level, 1);
        take(tables().rows, 1);
        take(tables().cells, 1);
        take(tables().levels, 2);
        take(tables().fours, 4);
        take(tables().twos, 2);
        take(tables().ones, 1);
        take(tables().coarser, 1);
        take(tables().halves, 1);
        take(tables().offsets, 20, true);
        take(tables().normals, 20, true);
    }

    const std::vector<EncodedBrick>& bricks_;
    std::unique_ptr<EntropyTables> tables_ = std::make_unique<EntropyTables>();
    Counter counter_{*tables_};
    std::unique_ptr<SignCoder<Counter>> sign_coder_ = std::make_unique<SignCoder<Counter>>(counter_, *tables_);
    std::unique_ptr<OffsetCoder<Counter, Training>> offset_coder_ =
        std::make_unique<OffsetCoder<Counter, Training>>(counter_, *tables_);
    std::unique_ptr<LatticeBrick> brick_ = std::make_unique<LatticeBrick>();
    std::vector<PredictedNormal> normals_;
    std::unique_ptr<NormalIndex> normal_index_ = std::make_unique<NormalIndex>(tables_->normals);  // asked by decoders
};

}  // namespace

std::vector<std::pair<std::string, double>> bits_by_table(const std::vector<EncodedBrick>& bricks) {
    return Trainer(bricks).cost();
}

std::unique_ptr<EntropyTables> train_tables(const std::vector<EncodedBrick>& bricks) {
    return Trainer(bricks).run();
}

}  // namespace meniscus::benchmarks
