#include "recording/reader_codec.hpp"

#include <algorithm>
#include <utility>

#include "conversion/attribute_conversion.hpp"
#include "conversion/brick_conversion.hpp"
#include "meniscus/error.hpp"
#include "sessions/session/session_observer.hpp"

namespace meniscus::server {

ReaderCodec::ReaderCodec(std::vector<Codec> named)
    : named_(named.empty() ? std::vector{Codec::draco} : std::move(named)) {}

std::vector<std::string> ReaderCodec::messages_for(std::string message) {
    const auto is_there = [&](Codec codec) { return std::ranges::find(named_, codec) != named_.end(); };
    if (std::ranges::all_of(codecs, is_there)) return {std::move(message)};
    v1::WatchResponse parsed;
    if (!parsed.ParseFromString(message)) throw InvalidInput("a message is not one of a mesh");
    if (parsed.has_mesh_begin()) {
        offset_bits_ = parsed.mesh_begin().offset_bits();
        attributes_ = conversion::coded_attributes(parsed.mesh_begin());
    }
    if (!parsed.has_mesh_brick() || is_named(parsed.mesh_brick().codec())) return {std::move(message)};
    const v1::MeshBrick& part = parsed.mesh_brick();
    if (part.part_index() != next_part_ || part.part_index() >= part.part_count())
        throw InvalidInput("a brick's parts do not follow one another");
    conversion::append_part(part, brick_);
    next_part_ = part.part_index() + 1 == part.part_count() ? 0 : next_part_ + 1;
    return next_part_ == 0 ? encoded_again() : std::vector<std::string>();
}

bool ReaderCodec::is_named(v1::Codec codec) const {
    return std::ranges::any_of(named_, [&](Codec named) { return static_cast<int>(named) == int{codec}; });
}

std::vector<std::string> ReaderCodec::encoded_again() const {
    const DecodedBrick decoded = decode_brick(brick_, offset_bits_, attributes_);
    const EncodedBrick draco =
        encode_brick(decoded, offset_bits_, {.normal_bits = SessionObserver::normal_bits, .attributes = attributes_});
    std::vector<std::string> messages;
    for (v1::MeshBrick& part : conversion::to_wire(draco)) {
        v1::WatchResponse response;
        *response.mutable_mesh_brick() = std::move(part);
        messages.push_back(response.SerializeAsString());
    }
    return messages;
}

}  // namespace meniscus::server
