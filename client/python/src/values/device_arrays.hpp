// Particles that lie on a GPU, as other packages describe them (__cuda_array_interface__).
#pragma once

#include <pybind11/pybind11.h>

#include <deque>
#include <string>
#include <vector>

#include "meniscus/device_particles.hpp"

namespace meniscus::python {

/// The arrays of one call; borrowed as long as the call's arguments live.
class DeviceArrays {
public:
    /// Throws InvalidInput for another type, shape, order or stream than the library takes, and for what is no such
    /// interface.
    DeviceArrays(const pybind11::dict& positions, const pybind11::object& levels, const pybind11::sequence& arrays);
    /// Borrows from here.
    const DeviceParticleFrame& frame() const { return frame_; }

private:
    std::deque<std::string> names_;
    std::vector<ParticleArray> arrays_;
    DeviceParticleFrame frame_;
};

}  // namespace meniscus::python
