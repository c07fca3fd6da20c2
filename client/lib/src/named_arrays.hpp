// Which of its frames' arrays a session makes attributes of.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/v1/settings.pb.h"

namespace meniscus::client {

class NamedArrays {
public:
    /// Not known: whatever can be an attribute is sent, and the server passes over what it does not need.
    NamedArrays() = default;
    explicit NamedArrays(const Settings& settings) : names_(settings.attributes), all_(settings.all_attributes) {}
    explicit NamedArrays(const v1::Settings& settings)
        : names_({settings.attributes().begin(), settings.attributes().end()}), all_(settings.all_attributes()) {}

    bool are_known() const { return names_.has_value(); }

    /// The arrays of a frame that are sent. Throws InvalidInput, with the array's name, for one that is missing, comes
    /// twice, or can be no attribute; lengths are not looked at. A frame without particles may lack them.
    std::vector<ParticleArray> of(std::span<const ParticleArray> arrays, std::size_t particles) const;

private:
    std::vector<ParticleArray> every(std::span<const ParticleArray> arrays) const;

    std::optional<std::vector<std::string>> names_;
    bool all_ = false;
};

}  // namespace meniscus::client
