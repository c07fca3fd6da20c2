// Clients, sessions and their frames in a build without the service: `meniscus push` speaks to the server.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "../src/options.hpp"
#include "../src/particles.hpp"
#include "../src/result.hpp"
#include "meniscus/meniscus.h"
#include "pushing/frame_bytes.hpp"
#include "pushing/push_options.hpp"
#include "pushing/push_process.hpp"
#include "through_push.hpp"

using namespace meniscus::c;
using namespace meniscus::pushing;

struct meniscus_session {
    meniscus_session(const meniscus_client& client, const PushArguments& arguments)
        : settings(arguments.settings), upload(client.program, arguments, recording_beginning()) {}

    meniscus::Settings settings;
    PushedUpload upload;
    std::vector<float> positions;
};

namespace {

/// Those that the settings name: the others would be passed over.
std::vector<meniscus::ParticleArray> named_arrays(const std::vector<meniscus::ParticleArray>& arrays,
                                                  const meniscus::Settings& settings) {
    std::vector<meniscus::ParticleArray> out;
    for (const meniscus::ParticleArray& array : arrays)
        if (settings.all_attributes ||
            std::find(settings.attributes.begin(), settings.attributes.end(), array.name) != settings.attributes.end())
            out.push_back(array);
    return out;
}

}  // namespace

meniscus_result meniscus_client_connect(const char* address, const meniscus_options* options,
                                        meniscus_client** client) {
    const char* const function = __func__;
    return guarded([&] {
        if (client != nullptr) *client = nullptr;
        std::string program = push_program(function);
        required(client, "client");
        meniscus::text_options::Options connection;
        if (options != nullptr) connection = options->values;
        check_connection(connection);
        *client = new meniscus_client{std::move(program), &required(address, "address"), std::move(connection)};
        return MENISCUS_OK;
    });
}

void meniscus_client_destroy(meniscus_client* client) {
    delete client;
}

meniscus_result meniscus_session_open(meniscus_client* client, const meniscus_options* options,
                                      meniscus_session** session) {
    return guarded([&] {
        required(session, "session") = nullptr;
        const meniscus_client& of = required(client, "client");
        *session = new meniscus_session(
            of, push_arguments(of.address, of.connection,
                               options == nullptr ? meniscus::text_options::Options() : options->values));
        return MENISCUS_OK;
    });
}

void meniscus_session_destroy(meniscus_session* session) {
    delete session;
}

meniscus_result meniscus_session_leave(meniscus_session* session) {
    return guarded([&]() -> meniscus_result {
        required(session, "session");
        not_through_push("meniscus_session_leave", "the session ends with its stream");
    });
}

const char* meniscus_session_id(const meniscus_session* session) {
    return session == nullptr ? nullptr : session->upload.session_id().c_str();
}

meniscus_result meniscus_session_push(meniscus_session* session, const meniscus_particles* particles, uint64_t index,
                                      double simulation_time) {
    return guarded([&] {
        GivenParticles given = read_particles(particles);
        meniscus_session& to = required(session, "session");
        to.upload.require_order(index, simulation_time);
        to.positions.resize(3 * given.positions.count());
        given.positions.copy_to(to.positions);
        given.arrays = named_arrays(given.arrays, to.settings);
        meniscus::ParticleFrame frame;
        frame.positions = to.positions;
        frame.levels = given.levels;
        frame.arrays = given.arrays;
        to.upload.write(frame_pieces(frame, index, simulation_time), index);
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_session_try_push(meniscus_session* session, const meniscus_particles* /*particles*/,
                                          uint64_t /*index*/, double /*simulation_time*/) {
    return guarded([&]() -> meniscus_result {
        required(session, "session");
        not_through_push("meniscus_session_try_push",
                         "meniscus_session_push() with the option policy set to latest waits for no reconstruction");
    });
}

meniscus_result meniscus_session_finish(meniscus_session* session) {
    return guarded([&] {
        required(session, "session").upload.process().finish();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_session_next(meniscus_session* session, double timeout_seconds, meniscus_frame** frame) {
    return guarded([&] { return next_answer(required(session, "session").upload, timeout_seconds, frame); });
}

meniscus_result meniscus_session_cancel(meniscus_session* session) {
    return guarded([&] {
        required(session, "session").upload.process().cancel();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_session_dropped(const meniscus_session* session, uint64_t* frames) {
    return guarded([&] {
        required(frames, "frames") = required(session, "session").upload.process().dropped();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_frame_mesh(const meniscus_frame* frame, meniscus_mesh* mesh) {
    return guarded([&]() -> meniscus_result {
        required(frame, "frame");
        required(mesh, "mesh");
        not_through_push("meniscus_frame_mesh",
                         "a watcher in a program with it has the meshes, and so has the server's viewer");
    });
}
