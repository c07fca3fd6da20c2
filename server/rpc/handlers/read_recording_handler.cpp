#include "rpc/handlers/read_recording_handler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "conversion/codec_conversion.hpp"
#include "files/delimited_messages.hpp"
#include "files/recording_format.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/recording_service.pb.h"
#include "process/log.hpp"
#include "recording/reader_codec.hpp"
#include "rpc/calls/caller.hpp"
#include "rpc/calls/cancel_timer.hpp"
#include "rpc/calls/one_request.hpp"
#include "rpc/calls/status.hpp"
#include "rpc/messages/session_id.hpp"
#include "rpc/messages/wire_bytes.hpp"
#include "sessions/limits/refusal.hpp"
#include "sessions/sending/spray_messages.hpp"

namespace meniscus::server {

namespace {

/// The messages of some frames of a recording, one after the other.
class RecordedMessages {
public:
    RecordedMessages(const RecordingCatalog::Opened& opened, const v1::ReadRecordingRequest& request)
        : file_(opened.file),
          with_spray_(request.with_spray()),
          codec_(conversion::named_codecs(request.codecs())),
          name_(fmt::format("recording {} of session {}", request.number(), request.session_id())) {
        const auto& meshes = opened.index.meshes();
        const std::uint64_t first = request.position();
        if (first > meshes.size() || (first == meshes.size() && first != 0))
            throw InvalidInput(fmt::format("position is {}; {} has {} frames", first, name_, meshes.size()));
        const std::uint64_t left = meshes.size() - first;
        const std::uint64_t count = request.count() == 0 ? left : std::min(left, request.count());
        const auto begin = meshes.begin() + static_cast<std::ptrdiff_t>(first);
        meshes_.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    }

    /// None after the last. Throws Refusal, data_loss, where the file is damaged.
    SharedMessage next() {
        try {
            for (;;) {
                if (!ready_.empty()) {
                    auto message = std::make_shared<const std::string>(std::move(ready_.front()));
                    ready_.pop_front();
                    return message;
                }
                if (messages_ && messages_->at_end()) messages_.reset();
                if (!messages_) {
                    if (at_ == meshes_.size()) return nullptr;
                    const files::RecordedRange& range = meshes_[at_++].messages;
                    // Before its first message leaves: a client does not put a damaged frame together.
                    if (!files::is_whole(*file_, range)) file_->fail("its messages do not have their checksum");
                    messages_.emplace(*file_, range.first, range.first + range.size);
                }
                auto message = messages_->next(files::max_recorded_message_bytes);
                if (!message) file_->fail("a message is cut");
                if (is_spray(*message) && !with_spray_) continue;
                for (std::string& each : codec_.messages_for(std::move(*message))) ready_.push_back(std::move(each));
            }
        } catch (const InvalidInput& error) {
            const std::uint64_t frame = meshes_[at_ - 1].frame_index;
            log_error({.frame = frame}, "a recording cannot be read: {}", error.what());
            throw Refusal(Refusal::Kind::data_loss,
                          fmt::format("{} is damaged at frame {}; the server's log says where", name_, frame));
        }
    }

private:
    const std::shared_ptr<const files::RandomAccessFile> file_;
    const bool with_spray_;
    ReaderCodec codec_;
    const std::string name_;
    std::vector<MeshPlace> meshes_;
    std::size_t at_ = 0;                                ///< the next of meshes_
    std::optional<files::DelimitedMessages> messages_;  ///< of the one before
    std::deque<std::string> ready_;                     ///< to be sent before the next of those
};

/// Holds one message at a time: the next one is read when gRPC has taken the one before. At any moment either the
/// request's read, a job of the thread that reads or a write is under way, and only that goes on, or finishes; after a
/// cancellation, too.
class ReadRecordingReactor final : public ByteReactor, public std::enable_shared_from_this<ReadRecordingReactor> {
public:
    ReadRecordingReactor(const Authorizer& authorizer, Refusals& refusals, Metrics& metrics, ActiveCalls& calls,
                         grpc::CallbackServerContext& context)
        : refusals_(refusals),
          metrics_(metrics),
          active_(calls),
          peer_(peer_of(authorizer, context)),
          context_(context),
          timer_(context) {}

    void start(RecordingReads* reads, const Authorizer& authorizer) {
        self_ = shared_from_this();
        try {
            caller_ = admit(authorizer, context_, Action::read_recording);
            reads_ = &require_recorded(reads);
            session_id_ = metadata_session_id(context_);
        } catch (...) {
            return refuse(std::current_exception());
        }
        timer_.start(first_message_patience);
        StartRead(&incoming_);
    }

    void OnReadDone(bool ok) override {
        timer_.stop();
        if (!ok && context_.IsCancelled()) return Finish(client_gone());
        try {
            request_ = received<v1::ReadRecordingRequest>(ok, incoming_);
            require_same_session(session_id_, request_.session_id());
            conversion::named_codecs(request_.codecs());  // refuses those that are not known, before it takes a place
            place_ = reads_->admit();
            go_on([this](RecordingCatalog& catalog) {
                open(catalog);
                // With metadata, as a refusal has none.
                context_.AddInitialMetadata("x-session-id", session_id_);
                StartSendInitialMetadata();
            });
        } catch (...) {
            refuse(std::current_exception());
        }
    }

    void OnWriteDone(bool ok) override {
        timer_.stop();
        if (!ok) canceled_ = true;
        go_on([](RecordingCatalog&) {});
    }

    void OnCancel() override { canceled_ = true; }

    void OnDone() override {
        timer_.call_is_done();
        const auto self = std::move(self_);
    }

private:
    /// On the thread that reads: `first`, then the next message.
    template <class First>
    void go_on(First first) {
        reads_->post([self = shared_from_this(), first = std::move(first)](RecordingCatalog& catalog) {
            try {
                first(catalog);
                self->send_next();
            } catch (...) {
                self->refuse(std::current_exception());
            }
        });
    }

    void open(RecordingCatalog& catalog) {
        const auto opened = catalog.open({.session_id = session_id_, .number = request_.number()},
                                         [&](const std::string& owner) { return Authorizer::may_see(caller_, owner); });
        messages_.emplace(opened, request_);
    }

    void send_next() {
        if (canceled_) return finish(client_gone());
        reads_->require_going_on();
        const SharedMessage message = messages_->next();
        if (!message) return finish(grpc::Status::OK);
        metrics_.message_sent(Metrics::Receiver::recording_reader, message->size());
        outgoing_ = to_bytes(message);
        await_client();
        StartWrite(&outgoing_);
    }

    /// A client that takes nothing keeps its place from others. What is under way can only be canceled.
    void await_client() {
        if (reads_->patience().count() == 0) return;
        timer_.start(reads_->patience(), [session = session_id_, peer = peer_, patience = reads_->patience()] {
            log_info({.session = session},
                     "a reader of its recording from {} has taken nothing for {:.3g} s: its call ends", peer,
                     std::chrono::duration<double>(patience).count());
        });
    }

    void refuse(const std::exception_ptr& error) {
        refusals_.report(error, caller_.name, peer_);
        finish(to_status(error));
    }

    void finish(const grpc::Status& status) {
        messages_.reset();  // before the client knows: it may delete next what it has read
        Finish(status);
    }

    Refusals& refusals_;
    Metrics& metrics_;
    const ActiveCalls::Token active_;
    const std::string peer_;
    grpc::CallbackServerContext& context_;        ///< gRPC keeps it until OnDone
    CancelTimer timer_;                           ///< for the request, and for the write under way
    std::shared_ptr<ReadRecordingReactor> self_;  ///< until OnDone
    RecordingReads* reads_ = nullptr;
    RecordingReads::Place place_;
    Caller caller_;
    std::string session_id_;
    grpc::ByteBuffer incoming_;
    v1::ReadRecordingRequest request_;
    std::optional<RecordedMessages> messages_;
    grpc::ByteBuffer outgoing_;
    std::atomic<bool> canceled_{false};
};

}  // namespace

RecordingReads& require_recorded(RecordingReads* reads) {
    if (reads == nullptr)
        throw Refusal(Refusal::Kind::unimplemented, "this server keeps no recordings: meniscusd --record DIR does");
    return *reads;
}

ByteReactor* start_reading(RecordingReads* reads, const Authorizer& authorizer, Refusals& refusals, Metrics& metrics,
                           ActiveCalls& calls, grpc::CallbackServerContext& context) {
    const auto reactor = std::make_shared<ReadRecordingReactor>(authorizer, refusals, metrics, calls, context);
    reactor->start(reads, authorizer);
    return reactor.get();
}

}  // namespace meniscus::server
