// Readers of recordings as Python sees them.
#pragma once

#include "meniscus/client/recording.hpp"
#include "sessions/frame_source.hpp"

namespace meniscus::python {

/// The class _meniscus.RecordingReader.
using RecordingSource = FrameSource<client::RecordingReader>;

}  // namespace meniscus::python
