// Clients, sessions and their frames in a build without the service: `meniscus push` speaks to the server.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../src/frame.hpp"
#include "../src/options.hpp"
#include "../src/particles.hpp"
#include "../src/result.hpp"
#include "../src/timeout.hpp"
#include "frame_bytes.hpp"
#include "meniscus/client/errors.hpp"
#include "meniscus/error.hpp"
#include "meniscus/meniscus.h"
#include "push_answer.hpp"
#include "push_options.hpp"
#include "push_process.hpp"

using namespace meniscus::c;

struct meniscus_client {
    std::string program;
    std::string address;
    meniscus::text_options::Options connection;
};

struct meniscus_session {
    meniscus_session(const meniscus_client& client, const PushArguments& arguments)
        : settings(arguments.settings), process(client.program, arguments.words, arguments.token) {}

    meniscus::Settings settings;
    PushProcess process;
    std::string id;
    FrameBuffers buffers;
    std::vector<float> positions;
    std::optional<std::uint64_t> last_index;
};

namespace {

[[noreturn]] void not_through_push(const std::string& what, const std::string& remedy) {
    throw meniscus::NotBuilt(what, "the service, and meniscus push cannot do it: " + remedy);
}

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

void require_order(const meniscus_session& session, std::uint64_t index, double simulation_time) {
    if (session.last_index && index <= *session.last_index)
        throw meniscus::InvalidInput("frame index " + std::to_string(index) + " after " +
                                     std::to_string(*session.last_index) + "; indices must increase");
    if (!std::isfinite(simulation_time))
        throw meniscus::InvalidInput("frame " + std::to_string(index) + ": simulation_time is " +
                                     std::to_string(simulation_time) + "; it must be finite");
}

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
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
        const PushArguments arguments = push_arguments(
            of.address, of.connection, options == nullptr ? meniscus::text_options::Options() : options->values);
        auto opened = std::make_unique<meniscus_session>(of, arguments);
        opened->process.write(bytes_of(recording_beginning()));
        const JsonLine first = opened->process.next(std::nullopt).line.value_or(JsonLine());
        const auto id = first.find("session");
        if (id == first.end())
            throw meniscus::client::ServerError(of.program + " push answers no session: is it of another version?",
                                                meniscus::client::ErrorCode::unimplemented);
        opened->id = id->second;
        *session = opened.release();
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
    return session == nullptr ? nullptr : session->id.c_str();
}

meniscus_result meniscus_session_push(meniscus_session* session, const meniscus_particles* particles, uint64_t index,
                                      double simulation_time) {
    return guarded([&] {
        GivenParticles given = read_particles(particles);
        meniscus_session& to = required(session, "session");
        require_order(to, index, simulation_time);
        to.positions.resize(3 * given.positions.count());
        given.positions.copy_to(to.positions);
        given.arrays = named_arrays(given.arrays, to.settings);
        meniscus::ParticleFrame frame;
        frame.positions = to.positions;
        frame.levels = given.levels;
        frame.arrays = given.arrays;
        for (const FramePiece& piece : frame_pieces(frame, index, simulation_time)) {
            to.process.write(bytes_of(piece.head));
            to.process.write(piece.data);
        }
        to.last_index = index;
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
        required(session, "session").process.finish();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_session_next(meniscus_session* session, double timeout_seconds, meniscus_frame** frame) {
    return guarded([&] {
        required(frame, "frame") = nullptr;
        PushProcess& process = required(session, "session").process;
        const PushProcess::Answer answer = process.next(timeout_of(timeout_seconds));
        if (!answer.line) return answer.ended ? MENISCUS_ENDED : MENISCUS_NOTHING_YET;
        *frame = new meniscus_frame{read_answer(*answer.line)};
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_session_cancel(meniscus_session* session) {
    return guarded([&] {
        required(session, "session").process.cancel();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_session_dropped(const meniscus_session* session, uint64_t* frames) {
    return guarded([&] {
        required(frames, "frames") = required(session, "session").process.dropped();
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
