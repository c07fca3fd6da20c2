// The inside of a RecordingReader.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "connection/connection.hpp"
#include "meniscus/client/client.hpp"
#include "receiving/frame_receiver.hpp"

namespace meniscus::client {

class RecordingReader::Impl {
public:
    Impl(std::shared_ptr<Connection> connection, const std::string& session_id, std::uint32_t number,
         const ReadOptions& options);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    std::optional<ReceivedFrame> next();

private:
    const std::shared_ptr<Connection> connection_;
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReader<v1::WatchResponse>> reader_;
    FrameReceiver receiver_{true};
    bool ended_ = false;
};

}  // namespace meniscus::client
