#include "rpc/messages/codec_choice.hpp"

#include <algorithm>
#include <string>

#include "conversion/codec_conversion.hpp"

namespace meniscus::server {

CodecChoice choose_codec(std::span<const Codec> named, bool saves_bytes) {
    constexpr Codec smallest = Codec::lattice_entropy;
    if (named.empty()) return {Codec::draco, "the client names none"};
    if (saves_bytes && named.front() != smallest && std::ranges::find(named, smallest) != named.end())
        return {smallest, "the smallest that the client names, as it limits bytes_per_second"};
    return {named.front(), "the first that the client names"};
}

CodecChoice codec_choice(const v1::StreamOpen& request) {
    return choose_codec(conversion::named_codecs(request.codecs()));
}

CodecChoice codec_choice(const v1::WatchRequest& request) {
    return choose_codec(conversion::named_codecs(request.codecs()), request.bytes_per_second() != 0);
}

CodecChoice codec_choice(const v1::SnapshotRequest& request) {
    return choose_codec(conversion::named_codecs(request.codecs()));
}

void announce(const CodecChoice& choice, grpc::CallbackServerContext& context) {
    context.AddInitialMetadata("x-codec", v1::Codec_Name(conversion::to_wire(choice.codec)));
    context.AddInitialMetadata("x-codec-reason", std::string(choice.reason));
}

}  // namespace meniscus::server
