// An uploading stream as the client library would never send it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "connection/connection.hpp"
#include "conversion/particle_arrays.hpp"

namespace meniscus::hostile {

class RawStream {
public:
    /// run: 0 for one without a name.
    RawStream(const std::string& address, const std::string& session, const client::ConnectionOptions& options = {},
              std::uint64_t run = 0)
        : connection_(address, options) {
        connection_.add_metadata(context_, session);
        context_.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(9));
        call_ = connection_.surfaces->Stream(&context_);
        v1::StreamRequest request;
        request.mutable_open()->set_session_id(session);
        request.mutable_open()->set_run_id(run);
        call_->Write(request);
    }

    bool begin(std::uint64_t index, std::uint64_t particles) {
        v1::StreamRequest request;
        request.mutable_frame_begin()->set_frame_index(index);
        request.mutable_frame_begin()->set_particle_count(particles);
        *request.mutable_frame_begin()->mutable_arrays() = conversion::particle_arrays(false, false);
        return call_->Write(request);
    }
    bool bytes(std::string data) {
        v1::StreamRequest request;
        request.mutable_frame_chunk()->set_data(std::move(data));
        return call_->Write(request);
    }
    bool end_frame() {
        v1::StreamRequest request;
        request.mutable_frame_end();
        return call_->Write(request);
    }
    void send_no_more() { call_->WritesDone(); }
    void cancel() { context_.TryCancel(); }
    /// Reads to the end.
    grpc::Status finish() {
        v1::StreamResponse response;
        while (call_->Read(&response)) {
        }
        return call_->Finish();
    }

private:
    client::Connection connection_;
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReaderWriter<v1::StreamRequest, v1::StreamResponse>> call_;
};

}  // namespace meniscus::hostile
