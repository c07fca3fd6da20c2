// The spacing of particles is measured at some of them, by one pass over all: their nearest others are found in a
// hashed grid that holds those few.
#include "particles/spacing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "meniscus/number_text.hpp"

namespace meniscus {
namespace {

// Distances are in radii of the particles. Measured: core/README.md#warnings.
constexpr std::size_t fewest_particles = 100;
constexpr std::size_t neighbors = 6;  ///< the distance of the sixth is the same in a lattice, in water and at random
constexpr double usual_sixth = 2.3;
constexpr double near_sixth = 1.1;  ///< the radius is too large if the sixth's distance of most is below it,
constexpr double far_sixth = 4.5;   ///< and may be too small if the sixth's distance of most is above it,
constexpr double company = 2.0;     ///< and if few have another within this distance
constexpr double few = 0.15;
constexpr double close_by =
    0.4;  ///< of the sixth's distance: of particles at random 0.28 have their nearest within it,
constexpr double close_at_random = 0.28;
constexpr double certainty = 3.0;  ///< of water at most 0.13; fewer by this number of standard deviations are water
constexpr double nearest_at_rest = 2.4;  ///< a little beyond the nearest of particles at rest in any packing
// Scattered particles are no water at this radius, whatever they are at another.
constexpr double touching = 2.0;
constexpr double joined = 2.7;  ///< within it the smooth field joins two particles
constexpr double around = 3.0;  ///< a particle among others has its sixth within it, in a film and at a corner, too,
constexpr double hardly_any = 0.05;  ///< fewer than these have, where particles are scattered,
constexpr double lone = 0.15;        ///< and more than these are joined to none: of a thread of particles none is
constexpr double last_reach = 1.2;   ///< reach of the last pass, times the sixth's distance in the median
constexpr double reach_growth = 2.0;
constexpr int most_passes = 20;  ///< up to two million radii: units that are confused, such as mm and m

constexpr std::size_t most_probes = 512;
/// Probes enough to see that a radius fits, and to measure the spacing; all are asked whether the particles are water.
constexpr std::size_t first_probes = 32;
constexpr std::size_t fewest_probes = 16;
constexpr std::size_t particles_per_probe = 128;

/// Some particles of one level, and the nearest others of that level for each.
class Probes {
public:
    Probes(const ParticleFrame& frame, std::uint8_t level) : frame_(frame), level_(level) {
        const Box& box = frame.quantization_box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low_[axis] = box.min[axis];
            step_[axis] = (box.max[axis] - box.min[axis]) / 65535.0;
        }
    }

    /// Draws as many of the frame's particles (those of the level count), spread over the frame in the same way each
    /// time, and finds their nearest others within the distance `reach`, world units.
    void look(std::size_t wanted, double reach) {
        draw(wanted);
        sort_into_cells(reach);
        if (frame_.is_quantized())
            visit_all([this](std::size_t i, std::size_t axis) {
                return low_[axis] + static_cast<double>(frame_.quantized[3 * i + axis]) * step_[axis];
            });
        else
            visit_all([this](std::size_t i, std::size_t axis) {
                return static_cast<double>(frame_.positions[3 * i + axis]);
            });
    }

    /// The distance of the sixth nearest, in the median; infinite where most have fewer within reach.
    double median_sixth() {
        if (count_ == 0) return infinity;
        std::array<double, most_probes> sixth;
        for (std::size_t p = 0; p < count_; ++p)
            sixth[p] = probes_[p].found == neighbors ? probes_[p].square[neighbors - 1] : infinity;
        const auto middle = sixth.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
        std::nth_element(sixth.begin(), middle, sixth.begin() + static_cast<std::ptrdiff_t>(count_));
        return std::sqrt(*middle);
    }

    /// The share of those that have another within a distance.
    double share_with_company(double distance) const {
        std::size_t with = 0;
        for (std::size_t p = 0; p < count_; ++p)
            if (probes_[p].found > 0 && probes_[p].square[0] <= distance * distance) ++with;
        return count_ == 0 ? 0.0 : static_cast<double>(with) / static_cast<double>(count_);
    }

    /// The share of those that have six others within a distance.
    double share_among_others(double distance) const {
        std::size_t among = 0;
        for (std::size_t p = 0; p < count_; ++p)
            if (probes_[p].found == neighbors && probes_[p].square[neighbors - 1] <= distance * distance) ++among;
        return count_ == 0 ? 0.0 : static_cast<double>(among) / static_cast<double>(count_);
    }

    /// Whether the particles keep a distance from each other: fewer of them than by chance have their nearest much
    /// nearer than their sixth, however dense they are at a place.
    bool keep_apart() const {
        double all = 0.0;
        double near = 0.0;
        for (std::size_t p = 0; p < count_; ++p) {
            const Probe& probe = probes_[p];
            if (probe.found < neighbors) continue;
            all += 1.0;
            if (probe.square[0] < close_by * close_by * probe.square[neighbors - 1]) near += 1.0;
        }
        const double deviation = std::sqrt(close_at_random * (1.0 - close_at_random) * all);
        return near < close_at_random * all - certainty * deviation;
    }

private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr int cells_per_probe = 27;
    static constexpr int bucket_bits = 14;
    static constexpr std::uint16_t none = 0xFFFF;

    struct Probe {
        std::size_t particle;
        std::array<double, 3> place;
        std::size_t found;  ///< number of the nearest within reach, at most `neighbors`
        /// Squares of their distances, ascending; the last is that of the reach until all are found.
        std::array<double, neighbors> square;
    };
    struct Entry {
        std::uint16_t probe;
        std::uint16_t next;  ///< index of the next entry of the same bucket, or none
    };

    double coordinate(std::size_t i, std::size_t axis) const {
        return frame_.is_quantized() ? low_[axis] + static_cast<double>(frame_.quantized[3 * i + axis]) * step_[axis]
                                     : static_cast<double>(frame_.positions[3 * i + axis]);
    }

    void draw(std::size_t wanted) {
        // Multiples of the golden section leave no gaps and follow no row of a lattice.
        const std::uint64_t particles = frame_.count();
        count_ = 0;
        for (std::uint64_t i = 0; i < wanted; ++i) {
            const auto at = static_cast<std::size_t>(((i * 0x9E3779B97F4A7C15ULL) >> 32) * particles >> 32);
            if (!frame_.levels.empty() && frame_.levels[at] != level_) continue;
            probes_[count_].particle = at;
            for (std::size_t axis = 0; axis < 3; ++axis) probes_[count_].place[axis] = coordinate(at, axis);
            ++count_;
        }
    }

    /// Toward zero, where two cells are one: they only hold more.
    std::int64_t cell_of(double v) const { return static_cast<std::int64_t>(v * cells_per_length_); }
    static std::size_t bucket_of(std::int64_t x, std::int64_t y, std::int64_t z) {
        // Powers of the root of x^4 = x + 1, the golden section's like for three axes, as fractions of 2^64.
        const std::uint64_t key = static_cast<std::uint64_t>(x) * 0xD1B54A32D192ED03ULL +
                                  static_cast<std::uint64_t>(y) * 0xABC98388FB8FAC03ULL +
                                  static_cast<std::uint64_t>(z) * 0x8CB92BA72F3D8DD7ULL;
        return static_cast<std::size_t>(key >> (64 - bucket_bits));
    }

    /// A cell's edge is the reach, so that those within reach of a probe lie in 27.
    void sort_into_cells(double reach) {
        cells_per_length_ = 1.0 / reach;
        first_.fill(none);
        std::uint16_t entries = 0;
        for (std::size_t p = 0; p < count_; ++p) {
            Probe& probe = probes_[p];
            probe.found = 0;
            probe.square.fill(reach * reach);
            std::array<std::int64_t, 3> low;
            for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = cell_of(probe.place[axis] - reach);
            for (int cell = 0; cell < cells_per_probe; ++cell) {
                std::uint16_t& first =
                    first_[bucket_of(low[0] + (cell % 3), low[1] + (cell / 3 % 3), low[2] + (cell / 9))];
                // Where two of its cells share a bucket, once is enough.
                if (first != none && entries_[first].probe == p) continue;
                entries_[entries] = {static_cast<std::uint16_t>(p), first};
                first = entries++;
            }
        }
    }

    template <class Coordinate>
    void visit_all(const Coordinate& at) {
        const std::size_t particles = frame_.count();
        const bool one_level = frame_.levels.empty();
        for (std::size_t i = 0; i < particles; ++i) {
            if (!one_level && frame_.levels[i] != level_) continue;
            const double x = at(i, 0), y = at(i, 1), z = at(i, 2);
            const std::size_t bucket = bucket_of(cell_of(x), cell_of(y), cell_of(z));
            for (std::uint16_t e = first_[bucket]; e != none; e = entries_[e].next) {
                Probe& probe = probes_[entries_[e].probe];
                const double dx = x - probe.place[0], dy = y - probe.place[1], dz = z - probe.place[2];
                const double square = dx * dx + dy * dy + dz * dz;
                if (square <= probe.square[neighbors - 1] && i != probe.particle) insert(probe, square);
            }
        }
    }

    static void insert(Probe& probe, double square) {
        std::size_t at = probe.found < neighbors ? probe.found++ : neighbors - 1;
        for (; at > 0 && probe.square[at - 1] > square; --at) probe.square[at] = probe.square[at - 1];
        probe.square[at] = square;
    }

    const ParticleFrame& frame_;
    std::uint8_t level_;
    std::array<double, 3> low_{}, step_{};  ///< corner and step of quantized positions
    double cells_per_length_ = 0.0;
    std::size_t count_ = 0;
    std::array<Probe, most_probes> probes_;
    std::array<Entry, cells_per_probe * most_probes> entries_;
    std::array<std::uint16_t, 1U << bucket_bits> first_;  ///< entry of each bucket
};

/// More digits would be pretended, and would change from frame to frame.
double two_digits(double v) {
    const std::string text = rounded_text(v, 2);
    read_number(text.data(), text.data() + text.size(), v);
    return v;
}

/// The level of most particles, and their number.
std::pair<std::uint8_t, std::size_t> most_frequent_level(const ParticleFrame& frame) {
    if (frame.levels.empty()) return {0, frame.count()};
    std::pair<std::uint8_t, std::size_t> most{0, 0};
    for (std::uint8_t level = 0; level <= max_particle_level; ++level) {
        const auto particles = static_cast<std::size_t>(std::count(frame.levels.begin(), frame.levels.end(), level));
        if (particles > most.second) most = {level, particles};
    }
    return most;
}

}  // namespace

std::optional<FittingRadius> radius_that_fits(const ParticleFrame& frame, double radius) {
    const auto [level, particles] = most_frequent_level(frame);
    if (particles < fewest_particles) return std::nullopt;
    const double unit = std::ldexp(radius, level);
    const auto fitting = [exponent = -int{level}](double sixth, double alone) {
        return FittingRadius{two_digits(std::ldexp(sixth / usual_sixth, exponent)), alone};
    };

    Probes probes(frame, level);
    const std::size_t few_probes = std::clamp(frame.count() / particles_per_probe, fewest_probes, first_probes);
    double reach = around * unit;
    probes.look(few_probes, reach);
    double sixth = probes.median_sixth();
    if (sixth < near_sixth * unit) return sixth == 0.0 ? std::nullopt : std::optional(fitting(sixth, 0.0));
    if (probes.share_among_others(reach) >= 0.5) return std::nullopt;

    // Most have few others near: spray, or particles of a larger radius.
    const bool most_are_alone = probes.share_with_company(nearest_at_rest * unit) < 0.5;
    for (int pass = 0; pass < most_passes && !std::isfinite(sixth); ++pass) {
        reach *= reach_growth;
        probes.look(few_probes, reach);
        sixth = probes.median_sixth();
    }
    if (!std::isfinite(sixth)) return std::nullopt;
    const bool is_far = sixth >= far_sixth * unit;
    probes.look(std::min(frame.count(), most_probes), std::max(last_reach * sixth, around * unit));
    sixth = probes.median_sixth();
    if (!std::isfinite(sixth)) return std::nullopt;
    // Water keeps apart.
    if (most_are_alone && is_far && probes.share_with_company(company * unit) < few && probes.keep_apart())
        return fitting(sixth, 0.0);
    if (probes.share_among_others(around * unit) < hardly_any && probes.share_with_company(joined * unit) < 1.0 - lone)
        return fitting(sixth, 1.0 - probes.share_with_company(touching * unit));
    return std::nullopt;
}

}  // namespace meniscus
