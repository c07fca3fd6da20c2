#include <algorithm>

#include "meniscus/v1/surface_service.pb.h"
#include "rpc/messages/codec_choice.hpp"
#include "rpc/messages/watch_options.hpp"
#include "support.hpp"

namespace meniscus::fuzz {

void watch_requests(Bytes bytes) {
    v1::WatchRequest request;
    if (!request.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
    Settings settings;
    settings.particle_radius = 0.1;
    may_refuse([&] {
        const server::WatchOptions options = server::watch_options_of(request, settings);
        require(options.format.max_level >= 1 && options.format.max_level <= 3, "a level cap is a level");
        require(options.format.position_bits >= 2 && options.format.position_bits <= 6,
                "positions are no finer than the mesh");
        require(
            options.format.normal_bits == 0 || (options.format.normal_bits >= 2 && options.format.normal_bits <= 16),
            "normals have bits that Draco takes");
        const Codec codec = server::codec_choice(request).codec;
        require(codec == Codec::draco ||
                    std::ranges::find(request.codecs(), static_cast<int>(codec)) != request.codecs().end(),
                "a receiver gets a codec that it names, or Draco");
    });
}

Seeds watch_request_seeds() {
    v1::WatchRequest request;
    request.set_session_id("00000000-0000-4000-8000-000000000000");
    request.set_normal_bits(8);
    request.set_position_bits(4);
    request.set_max_level(2);
    request.mutable_region()->mutable_min()->set_x(-1.0);
    for (const auto set : {&v1::Vector3::set_x, &v1::Vector3::set_y, &v1::Vector3::set_z})
        (request.mutable_region()->mutable_max()->*set)(1.0);
    request.set_bytes_per_second(1'000'000);
    request.add_codecs(v1::CODEC_LATTICE_PACKED);
    request.add_codecs(v1::CODEC_DRACO);
    request.mutable_viewpoint()->set_z(5.0);
    return {request.SerializeAsString()};
}

}  // namespace meniscus::fuzz
