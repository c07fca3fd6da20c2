// The codecs that a call names.
#pragma once

#include <google/protobuf/repeated_field.h>

#include <optional>
#include <stop_token>

#include "connection/connection.hpp"
#include "meniscus/codec.hpp"

namespace meniscus::client {

using WireCodecs = google::protobuf::RepeatedField<int>;

/// Those for a receiver of meshes, in its order, of those that the server offers. wanted: the first of them; none: what
/// the way to the server favors. Draco is the last.
WireCodecs codec_order(const Connection& connection, std::optional<Codec> wanted, const std::stop_token& stop);

/// Those for a reader of recordings: all that both know.
WireCodecs readable_codecs(const Connection& connection, const std::stop_token& stop);

}  // namespace meniscus::client
