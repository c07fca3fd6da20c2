// The rules are those of validation.cpp; the kernel finds the first particle that breaks one.
#include "pipeline/cuda_particle_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/warp.hpp"
#include "meniscus/error.hpp"
#include "particles/attribute_choice.hpp"
#include "particles/validation.hpp"

namespace meniscus::cuda {
namespace {

constexpr std::uint64_t particle_bits = 32;

__device__ Counter greatest_of_lanes(Counter value) {
    for (unsigned distance = warp_threads / 2; distance > 0; distance /= 2) {
        const Counter other = __shfl_xor_sync(all_lanes, value, static_cast<int>(distance));
        value = other > value ? other : value;
    }
    return value;
}

__device__ void keep_greatest(Counter* found, Counter value) {
    value = greatest_of_lanes(value);
    if (lane_index() == 0 && value != 0) atomicMax(found, value);
}

/// farthest: the greatest magnitude of a coordinate. levels: may be null.
__global__ void __launch_bounds__(block_threads)
    check_particles(const float* positions, const std::uint8_t* levels, std::uint32_t count, float farthest,
                    ParticleFindings* findings) {
    __shared__ BlockCounter counter;
    Counter first_bad = 0;
    Counter coarsest = 0;
    std::uint32_t by_level[max_particle_level + 1] = {};
    GridLoop{}.each(count, [&](std::uint32_t i) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            const std::uint64_t coordinate = std::uint64_t{3} * i + axis;
            const float p = positions[coordinate];
            // Also false for a NaN.
            if (p >= -farthest && p <= farthest) continue;
            const Counter found = ~Counter{coordinate};
            if (found > first_bad) first_bad = found;
        }
        if (levels == nullptr) return;
        const unsigned level = levels[i];
        const Counter found = Counter{level} << particle_bits | static_cast<std::uint32_t>(~i);
        if (found > coarsest) coarsest = found;
        for (unsigned k = 0; k <= max_particle_level; ++k) by_level[k] += level == k ? 1 : 0;
    });
    keep_greatest(&findings->first_bad, first_bad);
    if (levels == nullptr) return;
    keep_greatest(&findings->coarsest, coarsest);
    for (unsigned k = 0; k <= max_particle_level; ++k) counter.add(&findings->by_level[k], Counter{by_level[k]});
}

__global__ void __launch_bounds__(block_threads)
    check_values(const std::uint32_t* bits, std::uint32_t particles, unsigned components, ValueFindings* findings) {
    Counter first_bad = 0;
    std::uint32_t greatest[max_attribute_components] = {};
    std::uint32_t least[max_attribute_components] = {};
    GridLoop{}.each(particles, [&](std::uint32_t i) {
        for (unsigned c = 0; c < max_attribute_components; ++c) {
            if (c >= components) return;
            const std::uint64_t at = std::uint64_t{components} * i + c;
            constexpr std::uint32_t infinity = 0x7F80'0000;
            const Counter found = ~Counter{at};
            if ((bits[at] & infinity) == infinity && found > first_bad) first_bad = found;
            const std::uint32_t ordered = ordered_bits(bits[at]);
            if (ordered > greatest[c]) greatest[c] = ordered;
            if (~ordered > least[c]) least[c] = ~ordered;
        }
    });
    keep_greatest(&findings->first_bad, first_bad);
    for (unsigned c = 0; c < max_attribute_components; ++c) {
        keep_greatest(&findings->greatest[c], greatest[c]);
        keep_greatest(&findings->least[c], least[c]);
    }
}

/// The float32 numbers up to it are those up to the limit.
float rounded_down(double limit) {
    if (limit >= static_cast<double>(std::numeric_limits<float>::max())) return std::numeric_limits<float>::max();
    const auto nearest = static_cast<float>(limit);
    return static_cast<double>(nearest) <= limit ? nearest : std::nextafter(nearest, 0.0F);
}

}  // namespace

ParticleCheck::ParticleCheck(int device, const Launcher& launch, const std::shared_ptr<MemoryAccount>& account,
                             const std::shared_ptr<MemoryAccount>& device_account)
    : device_(device), launch_(launch), on_host_(account), on_device_(device, launch.stream, device_account) {
    constexpr std::size_t room = std::max(sizeof(ParticleFindings), sizeof(ValueFindings));
    on_host_.reserve(room);
    on_device_.assign(room);
}

void ParticleCheck::require_on_device(const void* array, const std::string& name) const {
    cudaPointerAttributes attributes{};
    check(cudaPointerGetAttributes(&attributes, array), "cudaPointerGetAttributes");
    if (attributes.type == cudaMemoryTypeManaged) return;
    const std::string where = "the frame's " + name + " lie ";
    const std::string advice = ", must be in memory of CUDA device " + std::to_string(device_);
    if (attributes.type != cudaMemoryTypeDevice)
        throw InvalidInput(where + "in memory of the host" + advice + ": copy them there, or give a ParticleFrame");
    if (attributes.device != device_)
        throw InvalidInput(where + "on CUDA device " + std::to_string(attributes.device) + advice);
}

void ParticleCheck::wait() {
    found_.record(launch_.stream);
    found_.wait();
}

float ParticleCheck::value_at(const float* on_device) {
    check(cudaMemcpyAsync(on_host_.get(), on_device, sizeof(float), cudaMemcpyDeviceToHost, launch_.stream),
          "cudaMemcpyAsync");
    wait();
    return *reinterpret_cast<const float*>(on_host_.get());
}

ParticlesByLevel ParticleCheck::require_valid(const ParticleFrame& frame, cudaStream_t made_on,
                                              const Settings& settings) {
    const std::size_t count = frame.count();
    ParticlesByLevel particles{count};
    if (count == 0) return particles;
    const bool has_levels = !frame.levels.empty();
    require_on_device(frame.positions.data(), "positions");
    if (has_levels) require_on_device(frame.levels.data(), "levels");

    made_.record(made_on);
    made_.hold_up(launch_.stream);
    auto* const on_device = reinterpret_cast<ParticleFindings*>(on_device_.get());
    check(cudaMemsetAsync(on_device, 0, sizeof(ParticleFindings), launch_.stream), "cudaMemsetAsync");
    const std::uint8_t* const levels = has_levels ? frame.levels.data() : nullptr;
    launch_(count, block_threads, check_particles, frame.positions.data(), levels, static_cast<std::uint32_t>(count),
            rounded_down(farthest_coordinate(settings)), on_device);
    check(cudaMemcpyAsync(on_host_.get(), on_device, sizeof(ParticleFindings), cudaMemcpyDeviceToHost, launch_.stream),
          "cudaMemcpyAsync");
    wait();

    const ParticleFindings found = *reinterpret_cast<const ParticleFindings*>(on_host_.get());
    if (has_levels) {
        require_level(settings, static_cast<std::uint32_t>(~found.coarsest),
                      static_cast<unsigned>(found.coarsest >> particle_bits));
        for (unsigned k = 0; k <= max_particle_level; ++k) particles[k] = found.by_level[k];
    }
    if (found.first_bad != 0) {
        const std::uint64_t coordinate = ~found.first_bad;
        refuse_coordinate(settings, coordinate, value_at(frame.positions.data() + coordinate));
    }
    return particles;
}

ValueFindings ParticleCheck::look_at(const ParticleArray& array, std::uint32_t particles) {
    auto* const on_device = reinterpret_cast<ValueFindings*>(on_device_.get());
    check(cudaMemsetAsync(on_device, 0, sizeof(ValueFindings), launch_.stream), "cudaMemsetAsync");
    launch_(particles, block_threads, check_values, reinterpret_cast<const std::uint32_t*>(array.data.data()),
            particles, static_cast<unsigned>(array.components), on_device);
    check(cudaMemcpyAsync(on_host_.get(), on_device, sizeof(ValueFindings), cudaMemcpyDeviceToHost, launch_.stream),
          "cudaMemcpyAsync");
    wait();
    return *reinterpret_cast<const ValueFindings*>(on_host_.get());
}

AttributeNumbers ParticleCheck::find_numbers(const ParticleFrame& frame) {
    AttributeNumbers numbers = attribute_numbers(frame.arrays);
    if (frame.count() == 0) return numbers;
    for (const ParticleArray& array : frame.arrays)
        require_on_device(array.data.data(), "values of '" + std::string(array.name) + "'");
    for (std::size_t a = 0; a < frame.arrays.size(); ++a) {
        const ParticleArray& array = frame.arrays[a];
        ValueFindings found{};
        if (array.type == ElementType::float32) {
            found = look_at(array, static_cast<std::uint32_t>(frame.count()));
            if (found.first_bad != 0) refuse_value(array, ~found.first_bad);
        }
        for (unsigned i = 0; i < numbers.shape.amounts; ++i) {
            AttributeNumber& number = numbers.of[i];
            if (number.array != a) continue;
            if (number.type == ElementType::uint8)
                set_range_of_bytes(number);
            else
                set_range(number, from_ordered_bits(~static_cast<std::uint32_t>(found.least[number.component])),
                          from_ordered_bits(static_cast<std::uint32_t>(found.greatest[number.component])));
        }
    }
    return numbers;
}

}  // namespace meniscus::cuda
