// One simulator: sends each frame when it is due, even if earlier frames have not been answered.
#pragma once

#include <string>

#include "load/frames.hpp"
#include "load/outcome.hpp"
#include "load/schedule.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::load {

/// Returns when every frame has been answered or the stream has failed. Frames that could not be sent by the end of
/// the schedule are counted as not sent: the server was too slow for them.
UploadOutcome simulate(client::Client& client, const std::string& session, const client::StreamOptions& options,
                       const Frames& frames, const Schedule& schedule);

}  // namespace meniscus::load
