// Surfaces reconstructed in this process.
#pragma once

#include "cli/surfaces/local_coding.hpp"
#include "cli/surfaces/surfaces.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {

class LocalSurfaces : public Surfaces {
public:
    /// only_one: whether a single frame is submitted.
    LocalSurfaces(const Settings& settings, const BackendOptions& options, const LocalCoding& coding, bool only_one,
                  Handler handler);
    void submit(const ParticleFrame& frame, double simulation_time) override;
    void finish() override {}

private:
    Reconstructor reconstructor_;
    Mesh mesh_;
    LocalCoding coding_;
    bool only_one_;
    Handler handler_;
    std::uint64_t frames_ = 0;
};

}  // namespace meniscus::cli
