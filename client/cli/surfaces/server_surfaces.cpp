#include "cli/surfaces/server_surfaces.hpp"

#include <iostream>
#include <utility>

namespace meniscus::cli {
namespace {

/// Frames under way or waiting for this process: enough to keep the server busy, few enough to bound memory.
constexpr std::size_t frames_under_way = 4;

}  // namespace

ServerSurfaces::ServerSurfaces(const ServerFlags& server, const SessionFlags& session, const Settings& settings,
                               client::StreamOptions options, Handler handler)
    : session_(server, session, settings, options.parts > 1), handler_(std::move(handler)) {
    options.waiting_limit = frames_under_way;
    stream_ = session_.stream(options);
    receiver_ = std::thread([this] { receive(); });
}

ServerSurfaces::~ServerSurfaces() {
    // On the way out because of an earlier error, which is the one to report.
    try {
        if (receiver_.joinable()) end_stream();
    } catch (const std::exception&) {
    }
}

void ServerSurfaces::submit(const ParticleFrame& frame, double simulation_time) {
    if (failed_) std::rethrow_exception(error_);
    stream_->push(frame, frames_++, simulation_time);
}

void ServerSurfaces::finish() {
    end_stream();
    if (failed_) std::rethrow_exception(error_);
    if (stream_->dropped() != 0) std::cerr << stream_->dropped() << " frames dropped, as the policy says\n";
    session_.end();
}

void ServerSurfaces::end_stream() {
    std::exception_ptr error;
    try {
        stream_->finish();
    } catch (...) {
        error = std::current_exception();
    }
    receiver_.join();
    if (error) std::rethrow_exception(error);
}

void ServerSurfaces::receive() {
    try {
        while (const auto frame = stream_->next()) {
            // After a failed handler frames are only taken out of the way, so that submit() does not wait for ever.
            if (failed_) continue;
            try {
                Surface surface(*frame);
                handler_(surface);
            } catch (...) {
                error_ = std::current_exception();
                failed_ = true;
            }
        }
    } catch (...) {
        if (failed_) return;
        error_ = std::current_exception();
        failed_ = true;
    }
}

}  // namespace meniscus::cli
