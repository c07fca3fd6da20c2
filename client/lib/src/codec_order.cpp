#include "codec_order.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "address/loopback.hpp"
#include "conversion/codec_conversion.hpp"

namespace meniscus::client {

namespace {

/// Within a machine bytes cost less than the time to entropy-code them, over a network more.
std::vector<Codec> order(const std::string& address, std::optional<Codec> wanted) {
    if (wanted == Codec::draco) return {Codec::draco};
    if (wanted) return {*wanted, Codec::draco};
    if (address::is_loopback(address)) return {Codec::lattice_packed, Codec::lattice_entropy, Codec::draco};
    return {Codec::lattice_entropy, Codec::lattice_packed, Codec::draco};
}

/// A server refuses a codec that it does not know.
WireCodecs offered(std::span<const Codec> order, const Connection& connection, const std::stop_token& stop) {
    const std::vector<Codec> offered =
        order.size() == 1 ? std::vector(order.begin(), order.end()) : connection.offered_codecs(stop);
    WireCodecs named;
    for (const Codec codec : order)
        if (std::ranges::find(offered, codec) != offered.end()) named.Add(conversion::to_wire(codec));
    return named;
}

}  // namespace

WireCodecs codec_order(const Connection& connection, std::optional<Codec> wanted, const std::stop_token& stop) {
    return offered(order(connection.address, wanted), connection, stop);
}

WireCodecs readable_codecs(const Connection& connection, const std::stop_token& stop) {
    return offered(codecs, connection, stop);
}

}  // namespace meniscus::client
