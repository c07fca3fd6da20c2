#include "rpc/stream_handler.hpp"

#include <spdlog/spdlog.h>

#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "rpc/caller.hpp"
#include "rpc/normal_bits.hpp"
#include "rpc/session_id.hpp"
#include "rpc/status.hpp"
#include "rpc/wire_bytes.hpp"
#include "sessions/frame_assembler.hpp"
#include "sessions/refusal.hpp"

namespace meniscus::server {

namespace {

/// Two sides run side by side. The reading side is one thread at a time: a read is under way, or a free input slot is
/// waited for, or reading has ended. The writing side sends what the upload's output holds and finishes the call after
/// its end. It also finishes after a cancellation, as soon as no write is under way, so that no call outlives its client.
class StreamReactor final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                            public std::enable_shared_from_this<StreamReactor> {
public:
    StreamReactor(SessionRegistry& registry, ActiveCalls& calls, const grpc::CallbackServerContext& context)
        : active_(calls), registry_(registry), peer_(context.peer()), assembler_(registry.limits()) {}

    void start(const Authorizer& authorizer, const grpc::CallbackServerContext& context) {
        self_ = shared_from_this();
        try {
            caller_ = admit(authorizer, context, Action::stream);
            session_id_ = metadata_session_id(context);
        } catch (...) {
            refuse(std::current_exception());
            return;
        }
        StartRead(&incoming_);
    }

    // The reading side.

    void OnReadDone(bool ok) override {
        if (!may_read()) {
            give_input_back();
            return;
        }
        try {
            if (!ok) {
                assembler_.end_of_stream();
                if (!upload_) throw InvalidInput("the stream ended before its first message, open");
                end_reading(nullptr);
                return;
            }
            receive();
        } catch (...) {
            end_reading(std::current_exception());
        }
    }

    // The writing side.

    void OnWriteDone(bool ok) override {
        {
            const std::lock_guard lock(mutex_);
            writing_ = false;
            // A write that fails is the first sign of a broken connection; OnCancel follows.
            if (!ok) canceled_ = true;
        }
        write();
    }

    void OnCancel() override {
        {
            const std::lock_guard lock(mutex_);
            canceled_ = true;
        }
        write();
    }

    void OnDone() override {
        const auto self = std::move(self_);
        if (!upload_) return;
        // For a call that ended before its upload: nobody reads, and the session is free for the next stream.
        upload_->output.close();
        session_->end_upload(upload_, nullptr);
        spdlog::info("session {}: stream from {} closed: {}", session_id_, peer_, outcome_);
    }

private:
    /// Whether what has been read is still wanted.
    bool may_read() {
        const std::lock_guard lock(mutex_);
        return !reading_ended_ && !canceled_;
    }

    void receive() {
        parse(incoming_, request_, "StreamRequest");
        incoming_.Clear();
        if (!upload_) {
            if (!request_.has_open()) throw InvalidInput("the first message of a stream must be open");
            open(request_.open());
            request_input();
            return;
        }
        switch (request_.message_case()) {
            case v1::StreamRequest::kOpen:
                throw InvalidInput("a second open; a stream has one, its first message");
            case v1::StreamRequest::kFrameBegin:
                assembler_.begin(request_.frame_begin(), *input_);
                enter_frame(true);
                break;
            case v1::StreamRequest::kFrameChunk:
                assembler_.append(request_.frame_chunk(), *input_);
                break;
            case v1::StreamRequest::kFrameEnd:
                assembler_.end(*input_);
                session_->submit(upload_, *std::exchange(input_, nullptr));
                if (enter_frame(false))
                    request_input();
                else
                    end_reading(shutting_down());
                return;
            case v1::StreamRequest::MESSAGE_NOT_SET:
                throw InvalidInput("a message of a kind that this version does not know");
        }
        StartRead(&incoming_);
    }

    void open(const v1::StreamOpen& message) {
        require_same_session(session_id_, message.session_id());
        const UploadOptions options{.receive_meshes = message.receive_meshes(), .normal_bits = normal_bits_of(message)};
        const auto session = registry_.find(session_id_);
        Authorizer::require_access(caller_, Action::stream, session_id_, session->owner());
        const auto wake = [self = weak_from_this()] {
            if (const auto reactor = self.lock()) reactor->write();
        };
        const auto drain = [self = weak_from_this()] {
            if (const auto reactor = self.lock()) reactor->drain();
        };
        auto upload = session->open_upload(options, wake, drain);
        spdlog::info("session {}: stream from {} opened", session_id_, peer_);
        {
            const std::lock_guard lock(mutex_);
            session_ = session;
            upload_ = std::move(upload);
        }
        write();
    }

    /// The next read starts once a slot is free: until then gRPC's flow control slows the simulator down.
    void request_input() {
        session_->request_input([self = weak_from_this()](InputFrame& input) {
            const auto reactor = self.lock();
            return reactor && reactor->use_input(input);
        });
    }

    bool use_input(InputFrame& input) {
        // Locked, so that the call cannot end in between.
        const std::lock_guard lock(mutex_);
        if (reading_ended_ || canceled_) return false;
        input_ = &input;
        StartRead(&incoming_);
        return true;
    }

    void give_input_back() {
        if (input_ != nullptr) session_->return_input(*std::exchange(input_, nullptr));
    }

    /// False if the frame that has ended is to be the last.
    bool enter_frame(bool in_frame) {
        const std::lock_guard lock(mutex_);
        in_frame_ = in_frame;
        return in_frame || !draining_;
    }

    /// What was received before is answered, then the call ends with the error.
    void end_reading(std::exception_ptr error) {
        give_input_back();
        stop_reading(std::move(error));
    }

    void stop_reading(std::exception_ptr error) {
        std::shared_ptr<Upload> upload;
        {
            const std::lock_guard lock(mutex_);
            if (std::exchange(reading_ended_, true)) return;
            upload = upload_;
        }
        if (upload)
            session_->end_upload(std::move(upload), std::move(error));
        else
            refuse(std::move(error));
    }

    /// From another thread. Between two frames the read that is under way is left to itself.
    void drain() {
        {
            const std::lock_guard lock(mutex_);
            draining_ = true;
            if (in_frame_) return;
        }
        stop_reading(shutting_down());
    }

    static std::exception_ptr shutting_down() {
        return std::make_exception_ptr(Refusal(Refusal::Kind::unavailable, "the server is shutting down"));
    }

    /// Ends a call that never had an upload.
    void refuse(std::exception_ptr error) {
        {
            const std::lock_guard lock(mutex_);
            reading_ended_ = true;
            refusal_ = std::move(error);
        }
        write();
    }

    void write() {
        const std::lock_guard lock(mutex_);
        if (writing_ || finished_) return;
        if (canceled_) {
            finish({grpc::StatusCode::CANCELLED, "the client has gone"});
        } else if (refusal_) {
            finish(to_status(*refusal_));
        } else if (upload_) {
            auto next = upload_->output.take();
            if (const auto* message = std::get_if<SharedMessage>(&next)) {
                registry_.metrics().message_sent(Metrics::Receiver::simulator, (*message)->size());
                outgoing_ = to_bytes(*message);
                writing_ = true;
                StartWrite(&outgoing_);
            } else if (const auto* end = std::get_if<OutputQueue::End>(&next)) {
                finish(to_status(end->error));
            }
        }
    }

    void finish(const grpc::Status& status) {
        finished_ = true;
        reading_ended_ = true;
        outcome_ = status.ok() ? "done" : status.error_message();
        Finish(status);
    }

    const ActiveCalls::Token active_;
    SessionRegistry& registry_;
    const std::string peer_;
    std::shared_ptr<StreamReactor> self_;  ///< until OnDone
    Caller caller_;
    std::string session_id_;

    // Of the reading side.
    grpc::ByteBuffer incoming_;
    v1::StreamRequest request_;
    FrameAssembler assembler_;
    InputFrame* input_ = nullptr;

    // Set once, by the reading side, with the lock held.
    std::shared_ptr<Session> session_;
    std::shared_ptr<Upload> upload_;

    std::mutex mutex_;  ///< for what follows
    grpc::ByteBuffer outgoing_;
    std::optional<std::exception_ptr> refusal_;
    std::string outcome_;
    bool in_frame_ = false;
    bool draining_ = false;
    bool reading_ended_ = false;
    bool writing_ = false;
    bool canceled_ = false;
    bool finished_ = false;
};

}  // namespace

grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* start_stream(SessionRegistry& registry,
                                                                          const Authorizer& authorizer,
                                                                          ActiveCalls& calls,
                                                                          grpc::CallbackServerContext& context) {
    const auto reactor = std::make_shared<StreamReactor>(registry, calls, context);
    reactor->start(authorizer, context);
    return reactor.get();
}

}  // namespace meniscus::server
