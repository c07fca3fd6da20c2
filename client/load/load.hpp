// A whole run of the load generator.
#pragma once

#include "load/options.hpp"
#include "load/outcome.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::load {

struct LoadResult {
    client::ServerInfo server;
    Schedule schedule;
    double seconds = 0.0;  ///< time from the first frame's due time to the last answer
    UploadOutcome uploads;
    WatchOutcome watchers;
    WatchOutcome slow;
    WatchOutcome vanishing;
};

/// Throws ServerError if the server is not there or refuses a session, InvalidInput for files that cannot be read.
LoadResult run_load(const LoadOptions& options);

}  // namespace meniscus::load
