#include "ranks/brick_upload.hpp"

#include <chrono>
#include <utility>

#include "meniscus/client/client.hpp"
#include "meniscus/client/errors.hpp"
#include "text_options/client_options.hpp"
#include "text_options/settings_options.hpp"

namespace meniscus::ranks {
namespace {

class ClientUpload final : public BrickUpload {
public:
    ClientUpload(client::Session session, const client::PublisherOptions& options)
        : session_(std::move(session)), publisher_(session_.publish(options)) {}

    const std::string& session_id() const override { return session_.id(); }
    void push(const client::ReceivedFrame& frame) override {
        publisher_.push(frame);
        client::Next<client::ReceivedFrame> answer;
        while ((answer = publisher_.next(std::chrono::milliseconds(0)))) {
        }
        if (answer.ended) throw client::ServerError("the session has been ended", client::ErrorCode::not_found);
    }
    void finish() override {
        publisher_.finish();
        while (publisher_.next()) {
        }
    }
    void leave() noexcept override { session_.leave(); }

private:
    client::Session session_;
    client::Publisher publisher_;  ///< goes first
};

}  // namespace

std::unique_ptr<BrickUpload> open_brick_upload(const std::string& server, const text_options::Options& connection,
                                               const text_options::Options& session) {
    text_options::OptionReader connecting(&connection);
    const client::ConnectionOptions connected = text_options::read_connection(connecting);
    connecting.finish();
    text_options::OptionReader reader(&session);
    const Settings settings = text_options::read_settings(reader);
    const client::OpenOptions open = text_options::read_open(reader);
    const client::PublisherOptions publishing = text_options::read_publisher(reader);
    reader.finish();
    client::Client made(server, connected);
    return std::make_unique<ClientUpload>(made.open_session(settings, open), publishing);
}

}  // namespace meniscus::ranks
