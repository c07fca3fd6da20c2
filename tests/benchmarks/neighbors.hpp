// How much there is to sum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "meniscus/settings.hpp"

namespace meniscus::benchmarks {

/// Points picked evenly from n, at most `limit` of them: their indices.
std::vector<std::size_t> pick_evenly(std::size_t n, std::size_t limit);

/// The particles of a frame without levels, by cells as wide as the widest support.
class ParticlesNear {
public:
    /// particles: x y z each, world units, every |coordinate| below 2^20 supports; outlives this.
    ParticlesNear(std::span<const float> particles, const Settings& settings);

    /// The particles whose support reaches a point (x y z).
    std::size_t reaching(const float* point);
    /// The particles that the sums at a particle's own place count: for the color field those of its density; for the
    /// smooth field those of its company and those whose support reaches it.
    std::size_t summed_at_particle(std::size_t particle);

private:
    template <class Visit>
    void for_each_within(const float* point, double distance, const Visit& visit) const;
    /// World units.
    double support_of(std::uint32_t particle);
    double company_support() const;

    std::span<const float> particles_;
    bool is_smooth_;
    std::uint32_t smoothness_;
    double radius_;
    double widest_;
    std::vector<std::uint32_t> order_;                      ///< the particles cell by cell
    std::unordered_map<std::uint64_t, std::size_t> first_;  ///< begin of a cell in order_
    std::unordered_map<std::uint32_t, double> supports_;    ///< those found so far
};

}  // namespace meniscus::benchmarks
