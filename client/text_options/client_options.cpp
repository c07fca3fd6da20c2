#include "text_options/client_options.hpp"

#include <cstdint>
#include <optional>
#include <string_view>

#include "text_options/attribute_options.hpp"

namespace meniscus::text_options {
namespace {

/// The wire's numbers have no signs: a server would tell of another one.
void read_unsigned(OptionReader& options, std::string_view name, int& value) {
    std::optional<std::uint32_t> given;
    options.read(name, given);
    if (given) value = static_cast<int>(*given);
}

}  // namespace

client::ConnectionOptions read_connection(OptionReader& options) {
    client::ConnectionOptions connection;
    options.read("tls-ca", connection.ca_file);
    options.read("tls-cert", connection.certificate_file);
    options.read("tls-key", connection.key_file);
    options.read("tls-server-name", connection.server_name);
    options.read("token", connection.token);
    options.read("insecure", connection.insecure);
    options.read("timeout", connection.timeout);
    options.read("wait", connection.wait);
    return connection;
}

client::OpenOptions read_open(OptionReader& options) {
    client::OpenOptions open;
    options.read("session", open.id);
    options.read("name", open.description.name);
    options.read_choice("up-axis", open.description.up_axis);
    options.read("length-unit", open.description.length_unit);
    options.read("ephemeral", open.ephemeral);
    return open;
}

client::StreamOptions read_stream(OptionReader& options) {
    client::StreamOptions stream;
    options.read("meshes", stream.receive_meshes);
    read_unsigned(options, "normal-bits", stream.normal_bits);
    options.read("waiting-limit", stream.waiting_limit);
    options.read_choice("policy", stream.policy);
    options.read("nth", stream.nth);
    options.read("reconnect", stream.reconnect);
    options.read("route-check", stream.route_check);
    return stream;
}

client::WatchOptions read_watch(OptionReader& options) {
    client::WatchOptions watch;
    read_unsigned(options, "max-level", watch.max_level);
    read_unsigned(options, "normal-bits", watch.normal_bits);
    options.read("position-bits", watch.position_bits);
    options.read("region", watch.region);
    options.read("spray", watch.spray);
    options.read("bytes-per-second", watch.bytes_per_second);
    options.read("viewpoint", watch.viewpoint);
    options.read("reconnect", watch.reconnect);
    options.read("route-check", watch.route_check);
    watch.attributes = read_attribute_wishes(options);
    return watch;
}

client::ParticleWatchOptions read_particle_watch(OptionReader& options) {
    client::ParticleWatchOptions watch;
    options.read("max-particles", watch.max_particles);
    options.read("reconnect", watch.reconnect);
    options.read("route-check", watch.route_check);
    return watch;
}

client::SnapshotOptions read_snapshot(OptionReader& options) {
    client::SnapshotOptions snapshot;
    read_unsigned(options, "max-level", snapshot.max_level);
    read_unsigned(options, "normal-bits", snapshot.normal_bits);
    options.read("position-bits", snapshot.position_bits);
    snapshot.attributes = read_attribute_wishes(options);
    return snapshot;
}

}  // namespace meniscus::text_options
