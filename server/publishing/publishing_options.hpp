// The options of publishing: whether, for how long, and how much.
#pragma once

#include <chrono>
#include <cstddef>

#include "meniscus/described.hpp"

namespace meniscus::server {

struct PublishingOptions {
    bool enabled = false;  ///< whether sessions may ask to be published
    /// Of a session's newest frames, while it lives; after its end, how long they are kept. 0: for as long as there is
    /// room.
    std::chrono::milliseconds keep = std::chrono::seconds(60);
    std::size_t limit = std::size_t{512} << 20;  ///< bytes of all publications' segments; 0: no limit

    /// Calls visit(name, value, facts) for each member that has a flag.
    template <class Self, class Visit>
    static void rows(Self& self, const Visit& visit) {
        visit("publish", self.enabled,
              {.help = "Serve sessions whose owner asks for it as plain files, under /publications/ of --http, to "
                       "callers that may watch them"});
        visit("publish_keep", self.keep,
              {.help = "Seconds of its newest frames that a publication has, and for which it is kept after its "
                       "session; 0: for as long as there is room",
               .unit = "s",
               .range = {.most = 1e9},
               .argument = "SECONDS"});
        visit("publish_limit", self.limit,
              {.help = "Bytes of memory for all publications, as 2G; 0: no limit. Beyond it the owner that holds most "
                       "loses the oldest frames, of sessions that have ended first, then of the largest",
               .unit = "bytes",
               .argument = "BYTES"});
    }
};

}  // namespace meniscus::server
