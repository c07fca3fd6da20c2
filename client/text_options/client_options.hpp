// The options of the client library's calls.
#pragma once

#include "meniscus/client/connection_options.hpp"
#include "meniscus/client/particle_watcher.hpp"
#include "meniscus/client/publisher.hpp"
#include "meniscus/client/session.hpp"
#include "meniscus/client/stream.hpp"
#include "meniscus/client/watcher.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::text_options {

// All throw InvalidInput for an option that is wrong.

client::ConnectionOptions read_connection(OptionReader& options);
client::OpenOptions read_open(OptionReader& options);
/// But for the attributes and the spray.
client::StreamOptions read_stream(OptionReader& options);
client::PublisherOptions read_publisher(OptionReader& options);
client::WatchOptions read_watch(OptionReader& options);
client::ParticleWatchOptions read_particle_watch(OptionReader& options);
client::SnapshotOptions read_snapshot(OptionReader& options);

}  // namespace meniscus::text_options
