// Which files `meniscus reconstruct` reads and writes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/sequence/frame_selection.hpp"
#include "cli/sequence/share.hpp"
#include "cli/surfaces/mesh_output.hpp"
#include "formats/particles/particle_formats.hpp"

namespace meniscus::cli {

using formats::ParticleFormat;

/// The argument IN, the flags that name files, and those of a sequence.
struct ReconstructFiles {
    std::string in;
    std::optional<ParticleFormat> input_format;
    formats::ReadLimits limits;
    std::string out;
    std::optional<MeshFormat> format;
    std::string spray_out;
    std::string stats;
    std::string pvd;
    std::string usd_stage;
    FrameSelection selection;
    std::optional<Share> share;  ///< of a sequence; none: all of it
    bool skip_existing = false;
    std::optional<double> frame_rate;  ///< of a sequence; none: frames have no times

    void add_to(CLI::App& command);
    void add_sequence_to(CLI::App& command);
};

/// One frame's files. Empty: not asked for.
struct FrameFiles {
    std::uint64_t number = 0;
    std::filesystem::path in;
    std::filesystem::path out;
    std::filesystem::path spray_out;
    double time = 0.0;  ///< seconds
};

/// The frames to reconstruct, and their files.
struct Plan {
    bool sequence = false;
    MeshFormat format = MeshFormat::ply;
    std::vector<FrameFiles> frames;  ///< to be reconstructed
    std::vector<FrameFiles> all;     ///< those, the skipped ones and those of other shares, in order
    std::size_t skipped = 0;         ///< of this share
};

/// Looks at the names of all files before any work. Throws InvalidInput for what is missing, contradicts itself, or
/// would write over what is read.
Plan make_plan(const ReconstructFiles& files);

}  // namespace meniscus::cli
