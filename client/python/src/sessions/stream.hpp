// Streams as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>

#include "meniscus/client/stream.hpp"
#include "sessions/frame_upload.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::python {

/// Throws InvalidInput for an option that is wrong.
client::StreamOptions stream_options(const text_options::Options& options, const pybind11::object& on_reconnect);

/// The class _meniscus.Stream.
class PushedStream : public FrameUpload<client::Stream> {
public:
    using FrameUpload::FrameUpload;

    /// Copies the frame with the interpreter's lock, and waits without it. Ctrl-C cancels the stream.
    /// index: None for the one after the last. Returns it.
    std::uint64_t push(const pybind11::object& positions, const pybind11::object& levels,
                       const pybind11::sequence& arrays, const pybind11::object& index, double time);
    bool try_push(const pybind11::object& positions, const pybind11::object& levels, const pybind11::sequence& arrays,
                  const pybind11::object& index, double time);
};

}  // namespace meniscus::python
