#include "rpc/handlers/stream_handler.hpp"

#include <fmt/format.h>
#include <google/protobuf/unknown_field_set.h>
#include <grpcpp/alarm.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "process/call_log.hpp"
#include "rpc/calls/caller.hpp"
#include "rpc/calls/cancel_timer.hpp"
#include "rpc/calls/status.hpp"
#include "rpc/messages/codec_choice.hpp"
#include "rpc/messages/frame_chunk_reader.hpp"
#include "rpc/messages/session_id.hpp"
#include "rpc/messages/upload_options.hpp"
#include "rpc/messages/wire_bytes.hpp"
#include "sessions/intake/frame_assembler.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

namespace {

/// Two sides run side by side. The reading side is one thread at a time: a read is under way, or a free input slot is
/// waited for, or the session before that, or reading has ended. It owns the input slot while it works on a message;
/// otherwise the lock's holder does, so that a call that ends gives its slot back however dead its connection is. The
/// writing side sends what the upload's output holds and finishes the call after its end. It also finishes after a
/// cancellation, as soon as no write is under way, so that no call outlives its client.
class StreamReactor final : public ByteReactor, public std::enable_shared_from_this<StreamReactor> {
public:
    StreamReactor(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals, ActiveCalls& calls,
                  grpc::CallbackServerContext& context)
        : calls_(calls),
          registry_(registry),
          refusals_(refusals),
          context_(context),
          timer_(context),
          peer_(peer_of(authorizer, context)),
          assembler_(registry.limits()) {}

    void start(const Authorizer& authorizer) {
        self_ = shared_from_this();
        try {
            caller_ = admit(authorizer, context_, Action::stream);
            session_id_ = metadata_session_id(context_);
        } catch (...) {
            refuse(std::current_exception());
            return;
        }
        timer_.start(first_message_patience);
        start_read();
    }

    // The reading side.

    void OnReadDone(bool ok) override {
        if (!begin_work()) return;
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
        timer_.call_is_done();
        const auto self = std::move(self_);
        if (!upload_) return;
        // For a call that ended before its upload: nobody reads, and the session is free for the next stream.
        // Whether the status was sent, gRPC knows only now: a connection's reads may fail before it is known to be
        // broken, and then the call was finished as one after which nothing followed.
        session_->cancel_upload(upload_, context_.IsCancelled() ? UploadEnd::vanished : UploadEnd::answered);
        call_log.write({.session = session_id_}, "stream from {} closed: {}", peer_, outcome_);
    }

private:
    /// False if what has been read is not wanted any more.
    bool begin_work() {
        const std::lock_guard lock(mutex_);
        if (reading_ended_ || canceled_) return false;
        working_ = true;
        return true;
    }

    void receive() {
        if (!upload_) {
            parse(incoming_, request_, "StreamRequest");
            if (!request_.has_open()) throw InvalidInput("the first message of a stream must be open");
            timer_.stop();
            open_or_wait();
            return;
        }
        upload_->last_activity = Upload::Clock::now();
        if (!receive_chunk() && !receive_message()) return;
        read_once_booked();
    }

    /// False if it is another message.
    bool receive_chunk() {
        grpc::ProtoBufferReader bytes(&incoming_);
        if (!bytes.status().ok()) return false;
        FrameChunkReader chunk(bytes, incoming_.Length());
        if (!chunk.bytes()) return false;
        assembler_.append(*chunk.bytes(), *input_, chunk);
        upload_->pace.arrived(*chunk.bytes());
        return true;
    }

    /// False if the next read is not for now.
    bool receive_message() {
        parse(incoming_, request_, "StreamRequest");
        switch (request_.message_case()) {
            case v1::StreamRequest::kOpen:
                throw InvalidInput("a second open; a stream has one, its first message");
            case v1::StreamRequest::kFrameBegin:
                session_->admit_frame(request_.frame_begin().frame_index());
                assembler_.begin(request_.frame_begin(), *input_);
                upload_->pace.begin(request_.frame_begin().frame_index(), assembler_.expected());
                enter_frame(true);
                return true;
            case v1::StreamRequest::kFrameChunk:
                assembler_.append(request_.frame_chunk(), *input_);
                upload_->pace.arrived(request_.frame_chunk().data().size());
                return true;
            case v1::StreamRequest::kFrameEnd:
                assembler_.end(*input_);
                upload_->pace.end();
                session_->submit(upload_, *std::exchange(input_, nullptr));
                if (enter_frame(false))
                    request_input();
                else
                    end_reading(std::make_exception_ptr(shutting_down()));
                return false;
            case v1::StreamRequest::kMove:
                assembler_.end_of_stream();
                upload_->moves = true;
                end_reading(std::make_exception_ptr(moved()));
                return false;
            case v1::StreamRequest::MESSAGE_NOT_SET:
                break;
        }
        throw InvalidInput(unknown_kind(request_));
    }

    static std::string unknown_kind(const v1::StreamRequest& message) {
        const auto& fields = message.GetReflection()->GetUnknownFields(message);
        if (fields.empty()) return "a message of no kind: it has no field";
        return fmt::format("a message with the field {}, a kind that this version does not know",
                           fields.field(0).number());
    }

    /// The next read starts once what has arrived is booked: until then gRPC's flow control slows the simulator down.
    void read_once_booked() {
        const bool booked = input_->book(assembler_.arrived(), [self = weak_from_this()] {
            if (const auto reactor = self.lock()) reactor->booked();
        });
        InputFrame* unused = nullptr;
        {
            const std::lock_guard lock(mutex_);
            working_ = false;
            if (reading_ended_ || canceled_) {
                unused = std::exchange(input_, nullptr);
            } else if (booked || std::exchange(booked_already_, false)) {
                start_read();
            } else {
                waits_for_room_ = true;
                upload_->pace.pause();
            }
        }
        if (unused != nullptr) session_->return_input(*unused);
    }

    /// Called by another thread, which may be faster than the one that asked.
    void booked() {
        const std::lock_guard lock(mutex_);
        if (!std::exchange(waits_for_room_, false)) {
            booked_already_ = true;
            return;
        }
        upload_->pace.resume();
        if (!reading_ended_ && !canceled_) start_read();
    }

    void start_read() {
        incoming_.Clear();
        StartRead(&incoming_);
    }

    /// A session that another stream uploads to is asked for again, for a moment: the client of a stream that gRPC has
    /// ended, for a message that is too large, knows of its end before the session does. False: another attempt
    /// follows.
    bool open_or_wait() {
        constexpr auto patience = std::chrono::milliseconds(100);
        try {
            open(request_.open());
        } catch (const Refusal& refusal) {
            const auto now = Upload::Clock::now();
            if (!open_until_) open_until_ = now + patience;
            if (refusal.kind() != Refusal::Kind::failed_precondition || now >= *open_until_) throw;
            open_again_soon();
            return false;
        }
        request_input();
        return true;
    }

    void open_again_soon() {
        constexpr auto pause = std::chrono::milliseconds(5);
        {
            const std::lock_guard lock(mutex_);
            working_ = false;
            waits_to_open_ = true;
        }
        alarm_ = std::make_unique<grpc::Alarm>();
        alarm_->Set(std::chrono::system_clock::now() + pause, [weak = weak_from_this()](bool /*rang*/) {
            if (const auto self = weak.lock()) self->open_again();
        });
    }

    /// gRPC knows nothing of the alarm: once the call is finished, it frees the context, whatever is under way here.
    void open_again() {
        bool is_over = true;
        if (begin_work()) {
            try {
                is_over = open_or_wait();
            } catch (...) {
                end_reading(std::current_exception());
            }
        }
        if (!is_over) return;
        {
            const std::lock_guard lock(mutex_);
            waits_to_open_ = false;
        }
        write();
    }

    void open(const v1::StreamOpen& message) {
        require_same_session(session_id_, message.session_id());
        UploadOptions options = upload_options(message);
        const auto session = find_session(caller_, registry_, session_id_);
        const CodecChoice codec = codec_choice(message);
        options.codec = codec.codec;
        const auto wake = [self = weak_from_this()] {
            if (const auto reactor = self.lock()) reactor->write();
        };
        const auto drain = [self = weak_from_this()] {
            if (const auto reactor = self.lock()) reactor->drain();
        };
        const auto stop = [self = weak_from_this()](std::exception_ptr error) {
            if (const auto reactor = self.lock()) reactor->stop_reading(std::move(error));
        };
        // Before it, as a server that stops waits for streams of its sessions alone.
        if (!active_) active_.emplace(calls_);
        auto upload = session->open_upload(options, wake, drain, stop);
        assembler_ = FrameAssembler(registry_.limits(), session->settings());
        call_log.write({.session = session_id_}, "stream from {} opened", peer_);
        {
            const std::lock_guard lock(mutex_);
            session_ = session;
            upload_ = std::move(upload);
            if (upload_->options.receive_meshes) announce(codec, context_);
            // The client knows from here on which server it has. The server may have gone down since open_upload().
            if (!finished_) StartSendInitialMetadata();
        }
        write();
    }

    /// The next read starts once a slot is free, and the simulator reads its answers: until then gRPC's flow
    /// control slows it down.
    void request_input() {
        {
            const std::lock_guard lock(mutex_);
            working_ = false;
        }
        upload_->unreported_drops.when_below_limit([self = weak_from_this(), session = session_] {
            session->request_input([self](InputFrame& input) {
                const auto reactor = self.lock();
                return reactor && reactor->use_input(input);
            });
        });
    }

    bool use_input(InputFrame& input) {
        // Locked, so that the call cannot end in between.
        const std::lock_guard lock(mutex_);
        if (reading_ended_ || canceled_) return false;
        input_ = &input;
        start_read();
        return true;
    }

    /// False if the frame that has ended is to be the last.
    bool enter_frame(bool in_frame) {
        const std::lock_guard lock(mutex_);
        in_frame_ = in_frame;
        return in_frame || !draining_;
    }

    /// Ends reading: the frames that were received before are answered, then the call ends with the error.
    void end_reading(std::exception_ptr error) {
        InputFrame* unused = nullptr;
        {
            const std::lock_guard lock(mutex_);
            working_ = false;
            unused = std::exchange(input_, nullptr);
        }
        if (unused != nullptr) session_->return_input(*unused);
        stop_reading(std::move(error));
    }

    void stop_reading(std::exception_ptr error) {
        std::shared_ptr<Upload> upload;
        InputFrame* unused = nullptr;
        {
            const std::lock_guard lock(mutex_);
            if (std::exchange(reading_ended_, true)) return;
            upload = upload_;
            // Now, and not with the call's end: a simulator that reads nothing could hold it back.
            if (!working_) unused = std::exchange(input_, nullptr);
        }
        if (unused != nullptr) session_->return_input(*unused);
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
        stop_reading(std::make_exception_ptr(shutting_down()));
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
        InputFrame* unused = nullptr;
        {
            const std::lock_guard lock(mutex_);
            if (finished_ || waits_to_open_) return;
            if (writing_) {
                // Otherwise a client that takes nothing would never learn of the end, and its call stay for good.
                if (upload_ && upload_->output.aborted() && !timer_.runs()) timer_.start(last_message_patience);
                return;
            }
            write_next();
            if (finished_ && !working_) unused = std::exchange(input_, nullptr);
        }
        // Outside of the lock: the slot may go to another stream at once.
        if (unused != nullptr) session_->return_input(*unused);
    }

    void write_next() {
        if (canceled_) {
            finish(client_gone());
        } else if (refusal_) {
            finish_with(*refusal_);
        } else if (upload_) {
            auto next = upload_->output.take();
            if (const auto* message = std::get_if<SharedMessage>(&next)) {
                registry_.metrics().message_sent(Metrics::Receiver::simulator, (*message)->size());
                outgoing_ = to_bytes(*message);
                writing_ = true;
                StartWrite(&outgoing_);
            } else if (const auto* end = std::get_if<OutputQueue::End>(&next)) {
                if (is_idle(end->error)) context_.AddTrailingMetadata("x-stream-end", "idle");
                finish_with(end->error);
            }
        }
    }

    static bool is_idle(const std::exception_ptr& error) {
        if (!error) return false;
        try {
            std::rethrow_exception(error);
        } catch (const IdleStream&) {
            return true;
        } catch (...) {
            return false;
        }
    }

    void finish_with(const std::exception_ptr& error) {
        refusals_.report(error, caller_.name, peer_);
        finish(to_status(error));
    }

    void finish(const grpc::Status& status) {
        finished_ = true;
        reading_ended_ = true;
        outcome_ = status.ok() ? "done" : status.error_message();
        Finish(status);
    }

    ActiveCalls& calls_;
    std::optional<ActiveCalls::Token> active_;  ///< once it has opened a session
    SessionRegistry& registry_;
    Refusals& refusals_;
    grpc::CallbackServerContext& context_;  ///< gRPC keeps it until OnDone
    CancelTimer timer_;                     ///< for the first message, and for the last
    const std::string peer_;
    std::shared_ptr<StreamReactor> self_;  ///< until OnDone
    Caller caller_;
    std::string session_id_;

    // The following belong to the reading side.
    grpc::ByteBuffer incoming_;
    v1::StreamRequest request_;
    FrameAssembler assembler_;  ///< of the session, once there is one
    InputFrame* input_ = nullptr;
    std::optional<Upload::Clock::time_point> open_until_;  ///< none: the session was free at once
    std::unique_ptr<grpc::Alarm> alarm_;                   ///< for the next attempt

    // Set once, by the reading side, with the lock held.
    std::shared_ptr<Session> session_;
    std::shared_ptr<Upload> upload_;

    std::mutex mutex_;  ///< for what follows
    grpc::ByteBuffer outgoing_;
    std::optional<std::exception_ptr> refusal_;
    std::string outcome_;
    bool working_ = false;         ///< the reading side, on a message
    bool waits_to_open_ = false;   ///< until its last attempt is over; nothing is written, and the call not finished
    bool waits_for_room_ = false;  ///< the reading side
    bool booked_already_ = false;  ///< before it waited
    bool in_frame_ = false;
    bool draining_ = false;
    bool reading_ended_ = false;
    bool writing_ = false;
    bool canceled_ = false;
    bool finished_ = false;
};

}  // namespace

ByteReactor* start_stream(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals,
                          ActiveCalls& calls, grpc::CallbackServerContext& context) {
    const auto reactor = std::make_shared<StreamReactor>(registry, authorizer, refusals, calls, context);
    reactor->start(authorizer);
    return reactor.get();
}

}  // namespace meniscus::server
