// One simulator: sends its frames when they are due, whether or not those before have been answered.
#pragma once

#include <string>

#include "load/frames.hpp"
#include "load/outcome.hpp"
#include "load/schedule.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::load {

/// Returns when every frame has been answered or the stream has failed. Frames that could not be sent by the end of
/// the schedule are not sent any more: their number tells that the server was too slow.
UploadOutcome simulate(client::Client& client, const std::string& session, const client::StreamOptions& options,
                       const Frames& frames, const Schedule& schedule);

}  // namespace meniscus::load
