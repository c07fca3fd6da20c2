#include "rpc/messages/codec_choice.hpp"

#include <algorithm>
#include <string>

#include "conversion/codec_conversion.hpp"

namespace meniscus::server {

CodecChoice choose_codec(std::span<const Codec> named, bool has_lattice, bool saves_bytes) {
    const auto can_encode = [&](Codec codec) { return has_lattice || !needs_lattice(codec); };
    constexpr Codec smallest = Codec::lattice_entropy;
    if (named.empty()) return {Codec::draco, "the client names none"};
    if (saves_bytes && named.front() != smallest && can_encode(smallest) &&
        std::ranges::find(named, smallest) != named.end())
        return {smallest, "the smallest that the client names, as it limits bytes_per_second"};
    const auto first = std::ranges::find_if(named, can_encode);
    if (first == named.end())
        return {Codec::draco, "the session is on a GPU, which has no lattice for those that the client names"};
    if (first != named.begin())
        return {*first, "the first that the client names and that needs no lattice, which a session on a GPU lacks"};
    return {*first, "the first that the client names"};
}

CodecChoice codec_choice(const v1::StreamOpen& request, bool has_lattice) {
    return choose_codec(conversion::named_codecs(request.codecs()), has_lattice);
}

CodecChoice codec_choice(const v1::WatchRequest& request, bool has_lattice) {
    return choose_codec(conversion::named_codecs(request.codecs()), has_lattice, request.bytes_per_second() != 0);
}

CodecChoice codec_choice(const v1::SnapshotRequest& request, bool has_lattice) {
    return choose_codec(conversion::named_codecs(request.codecs()), has_lattice);
}

void announce(const CodecChoice& choice, grpc::CallbackServerContext& context) {
    context.AddInitialMetadata("x-codec", v1::Codec_Name(conversion::to_wire(choice.codec)));
    context.AddInitialMetadata("x-codec-reason", std::string(choice.reason));
}

}  // namespace meniscus::server
