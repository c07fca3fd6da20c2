// Surfaces reconstructed in this process.
#pragma once

#include "cli/surfaces.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {

class LocalSurfaces : public Surfaces {
public:
    LocalSurfaces(const Settings& settings, const BackendOptions& options, Handler handler);
    void submit(const ParticleFrame& frame, double simulation_time) override;
    void finish() override {}

private:
    Reconstructor reconstructor_;
    Mesh mesh_;
    Handler handler_;
    std::uint64_t frames_ = 0;
};

}  // namespace meniscus::cli
