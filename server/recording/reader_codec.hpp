// Recorded bricks for a reader that does not decode the codec that they were recorded with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

/// Takes the messages of recorded frames one after the other. A brick of a codec that the reader has not named is
/// decoded and encoded again with Draco, which takes as long as that brick's share of an encode; all else passes as it
/// is.
class ReaderCodec {
public:
    /// named: the reader's; none: Draco.
    explicit ReaderCodec(std::vector<Codec> named);

    /// The messages to send in place of this one: none before the last part of a brick that is encoded again. Throws
    /// InvalidInput for what is no such message, or no brick.
    std::vector<std::string> messages_for(std::string message);

private:
    bool is_named(v1::Codec codec) const;
    std::vector<std::string> encoded_again() const;

    const std::vector<Codec> named_;
    std::uint32_t offset_bits_ = 0;           ///< of the frame
    std::vector<CodedAttribute> attributes_;  ///< of its bricks
    EncodedBrick brick_;                      ///< as far as its parts have come
    std::uint32_t next_part_ = 0;
};

}  // namespace meniscus::server
