// Codecs on the wire and in core: the same numbers.
#pragma once

#include <google/protobuf/repeated_field.h>

#include <vector>

#include "meniscus/codec.hpp"
#include "meniscus/v1/mesh.pb.h"

namespace meniscus::conversion {

v1::Codec to_wire(Codec codec);

/// Adds every codec that this version knows, the one that is preferred first.
void add_known_codecs(google::protobuf::RepeatedField<int>& wire);

/// Codecs that a client names, in its order. Throws InvalidInput for a number that this version does not know.
std::vector<Codec> named_codecs(const google::protobuf::RepeatedField<int>& wire);

}  // namespace meniscus::conversion
