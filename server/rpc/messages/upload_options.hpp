// The options with which a stream opens.
#pragma once

#include "meniscus/v1/surface_service.pb.h"
#include "sessions/intake/upload.hpp"

namespace meniscus::server {

/// But for the codec: see codec_choice(). Throws InvalidInput for a value out of range.
UploadOptions upload_options(const v1::StreamOpen& message);
UploadOptions upload_options(const v1::PublishOpen& message);

}  // namespace meniscus::server
