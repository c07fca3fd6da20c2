// Uploads of encoded frames in a build without the service: `meniscus push` gives them to the server.
#include "pushing/pushed_upload.hpp"

#include <chrono>

#include "meniscus/client/errors.hpp"
#include "pushing/brick_bytes.hpp"
#include "pushing/push_options.hpp"
#include "ranks/brick_upload.hpp"

namespace meniscus::ranks {
namespace {

using pushing::PushProcess;

class PipedUpload final : public BrickUpload {
public:
    PipedUpload(const std::string& program, const pushing::PushArguments& arguments)
        : upload_(program, arguments, pushing::bricks_beginning()) {}

    const std::string& session_id() const override { return upload_.session_id(); }
    void push(const client::ReceivedFrame& frame) override {
        upload_.write(pushing::brick_pieces(frame), frame.index);
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
    pushing::PushedUpload upload_;
};

}  // namespace

std::unique_ptr<BrickUpload> open_brick_upload(const std::string& server, const text_options::Options& connection,
                                               const text_options::Options& session) {
    pushing::check_connection(connection);
    return std::make_unique<PipedUpload>(pushing::push_program("publishing parts of frames to a session"),
                                         pushing::publish_arguments(server, connection, session).push);
}

}  // namespace meniscus::ranks
