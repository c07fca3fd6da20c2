// Surfaces reconstructed in this process.
#pragma once

#include "cli/surfaces.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {

class LocalSurfaces : public Surfaces {
public:
    /// normal_bits: the normals are rounded as those that come from a server; none: they are not.
    LocalSurfaces(const Settings& settings, const BackendOptions& options, std::optional<int> normal_bits,
                  Handler handler);
    void submit(const ParticleFrame& frame, double simulation_time) override;
    void finish() override {}

private:
    Reconstructor reconstructor_;
    Mesh mesh_;
    std::optional<int> normal_bits_;
    Handler handler_;
    std::uint64_t frames_ = 0;
};

}  // namespace meniscus::cli
