#include "web/grpc_web.hpp"

#include <algorithm>
#include <array>

namespace meniscus::server {

namespace {

constexpr std::string_view watch = "/meniscus.v1.SurfaceService/Watch";
constexpr std::string_view watch_particles = "/meniscus.v1.SurfaceService/WatchParticles";
constexpr std::string_view read_recording = "/meniscus.v1.RecordingService/ReadRecording";
constexpr std::array<std::string_view, 7> methods{
    "/meniscus.v1.RecordingService/ListRecordings",
    read_recording,
    "/meniscus.v1.ServerService/GetServerInfo",
    "/meniscus.v1.SessionService/GetSession",
    "/meniscus.v1.SessionService/ListSessions",
    watch,
    watch_particles,
};

}  // namespace

bool GrpcWeb::serves(std::string_view target) const {
    return channel && std::ranges::find(methods, target) != methods.end();
}

bool is_method(std::string_view target) {
    return target.starts_with("/meniscus.v1.");
}

bool is_stream(std::string_view target) {
    return target == watch || target == watch_particles || target == read_recording;
}

}  // namespace meniscus::server
