// Surfaces reconstructed in this process.
#pragma once

#include <vector>

#include "cli/surfaces/surfaces.hpp"
#include "meniscus/attribute_coding.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {

class LocalSurfaces : public Surfaces {
public:
    /// normals_by: receiver: as one would compute them. normal_bits, attribute_bits: the normals and the float32
    /// attributes are rounded as those that come from a server; none, or 0 for attributes: they are not. codec: of a
    /// file of bricks. only_one: whether a single frame is submitted.
    LocalSurfaces(const Settings& settings, const BackendOptions& options, client::NormalsBy normals_by,
                  std::optional<int> normal_bits, int attribute_bits, Codec codec, bool only_one, Handler handler);
    void submit(const ParticleFrame& frame, double simulation_time) override;
    void finish() override {}

private:
    Reconstructor reconstructor_;
    Mesh mesh_;
    client::NormalsBy normals_by_;
    std::optional<int> normal_bits_;
    std::vector<AttributeWish> attributes_;
    Codec codec_;
    bool only_one_;
    Handler handler_;
    std::uint64_t frames_ = 0;
};

}  // namespace meniscus::cli
