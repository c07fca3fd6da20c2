// The client of the C interface in a build without the service, and the answers that it gets: `meniscus push` speaks to
// the server.
#pragma once

#include <string>

#include "meniscus/meniscus.h"
#include "pushing/pushed_upload.hpp"
#include "text_options/option_reader.hpp"

struct meniscus_client {
    std::string program;
    std::string address;
    meniscus::text_options::Options connection;
};

namespace meniscus::c {

/// As meniscus_session_next().
meniscus_result next_answer(pushing::PushedUpload& upload, double timeout_seconds, meniscus_frame** frame);

/// Throws NotBuilt.
[[noreturn]] void not_through_push(const std::string& what, const std::string& remedy);

}  // namespace meniscus::c
