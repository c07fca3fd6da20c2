// Readers of recordings as Python sees them.
#pragma once

#include "frame_source.hpp"
#include "meniscus/client/recording.hpp"

namespace meniscus::python {

/// The class _meniscus.RecordingReader.
using RecordingSource = FrameSource<client::RecordingReader>;

}  // namespace meniscus::python
