#include "sessions/session/accepted_frames.hpp"

#include <fmt/format.h>

namespace meniscus::server {

void AcceptedFrames::accept(FrameKind kind, const std::string& session) {
    if (kind_.value_or(kind) != kind)
        throw Refusal(
            Refusal::Kind::failed_precondition,
            fmt::format("session {} takes frames of {}, which its first upload had, and none of {}: make another "
                        "session for these",
                        session, name_of(*kind_), name_of(kind)));
    kind_ = kind;
}

bool AcceptedFrames::can_show(const WatchOptions& options) const {
    return kind_ != FrameKind::bricks || (options.wants_meshes() && options.format.max_level == 3);
}

Refusal AcceptedFrames::needs_particles(const std::string& session) {
    return {
        Refusal::Kind::failed_precondition,
        fmt::format("the surfaces of session {} are made elsewhere: it has no particles, and nothing that is made of "
                    "them anew, as a surface of max_level 1 or 2",
                    session)};
}

}  // namespace meniscus::server
