#include "text_options/client_options.hpp"

#include "text_options/attribute_options.hpp"
#include "text_options/row_options.hpp"

namespace meniscus::text_options {

client::ConnectionOptions read_connection(OptionReader& options) {
    return record_of<client::ConnectionOptions>(options);
}

client::OpenOptions read_open(OptionReader& options) {
    return record_of<client::OpenOptions>(options);
}

client::StreamOptions read_stream(OptionReader& options) {
    return record_of<client::StreamOptions>(options);
}

client::PublisherOptions read_publisher(OptionReader& options) {
    auto publisher = record_of<client::PublisherOptions>(options);
    publisher.attribute_bits = read_attribute_bits(options);
    return publisher;
}

client::WatchOptions read_watch(OptionReader& options) {
    auto watch = record_of<client::WatchOptions>(options);
    watch.attributes = read_attribute_wishes(options);
    return watch;
}

client::ParticleWatchOptions read_particle_watch(OptionReader& options) {
    return record_of<client::ParticleWatchOptions>(options);
}

client::SnapshotOptions read_snapshot(OptionReader& options) {
    auto snapshot = record_of<client::SnapshotOptions>(options);
    snapshot.attributes = read_attribute_wishes(options);
    return snapshot;
}

}  // namespace meniscus::text_options
