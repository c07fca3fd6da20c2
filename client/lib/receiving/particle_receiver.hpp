// Puts received particles together, and believes none of the messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::client {

/// Throws ServerError for messages that are out of order or contradict each other. Takes memory for what has come, not
/// for what was announced.
class ParticleReceiver {
public:
    /// Returns the frame that the message completes.
    std::optional<ReceivedParticles> take(const v1::WatchParticlesResponse& response);

    /// The server has nothing more to send.
    void end_of_stream() const;

private:
    struct Frame {
        ReceivedParticles header;
        conversion::ParticleLayout layout;
        std::uint64_t sent_count = 0;
        std::uint64_t expected_bytes = 0;
        std::vector<std::byte> bytes;  ///< of the arrays, one after the other
    };

    void begin(const v1::ParticlesBegin& message);
    void add(const v1::FrameChunk& message);
    ReceivedParticles end();

    std::optional<Frame> frame_;  ///< between its begin and its end
};

}  // namespace meniscus::client
