// A particle file as the frame that is reconstructed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/print/warnings.hpp"
#include "cli/surfaces/quantized_positions.hpp"
#include "editing/origin.hpp"
#include "formats/particles/particle_formats.hpp"
#include "formats/particles/particles.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::cli {

/// How files become frames.
struct ParticleInputOptions {
    std::optional<formats::ParticleFormat> format;  ///< none: the extension's
    formats::ReadLimits limits;
    std::optional<Box> box;                 ///< --particle-aabb: particles outside are left out
    std::optional<editing::Origin> origin;  ///< --origin: positions become relative to it
    PositionEncoding positions = PositionEncoding::float32;
};

/// One frame, owned.
class ParticleInput {
public:
    /// Reads and checks. Throws InvalidInput, naming the file, for what is not a frame of these settings, and for an
    /// array that the settings name and the file does not have, with those that it has.
    ParticleInput(const std::filesystem::path& path, const ParticleInputOptions& options, const Settings& settings);
    ParticleInput(const ParticleInput&) = delete;
    ParticleInput& operator=(const ParticleInput&) = delete;

    ParticleFrame frame() const { return quantized_ ? quantized_->frame() : exact(); }
    const std::vector<FileWarning>& warnings() const { return warnings_; }

private:
    ParticleFrame exact() const;
    void warn_of_rounding(double particle_radius);
    void choose_arrays(const Settings& settings, const std::string& name);

    formats::Particles particles_;
    std::vector<ParticleArray> arrays_;  ///< those that the settings name
    std::optional<QuantizedPositions> quantized_;
    std::vector<FileWarning> warnings_;
};

}  // namespace meniscus::cli
