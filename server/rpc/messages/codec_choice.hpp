// The codec of a receiver's bricks, of those that it names.
#pragma once

#include <grpcpp/server_context.h>

#include <span>
#include <string_view>

#include "meniscus/codec.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

struct CodecChoice {
    Codec codec = Codec::draco;
    std::string_view reason;  ///< in words, for the receiver
};

/// The first of `named`; Draco if there is none. saves_bytes: whether the smallest is taken before others that are
/// named.
CodecChoice choose_codec(std::span<const Codec> named, bool saves_bytes = false);

// All throw InvalidInput for a codec that this version does not know.

CodecChoice codec_choice(const v1::StreamOpen& request);
CodecChoice codec_choice(const v1::WatchRequest& request);
CodecChoice codec_choice(const v1::SnapshotRequest& request);

/// Tells the receiver, with the call's initial metadata.
void announce(const CodecChoice& choice, grpc::CallbackServerContext& context);

}  // namespace meniscus::server
