// Streams as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <mutex>
#include <optional>

#include "meniscus/client/stream.hpp"
#include "sessions/frame_source.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::python {

/// Throws InvalidInput for an option that is wrong.
client::StreamOptions stream_options(const text_options::Options& options, const pybind11::object& on_reconnect);

/// The class _meniscus.Stream.
class PushedStream : public FrameSource<client::Stream> {
public:
    using FrameSource::FrameSource;

    /// Copies the frame with the interpreter's lock, and waits without it. Ctrl-C cancels the stream.
    /// index: None for the one after the last. Returns it.
    std::uint64_t push(const pybind11::object& positions, const pybind11::object& levels,
                       const pybind11::sequence& arrays, const pybind11::object& index, double time);
    bool try_push(const pybind11::object& positions, const pybind11::object& levels, const pybind11::sequence& arrays,
                  const pybind11::object& index, double time);
    void finish();
    std::uint64_t dropped() const { return source_.dropped(); }

private:
    /// In a turn. Throws InvalidInput for one that is not above those before.
    std::uint64_t number_of(std::optional<std::uint64_t> given) const;

    std::mutex push_turn_;  ///< for what follows
    std::optional<std::uint64_t> last_index_;
};

}  // namespace meniscus::python
