// The inside of a Stream.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "connection.hpp"
#include "frame_receiver.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::client {

class Stream::Impl {
public:
    Impl(std::shared_ptr<Connection> connection, const std::string& session_id, const StreamOptions& options);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void push(const ParticleFrame& frame, std::uint64_t index, double simulation_time);
    void finish();
    std::optional<ReceivedFrame> next();

private:
    void read();
    void wait_for_room();
    void send(const v1::StreamRequest& request);
    void send_chunks(std::span<const std::byte> bytes);

    const std::shared_ptr<Connection> connection_;
    const StreamOptions options_;
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReaderWriter<v1::StreamRequest, v1::StreamResponse>> call_;
    v1::StreamRequest chunk_;  ///< reused
    bool finished_ = false;    ///< no more frames will be pushed

    std::mutex mutex_;  ///< for what follows
    std::condition_variable changed_;
    std::deque<ReceivedFrame> waiting_;
    std::size_t outstanding_ = 0;  ///< frames pushed and not yet returned by next()
    bool ended_ = false;           ///< the server has answered all it will
    std::exception_ptr error_;

    std::thread reader_;
};

}  // namespace meniscus::client
