// Publishers as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>

#include "meniscus/client/publisher.hpp"
#include "sessions/frame_upload.hpp"
#include "surfaces/frame.hpp"
#include "surfaces/mesh.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::python {

/// Throws InvalidInput for an option that is wrong.
client::PublisherOptions publisher_options(const text_options::Options& options, const pybind11::object& on_reconnect);

/// The class _meniscus.Publisher.
class SurfacePublisher : public FrameUpload<client::Publisher> {
public:
    using FrameUpload::FrameUpload;

    // Both encode and wait without the interpreter's lock. index: None for the one after the last. They return it.

    /// bricks: see brick_box().
    std::uint64_t push_mesh(const MeshHandle& mesh, const pybind11::object& index, double time,
                            const pybind11::object& bricks);
    /// A frame that was received, as it came.
    std::uint64_t push_frame(const FrameHandle& frame, const pybind11::object& index, double time);
};

}  // namespace meniscus::python
