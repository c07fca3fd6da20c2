// The arrays that particles carry beside position and level, and the order of particles that lie at one place.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/host_device.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus {

/// The arrays of a frame, in host or device memory.
struct PayloadView {
    std::uint32_t arrays = 0;
    const std::byte* data[max_particle_arrays] = {};
    std::size_t element_bytes[max_particle_arrays] = {};

    /// Whether particle a comes before particle b of the same key: by the bytes of the first array, then of the next;
    /// in the frame's order if all are equal: the result is the same in either order.
    MENISCUS_HD bool before(std::uint32_t a, std::uint32_t b) const {
        for (std::uint32_t array = 0; array < arrays; ++array) {
            const std::byte* const of_a = data[array] + a * element_bytes[array];
            const std::byte* const of_b = data[array] + b * element_bytes[array];
            for (std::size_t i = 0; i < element_bytes[array]; ++i)
                if (of_a[i] != of_b[i]) return of_a[i] < of_b[i];
        }
        return a < b;
    }
};

/// The payload of a valid frame.
inline PayloadView payload_view(const ParticleFrame& frame) {
    PayloadView view;
    for (const ParticleArray& array : frame.arrays) {
        view.data[view.arrays] = array.data.data();
        view.element_bytes[view.arrays++] = array.element_bytes();
    }
    return view;
}

/// Sorts particles of the same key, by one thread: a heap sort, so that many at one place take n log n.
MENISCUS_HD inline void sort_by_payload(const PayloadView& payload, std::uint32_t* particles, std::uint32_t count) {
    const auto sift_down = [&](std::uint32_t root, std::uint32_t end) {
        const std::uint32_t sifted = particles[root];
        for (std::uint32_t child = 2 * root + 1; child < end; child = 2 * root + 1) {
            if (child + 1 < end && payload.before(particles[child], particles[child + 1])) ++child;
            if (!payload.before(sifted, particles[child])) break;
            particles[root] = particles[child];
            root = child;
        }
        particles[root] = sifted;
    };
    for (std::uint32_t root = count / 2; root-- > 0;) sift_down(root, count);
    for (std::uint32_t end = count; end-- > 1;) {
        const std::uint32_t last = particles[end];
        particles[end] = particles[0];
        particles[0] = last;
        sift_down(0, end);
    }
}

}  // namespace meniscus
