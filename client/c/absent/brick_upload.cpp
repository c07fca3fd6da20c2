// Uploads of encoded frames in a build without the service: `meniscus push` gives them to the server.
#include "ranks/brick_upload.hpp"

#include <chrono>
#include <utility>

#include "brick_bytes.hpp"
#include "meniscus/client/errors.hpp"
#include "push_options.hpp"
#include "pushed_upload.hpp"

namespace meniscus::c {
namespace {

class PipedUpload final : public ranks::BrickUpload {
public:
    PipedUpload(const meniscus_client& client, const PushArguments& arguments)
        : upload_(client, arguments, bricks_beginning()) {}

    const std::string& session_id() const override { return upload_.session_id(); }
    void push(const client::ReceivedFrame& frame) override {
        upload_.write(brick_pieces(frame), frame.index);
        PushProcess::Answer answer;
        do answer = upload_.process().next(std::chrono::milliseconds(0));
        while (answer.line);
        if (answer.ended) throw client::ServerError("the session has been ended", client::ErrorCode::not_found);
    }
    void finish() override {
        upload_.process().finish();
        while (!upload_.process().next(std::nullopt).ended) {
        }
    }
    /// The program ends it.
    void leave() noexcept override {}

private:
    PushedUpload upload_;
};

}  // namespace
}  // namespace meniscus::c

namespace meniscus::ranks {

std::unique_ptr<BrickUpload> open_brick_upload(const std::string& server, const text_options::Options& connection,
                                               const text_options::Options& session) {
    c::check_connection(connection);
    const meniscus_client client{c::push_program("meniscus_parts_open"), server, connection};
    return std::make_unique<c::PipedUpload>(client, c::publish_arguments(server, connection, session).push);
}

}  // namespace meniscus::ranks
