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

/// The first of `named` that the session can encode; Draco if there is none. has_lattice: whether the session's meshes
/// come with one. saves_bytes: whether the smallest is taken before others that are named.
CodecChoice choose_codec(std::span<const Codec> named, bool has_lattice, bool saves_bytes = false);

// All throw InvalidInput for a codec that this version does not know.

CodecChoice codec_choice(const v1::StreamOpen& request, bool has_lattice);
CodecChoice codec_choice(const v1::WatchRequest& request, bool has_lattice);
CodecChoice codec_choice(const v1::SnapshotRequest& request, bool has_lattice);

/// Tells the receiver, with the call's initial metadata.
void announce(const CodecChoice& choice, grpc::CallbackServerContext& context);

}  // namespace meniscus::server
