// Calls to a server which Ctrl-C ends, and what they open.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <stop_token>
#include <type_traits>
#include <utility>

#include "sessions/publisher.hpp"
#include "sessions/recording.hpp"
#include "sessions/stream.hpp"
#include "sessions/watcher.hpp"
#include "text_options/option_reader.hpp"
#include "threads/process.hpp"
#include "threads/waiting.hpp"

namespace meniscus::python {

/// Returns the result of `call`, which runs without the interpreter's lock, with a token by which Ctrl-C ends it.
template <class Call>
auto call_server(const Call& call) {
    require_own_process();
    std::stop_source stopping;
    using Result = std::invoke_result_t<Call, const std::stop_token&>;
    if constexpr (std::is_void_v<Result>) {
        wait_for([&] { call(stopping.get_token()); }, [&] { stopping.request_stop(); });
    } else {
        std::optional<Result> result;
        wait_for([&] { result = call(stopping.get_token()); }, [&] { stopping.request_stop(); });
        return std::move(*result);
    }
}

/// open: opens a client::Stream with its options, as Client and Session do.
template <class Open>
Held<PushedStream> open_stream(const text_options::Options& options, const pybind11::object& on_reconnect,
                               const Open& open) {
    client::StreamOptions request = stream_options(options, on_reconnect);
    return call_server([&](const std::stop_token& stop) {
        request.stop = stop;
        return Held<PushedStream>(new PushedStream(open(request)));
    });
}

/// Opens a client::Publisher likewise.
template <class Open>
Held<SurfacePublisher> open_publisher(const text_options::Options& options, const pybind11::object& on_reconnect,
                                      const Open& open) {
    client::PublisherOptions request = publisher_options(options, on_reconnect);
    return call_server([&](const std::stop_token& stop) {
        request.stop = stop;
        return Held<SurfacePublisher>(new SurfacePublisher(open(request)));
    });
}

/// Opens a client::Watcher likewise.
template <class Open>
Held<WatchSource> open_watcher(const text_options::Options& options, const pybind11::object& on_reconnect,
                               const Open& open) {
    client::WatchOptions request = watch_options(options, on_reconnect);
    return call_server([&](const std::stop_token& stop) {
        request.stop = stop;
        return Held<WatchSource>(new WatchSource(open(request)));
    });
}

/// Opens a client::ParticleWatcher likewise.
template <class Open>
Held<ParticleSource> open_particle_watcher(const text_options::Options& options, const pybind11::object& on_reconnect,
                                           const Open& open) {
    client::ParticleWatchOptions request = particle_watch_options(options, on_reconnect);
    return call_server([&](const std::stop_token& stop) {
        request.stop = stop;
        return Held<ParticleSource>(new ParticleSource(open(request)));
    });
}

}  // namespace meniscus::python
