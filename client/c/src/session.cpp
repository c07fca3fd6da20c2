#include <utility>

#include "client.hpp"
#include "next_frame.hpp"
#include "options.hpp"
#include "particles.hpp"
#include "result.hpp"
#include "text_options/attribute_options.hpp"
#include "text_options/client_options.hpp"
#include "text_options/settings_options.hpp"

using namespace meniscus::c;
using namespace meniscus::text_options;

struct meniscus_session {
    meniscus::client::Session content;
    meniscus::client::Stream stream;  ///< goes first
};

meniscus_result meniscus_session_open(meniscus_client* client, const meniscus_options* options,
                                      meniscus_session** session) {
    return guarded([&] {
        required(session, "session") = nullptr;
        meniscus::client::Client& connected = required(client, "client").content;
        auto reader = reader_of(options);
        const meniscus::Settings settings = read_settings(reader);
        const auto open = read_open(reader);
        auto streaming = read_stream(reader);
        streaming.spray = settings.spray == meniscus::Spray::points;
        streaming.attributes = read_every_attribute(reader);
        reader.finish();
        auto opened = connected.open_session(settings, open);
        auto stream = opened.stream(streaming);
        *session = new meniscus_session{std::move(opened), std::move(stream)};
        return MENISCUS_OK;
    });
}

void meniscus_session_destroy(meniscus_session* session) {
    delete session;
}

meniscus_result meniscus_session_leave(meniscus_session* session) {
    return guarded([&] {
        required(session, "session").content.leave();
        return MENISCUS_OK;
    });
}

const char* meniscus_session_id(const meniscus_session* session) {
    return session == nullptr ? nullptr : session->content.id().c_str();
}

meniscus_result meniscus_session_push(meniscus_session* session, const meniscus_particles* particles, uint64_t index,
                                      double simulation_time) {
    return guarded([&] {
        const GivenParticles given = read_particles(particles);
        required(session, "session").stream.push(given.positions, index, simulation_time, given.levels, given.arrays);
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_session_try_push(meniscus_session* session, const meniscus_particles* particles,
                                          uint64_t index, double simulation_time) {
    return guarded([&] {
        const GivenParticles given = read_particles(particles);
        meniscus::client::Stream& stream = required(session, "session").stream;
        return stream.try_push(given.positions, index, simulation_time, given.levels, given.arrays)
                   ? MENISCUS_OK
                   : MENISCUS_WOULD_WAIT;
    });
}

meniscus_result meniscus_session_finish(meniscus_session* session) {
    return guarded([&] {
        required(session, "session").stream.finish();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_session_next(meniscus_session* session, double timeout_seconds, meniscus_frame** frame) {
    return guarded([&] { return next_frame(required(session, "session").stream, timeout_seconds, frame); });
}

meniscus_result meniscus_session_cancel(meniscus_session* session) {
    return guarded([&] {
        required(session, "session").stream.cancel();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_session_dropped(const meniscus_session* session, uint64_t* frames) {
    return guarded([&] {
        required(frames, "frames") = required(session, "session").stream.dropped();
        return MENISCUS_OK;
    });
}
