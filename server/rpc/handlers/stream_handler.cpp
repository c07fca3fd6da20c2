#include "rpc/handlers/stream_handler.hpp"

#include <fmt/format.h>
#include <google/protobuf/unknown_field_set.h>
#include <grpcpp/alarm.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

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
#include "sessions/session/joint_upload.hpp"

namespace meniscus::server {

namespace {

/// Two sides run side by side. The reading side is one thread at a time: a read is under way, or a free input slot or
/// the other parts of the frame are waited for, or the session before that, or reading has ended. The joint upload has
/// the slot, and keeps it while this works on a message. The writing side sends what the upload's output holds for this
/// part and finishes the call after its end. It also finishes after a cancellation, as soon as no write is under way,
/// so that no call outlives its client. Request: StreamRequest or PublishRequest, which have the same kinds of message.
template <class Request>
class StreamReactor final : public ByteReactor,
                            public PartStream,
                            public std::enable_shared_from_this<StreamReactor<Request>> {
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
        self_ = this->shared_from_this();
        try {
            caller_ = admit(authorizer, context_, publishes ? Action::publish : Action::stream);
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
        const bool had_joint = joint_ != nullptr;
        if (!begin_work()) return;
        try {
            if (ok)
                receive();
            else
                end_of_stream();
        } catch (...) {
            fail(std::current_exception());
        }
        if (had_joint) joint_->leave();
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
        joint_->done(part_, context_.IsCancelled() ? UploadEnd::vanished : UploadEnd::answered);
        call_log.write({.session = session_id_}, "{} from {} closed: {}", noun, peer_, outcome_);
    }

    // The joint upload's side.

    void wake() override { write(); }

    void read_next() override {
        // Locked, so that the call cannot end in between.
        const std::lock_guard lock(mutex_);
        if (!reading_ended_ && !canceled_) start_read();
    }

    void begun(std::optional<std::vector<FramePiece>> pieces) override {
        if (!begin_work()) return;
        try {
            passes_over_ = !pieces;
            if (passes_over_)
                assembler_.pass_over(announced_);
            else
                assembler_.place(announced_, *std::move(pieces));
            read_once_booked();
        } catch (...) {
            fail(std::current_exception());
        }
        joint_->leave();
    }

    void stop_reading() override {
        const std::lock_guard lock(mutex_);
        reading_ended_ = true;
    }

private:
    static constexpr bool publishes = std::is_same_v<Request, v1::PublishRequest>;
    static constexpr const char* noun = publishes ? "publisher" : "stream";
    static_assert(int{Request::kFrameChunkFieldNumber} == int{v1::StreamRequest::kFrameChunkFieldNumber},
                  "FrameChunkReader knows chunks by their number");

    /// False if what has been read is not wanted any more. Once there is a joint upload, it is left after the work.
    bool begin_work() {
        {
            const std::lock_guard lock(mutex_);
            if (reading_ended_ || canceled_) return false;
        }
        return !joint_ || joint_->enter();
    }

    /// gRPC ends the reads of a broken connection as those of a client that has said all. A part says so itself, since
    /// the others lose a frame that it leaves out.
    void end_of_stream() {
        if (joint_ && joint_->has_parts()) return joint_->lose(part_);
        assembler_.end_of_stream();
        if (!joint_) throw InvalidInput("the stream ended before its first message, open");
        joint_->close(part_);
    }

    void receive() {
        if (!upload_) {
            parse(incoming_, request_, name_of_request());
            if (!request_.has_open()) throw InvalidInput("the first message of a stream must be open");
            timer_.stop();
            open_or_wait();
            return;
        }
        upload_->last_activity = Upload::Clock::now();
        if (receive_chunk() || receive_message()) read_once_booked();
    }

    /// False if it is another message.
    bool receive_chunk() {
        grpc::ProtoBufferReader bytes(&incoming_);
        if (!bytes.status().ok()) return false;
        FrameChunkReader chunk(bytes, incoming_.Length());
        if (!chunk.bytes()) return false;
        assembler_.append(*chunk.bytes(), joint_->input(), chunk);
        chunk_arrived(*chunk.bytes());
        return true;
    }

    void chunk_arrived(std::size_t bytes) {
        if (!passes_over_) upload_->pace.arrived(bytes);
    }

    /// False if the joint upload says when the next read is due.
    bool receive_message() {
        parse(incoming_, request_, name_of_request());
        switch (request_.message_case()) {
            case Request::kOpen:
                throw InvalidInput("a second open; a stream has one, its first message");
            case Request::kFrameBegin:
                announced_ = assembler_.announce(request_.frame_begin());
                joint_->begin(part_, announced_);
                return false;
            case Request::kFrameChunk:
                assembler_.append(request_.frame_chunk(), joint_->input());
                chunk_arrived(request_.frame_chunk().data().size());
                return true;
            case Request::kFrameEnd:
                assembler_.end();
                joint_->end(part_);
                return false;
            case Request::kMove:
                assembler_.end_of_stream();
                joint_->move();
                return false;
            case Request::kFinish:
                assembler_.end_of_stream();
                joint_->close(part_);
                return false;
            case Request::MESSAGE_NOT_SET:
                break;
        }
        throw InvalidInput(unknown_kind(request_));
    }

    static const char* name_of_request() { return publishes ? "PublishRequest" : "StreamRequest"; }

    static std::string unknown_kind(const Request& message) {
        const auto& fields = message.GetReflection()->GetUnknownFields(message);
        if (fields.empty()) return "a message of no kind: it has no field";
        return fmt::format("a message with the field {}, a kind that this version does not know",
                           fields.field(0).number());
    }

    /// The next read starts once what has arrived is booked: until then gRPC's flow control slows the simulator down.
    void read_once_booked() {
        const bool booked = passes_over_ || joint_->book(assembler_.take_kept(), [self = this->weak_from_this()] {
            if (const auto reactor = self.lock()) reactor->booked();
        });
        const std::lock_guard lock(mutex_);
        if (reading_ended_ || canceled_) return;
        if (booked || std::exchange(booked_already_, false)) {
            start_read();
        } else {
            waits_for_room_ = true;
            upload_->pace.pause();
        }
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
        joint_->ready(part_);
        return true;
    }

    void open_again_soon() {
        constexpr auto pause = std::chrono::milliseconds(5);
        {
            const std::lock_guard lock(mutex_);
            waits_to_open_ = true;
        }
        alarm_ = std::make_unique<grpc::Alarm>();
        alarm_->Set(std::chrono::system_clock::now() + pause, [weak = this->weak_from_this()](bool /*rang*/) {
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
                fail(std::current_exception());
            }
        }
        if (!is_over) return;
        {
            const std::lock_guard lock(mutex_);
            waits_to_open_ = false;
        }
        write();
    }

    template <class Open>
    void open(const Open& message) {
        require_same_session(session_id_, message.session_id());
        UploadOptions options = upload_options(message);
        const auto session = find_session(caller_, registry_, session_id_);
        CodecChoice codec;
        if constexpr (!publishes) codec = codec_choice(message);
        options.codec = codec.codec;
        // Before it, as a server that stops waits for streams of its sessions alone.
        if (!active_) active_.emplace(calls_);
        auto joint = JointUpload::open(session, options, message.part(), this->weak_from_this());
        assembler_ = FrameAssembler(registry_.limits(), session->settings());
        call_log.write({.session = session_id_}, "{} from {} opened", noun, peer_);
        {
            const std::lock_guard lock(mutex_);
            part_ = message.part();
            joint_ = std::move(joint);
            upload_ = joint_->upload();
            if (options.receive_meshes) announce(codec, context_);
            // The client knows from here on which server it has. The server may have gone down since open_upload().
            if (!finished_) StartSendInitialMetadata();
        }
        write();
    }

    /// Ends reading: the frames that were received before are answered, then the calls of all parts end with the error.
    void fail(std::exception_ptr error) {
        if (joint_)
            joint_->fail(part_, error);
        else
            refuse(std::move(error));
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
        {
            const std::lock_guard lock(mutex_);
            if (finished_ || waits_to_open_) return;
            if (writing_) {
                // Otherwise a client that takes nothing would never learn of the end, and its call stay for good.
                if (upload_ && upload_->output.aborted() && !timer_.runs()) timer_.start(last_message_patience);
                return;
            }
            write_next();
            if (!finished_ || !joint_) return;
        }
        joint_->finished();
    }

    void write_next() {
        if (canceled_) {
            finish(client_gone());
        } else if (refusal_) {
            finish_with(*refusal_);
        } else if (upload_) {
            auto next = upload_->output.take(part_);
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
    Request request_;
    FrameAssembler assembler_;                             ///< of the session, once there is one
    FramePart announced_;                                  ///< of the frame begun last
    bool passes_over_ = false;                             ///< its bytes
    std::optional<Upload::Clock::time_point> open_until_;  ///< none: the session was free at once
    std::unique_ptr<grpc::Alarm> alarm_;                   ///< for the next attempt

    // Set once, by the reading side, with the lock held.
    std::uint32_t part_ = 0;
    std::shared_ptr<JointUpload> joint_;
    std::shared_ptr<Upload> upload_;

    std::mutex mutex_;  ///< for what follows
    grpc::ByteBuffer outgoing_;
    std::optional<std::exception_ptr> refusal_;
    std::string outcome_;
    bool waits_to_open_ = false;   ///< until its last attempt is over; nothing is written, and the call not finished
    bool waits_for_room_ = false;  ///< the reading side
    bool booked_already_ = false;  ///< before it waited
    bool reading_ended_ = false;
    bool writing_ = false;
    bool canceled_ = false;
    bool finished_ = false;
};

}  // namespace

template <class Request>
ByteReactor* start_stream(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals,
                          ActiveCalls& calls, grpc::CallbackServerContext& context) {
    const auto reactor = std::make_shared<StreamReactor<Request>>(registry, authorizer, refusals, calls, context);
    reactor->start(authorizer);
    return reactor.get();
}

template ByteReactor* start_stream<v1::StreamRequest>(SessionRegistry&, const Authorizer&, Refusals&, ActiveCalls&,
                                                      grpc::CallbackServerContext&);
template ByteReactor* start_stream<v1::PublishRequest>(SessionRegistry&, const Authorizer&, Refusals&, ActiveCalls&,
                                                       grpc::CallbackServerContext&);

}  // namespace meniscus::server
