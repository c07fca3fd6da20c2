// The first message of an upload.
#pragma once

#include <string>

#include "codec_order.hpp"
#include "meniscus/client/stream.hpp"
#include "upload_call.hpp"

namespace meniscus::client {

/// Of particles. Throws InvalidInput for wishes of attributes that cannot be.
UploadOpening stream_opening(const std::string& session_id, const StreamOptions& options, const WireCodecs& codecs);
/// Of finished bricks, with the options that both have.
UploadOpening publish_opening(const std::string& session_id, const StreamOptions& options);

}  // namespace meniscus::client
