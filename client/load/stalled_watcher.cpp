#include "load/stalled_watcher.hpp"

#include "connection/connection.hpp"

namespace meniscus::load {

class StalledWatcher::Impl {
public:
    Impl(const std::string& server, const client::ConnectionOptions& connection, const std::string& session)
        : connection_(server, connection) {
        connection_.add_metadata(context_, session);
        v1::WatchRequest request;
        request.set_session_id(session);
        call_ = connection_.surfaces->Watch(&context_, request);
        call_->WaitForInitialMetadata();
    }
    ~Impl() {
        context_.TryCancel();
        v1::WatchResponse ignored;
        while (call_->Read(&ignored)) {
        }
        call_->Finish();
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

private:
    client::Connection connection_;
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReader<v1::WatchResponse>> call_;
};

StalledWatcher::StalledWatcher(const std::string& server, const client::ConnectionOptions& connection,
                               const std::string& session)
    : impl_(std::make_unique<Impl>(server, connection, session)) {}
StalledWatcher::~StalledWatcher() = default;

}  // namespace meniscus::load
