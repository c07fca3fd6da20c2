// Publishers in a build without the service: bricks are encoded here, and `meniscus push` gives them to the server.
#include <memory>
#include <string>
#include <vector>

#include "../src/brick_box.hpp"
#include "../src/mesh.hpp"
#include "../src/options.hpp"
#include "../src/result.hpp"
#include "meniscus/client/surface_part.hpp"
#include "meniscus/meniscus.h"
#include "pushing/brick_bytes.hpp"
#include "through_push.hpp"

using namespace meniscus::c;
using namespace meniscus::pushing;

struct meniscus_publisher {
    meniscus_publisher(const meniscus_client& client, const PublishArguments& arguments)
        : form(arguments.form), upload(client.program, arguments.push, bricks_beginning()) {}

    PublishedForm form;
    PushedUpload upload;
};

namespace {

void push(meniscus_publisher& publisher, const meniscus_mesh& mesh, const meniscus::BrickBox& own, std::uint64_t index,
          double simulation_time) {
    publisher.upload.require_order(index, simulation_time);
    const auto frame = meniscus::client::encode_own(mesh.content, mesh.statistics, index, simulation_time, own,
                                                    publisher.form.coding, publisher.form.wishes);
    publisher.upload.write(brick_pieces(frame), index);
}

}  // namespace

meniscus_result meniscus_publisher_open(meniscus_client* client, const meniscus_options* options,
                                        meniscus_publisher** publisher) {
    return guarded([&] {
        required(publisher, "publisher") = nullptr;
        const meniscus_client& of = required(client, "client");
        *publisher = new meniscus_publisher(
            of, publish_arguments(of.address, of.connection,
                                  options == nullptr ? meniscus::text_options::Options() : options->values));
        return MENISCUS_OK;
    });
}

void meniscus_publisher_destroy(meniscus_publisher* publisher) {
    delete publisher;
}

meniscus_result meniscus_publisher_leave(meniscus_publisher* publisher) {
    return guarded([&]() -> meniscus_result {
        required(publisher, "publisher");
        not_through_push("meniscus_publisher_leave", "the session ends with its publisher");
    });
}

const char* meniscus_publisher_session_id(const meniscus_publisher* publisher) {
    return publisher == nullptr ? nullptr : publisher->upload.session_id().c_str();
}

meniscus_result meniscus_publisher_push(meniscus_publisher* publisher, const meniscus_mesh* mesh, uint64_t index,
                                        double simulation_time) {
    return guarded([&] {
        const meniscus_mesh& pushed = required(mesh, "mesh");
        push(required(publisher, "publisher"), pushed, meniscus::all_bricks, index, simulation_time);
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_publisher_push_box(meniscus_publisher* publisher, const meniscus_mesh* mesh,
                                            const int32_t lowest[3], const int32_t highest[3], uint64_t index,
                                            double simulation_time) {
    return guarded([&] {
        const meniscus_mesh& pushed = required(mesh, "mesh");
        push(required(publisher, "publisher"), pushed, brick_box(lowest, highest), index, simulation_time);
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_publisher_finish(meniscus_publisher* publisher) {
    return guarded([&] {
        required(publisher, "publisher").upload.process().finish();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_publisher_next(meniscus_publisher* publisher, double timeout_seconds, meniscus_frame** frame) {
    return guarded([&] { return next_answer(required(publisher, "publisher").upload, timeout_seconds, frame); });
}

meniscus_result meniscus_publisher_cancel(meniscus_publisher* publisher) {
    return guarded([&] {
        required(publisher, "publisher").upload.process().cancel();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_publisher_dropped(const meniscus_publisher* publisher, uint64_t* frames) {
    return guarded([&] {
        required(frames, "frames") = required(publisher, "publisher").upload.process().dropped();
        return MENISCUS_OK;
    });
}
