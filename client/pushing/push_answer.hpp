// The answer of `meniscus push` to one frame.
#pragma once

#include "meniscus/client/received_frame.hpp"
#include "pushing/json_line.hpp"

namespace meniscus::pushing {

/// Its number, its time and, but for the warnings, its statistics. Throws client::ServerError (data_loss) for a line
/// that answers no frame.
client::ReceivedFrame read_answer(const JsonLine& line);

}  // namespace meniscus::pushing
