#include "meniscus/client/publisher.hpp"

#include <utility>

#include "brick_box.hpp"
#include "client.hpp"
#include "mesh.hpp"
#include "next_frame.hpp"
#include "options.hpp"
#include "result.hpp"
#include "text_options/client_options.hpp"
#include "text_options/settings_options.hpp"

using namespace meniscus::c;
using namespace meniscus::text_options;

struct meniscus_publisher {
    meniscus::client::Session session;
    meniscus::client::Publisher content;  ///< goes first
};

meniscus_result meniscus_publisher_open(meniscus_client* client, const meniscus_options* options,
                                        meniscus_publisher** publisher) {
    return guarded([&] {
        required(publisher, "publisher") = nullptr;
        meniscus::client::Client& connected = required(client, "client").content;
        auto reader = reader_of(options);
        const meniscus::Settings settings = read_settings(reader);
        const auto open = read_open(reader);
        const auto publishing = read_publisher(reader);
        reader.finish();
        auto session = connected.open_session(settings, open);
        auto content = session.publish(publishing);
        *publisher = new meniscus_publisher{std::move(session), std::move(content)};
        return MENISCUS_OK;
    });
}

void meniscus_publisher_destroy(meniscus_publisher* publisher) {
    delete publisher;
}

meniscus_result meniscus_publisher_leave(meniscus_publisher* publisher) {
    return guarded([&] {
        required(publisher, "publisher").session.leave();
        return MENISCUS_OK;
    });
}

const char* meniscus_publisher_session_id(const meniscus_publisher* publisher) {
    return publisher == nullptr ? nullptr : publisher->session.id().c_str();
}

meniscus_result meniscus_publisher_push(meniscus_publisher* publisher, const meniscus_mesh* mesh, uint64_t index,
                                        double simulation_time) {
    return guarded([&] {
        const meniscus_mesh& pushed = required(mesh, "mesh");
        required(publisher, "publisher").content.push(pushed.content, pushed.statistics, index, simulation_time);
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_publisher_push_box(meniscus_publisher* publisher, const meniscus_mesh* mesh,
                                            const int32_t lowest[3], const int32_t highest[3], uint64_t index,
                                            double simulation_time) {
    return guarded([&] {
        const meniscus_mesh& pushed = required(mesh, "mesh");
        required(publisher, "publisher")
            .content.push(pushed.content, pushed.statistics, index, simulation_time, brick_box(lowest, highest));
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_publisher_finish(meniscus_publisher* publisher) {
    return guarded([&] {
        required(publisher, "publisher").content.finish();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_publisher_next(meniscus_publisher* publisher, double timeout_seconds, meniscus_frame** frame) {
    return guarded([&] { return next_frame(required(publisher, "publisher").content, timeout_seconds, frame); });
}

meniscus_result meniscus_publisher_cancel(meniscus_publisher* publisher) {
    return guarded([&] {
        required(publisher, "publisher").content.cancel();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_publisher_dropped(const meniscus_publisher* publisher, uint64_t* frames) {
    return guarded([&] {
        required(frames, "frames") = required(publisher, "publisher").content.dropped();
        return MENISCUS_OK;
    });
}
