// The arrays of a sequence's frames, which do not change their type.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "meniscus/particle_frame.hpp"

namespace meniscus::cli {

/// A reconstructor holds its own frames against each other. Where several share a sequence, this does.
class ArrayForms {
public:
    /// In the order of the frames. Throws InvalidInput for an array of another type, or number of components, than in
    /// the frames before.
    void require(std::span<const ParticleArray> arrays);

private:
    struct Form {
        std::string name;
        ElementType type;
        std::size_t components;
    };
    std::vector<Form> forms_;
};

}  // namespace meniscus::cli
