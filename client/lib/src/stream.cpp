#include <algorithm>
#include <utility>

#include "call_end.hpp"
#include "codec_order.hpp"
#include "connection/deadline.hpp"
#include "error_mapping.hpp"
#include "meniscus/error.hpp"
#include "receiving/frame_receiver.hpp"
#include "session_look.hpp"
#include "stream_impl.hpp"
#include "unary_call.hpp"
#include "upload_opening.hpp"

namespace meniscus::client {

namespace {

/// The time that a caller which leaves a stream waits for its threads. A canceled call ends within milliseconds.
constexpr std::chrono::milliseconds patience_with_threads{300};

DropReason from_wire(v1::DropReason reason) {
    switch (reason) {
        case v1::DROP_REASON_REPLACED:
            return DropReason::replaced;
        case v1::DROP_REASON_NOT_NTH:
            return DropReason::not_nth;
        case v1::DROP_REASON_INCOMPLETE:
            return DropReason::incomplete;
        case v1::DROP_REASON_UNSPECIFIED:
        case v1::DropReason_INT_MIN_SENTINEL_DO_NOT_USE_:
        case v1::DropReason_INT_MAX_SENTINEL_DO_NOT_USE_:
            break;
    }
    throw ServerError("the server dropped a frame for reason " + std::to_string(reason) +
                      ", which this version does not know");
}

StreamOptions with_bounded_waits(StreamOptions options) {
    options.reconnect = std::clamp(options.reconnect, std::chrono::milliseconds(0), longest_wait);
    options.route_check = std::min(options.route_check, longest_wait);
    return options;
}

/// The request that creates the session again, with its name and kind.
v1::CreateSessionRequest as_it_is_now(Connection& connection, grpc::ClientContext& context,
                                      const std::string& session_id) {
    context.set_deadline(deadline_after<std::chrono::system_clock>(connection.timeout));
    v1::Session session;
    const grpc::Status status = get_session(connection, context, session_id, session);
    const bool late = status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
    require_ok(late ? not_answered(connection.timeout) : status, connection.address);
    v1::CreateSessionRequest create;
    create.set_id(session_id);
    *create.mutable_settings() = std::move(*session.mutable_settings());
    *create.mutable_description() = std::move(*session.mutable_description());
    create.set_ephemeral(session.ephemeral());
    create.set_stream_follows(true);
    create.set_publish(session.published());
    return create;
}

void require_valid_part(const StreamOptions& options) {
    if (options.part >= std::max(options.parts, 1U))
        throw InvalidInput("part is " + std::to_string(options.part) + " of " + std::to_string(options.parts) +
                           " parts; they are counted from 0");
    if (options.parts > 1 && options.run == 0)
        throw InvalidInput("run is 0, and parts is " + std::to_string(options.parts) +
                           ": let part 0 draw a number at random, and give it to all parts");
}

/// A server that does not know parts would take each for a whole frame.
void require_known_parts(const Connection& connection, const StreamOptions& options) {
    if (options.parts <= 1) return;
    grpc::ClientContext context;
    const CancelOnStop cancel_on_stop(context, options.stop);
    connection.add_metadata(context, {});
    context.set_deadline(deadline_after<std::chrono::system_clock>(connection.timeout));
    v1::GetServerInfoResponse info;
    require_ok(connection.server->GetServerInfo(&context, {}, &info), connection.address);
    if (options.parts > info.limits().parts_per_frame())
        throw InvalidInput("parts is " + std::to_string(options.parts) + "; the server at " + connection.address +
                           " takes frames in at most " + std::to_string(std::max(info.limits().parts_per_frame(), 1U)));
}

}  // namespace

Stream::Impl::Impl(std::shared_ptr<Connection> connection, const std::string& session_id, const StreamOptions& options,
                   Uploads uploads, std::shared_ptr<MadeSessions> made, NamedArrays named)
    : connection_(std::move(connection)),
      options_(with_bounded_waits(options)),
      made_(std::move(made)),
      session_id_(session_id),
      named_(std::move(named)) {
    require_valid_part(options_);
    require_known_parts(*connection_, options_);
    if (resumes()) {
        grpc::ClientContext context;
        const CancelOnStop cancel_on_stop(context, options_.stop);
        session_ = as_it_is_now(*connection_, context, session_id);
        created_by_ = ended_by(context);
        named_ = NamedArrays(session_.settings());
    }
    if (uploads == Uploads::bricks)
        opening_ = publish_opening(session_id, options_);
    else
        opening_ = stream_opening(
            session_id, options_,
            options_.receive_meshes ? codec_order(*connection_, options_.codec, options_.stop) : WireCodecs());
    call_ = open_call(false);
}

std::shared_ptr<Stream::Impl> Stream::Impl::open(std::shared_ptr<Connection> connection, const std::string& session_id,
                                                 const StreamOptions& options, Uploads uploads,
                                                 std::shared_ptr<MadeSessions> made, NamedArrays named) {
    auto impl =
        std::make_shared<Impl>(std::move(connection), session_id, options, uploads, std::move(made), std::move(named));
    try {
        impl->start(impl);
    } catch (...) {
        impl->leave();
        throw;
    }
    return impl;
}

void Stream::Impl::start(const std::shared_ptr<Impl>& self) {
    threads_.push_back(run(self, [this, call = call_] { receive(call); }));
    threads_.push_back(run(self, [this] { send(); }));
    if (resumes() && options_.route_check.count() > 0) threads_.push_back(run(self, [this] { check_route(); }));
    on_stop_.emplace(options_.stop, [this] { cancel(); });
}

template <class Work>
std::thread Stream::Impl::run(const std::shared_ptr<Impl>& self, Work work) {
    threads_.reserve(threads_.size() + 1);
    std::thread thread([self, work = std::move(work)] {
        work();
        const std::lock_guard lock(self->mutex_);
        --self->running_;
        self->stopped_.notify_all();
    });
    const std::lock_guard lock(mutex_);
    ++running_;
    return thread;
}

void Stream::Impl::leave() noexcept {
    on_stop_.reset();
    cancel();
    std::unique_lock lock(mutex_);
    stopped_.wait(lock, [&] { return !reporting_; });
    const bool stopped = stopped_.wait_for(lock, patience_with_threads, [&] { return running_ == 0; });
    lock.unlock();
    for (std::thread& thread : threads_)
        if (stopped)
            thread.join();
        else
            thread.detach();
    threads_.clear();
}

void Stream::Impl::cancel() {
    {
        const std::lock_guard lock(mutex_);
        left_ = true;
        if (call_) call_->cancel();
        if (creating_) creating_->TryCancel();
        if (looking_) looking_->TryCancel();
        for (const auto& context : route_calls_)
            if (context) context->TryCancel();
    }
    changed_.notify_all();
    over_.notify_all();
}

std::shared_ptr<UploadCall> Stream::Impl::open_call(bool again) const {
    return std::make_shared<UploadCall>(connection_, session_id_, opening_, again);
}

bool Stream::Impl::wait_for_room(std::uint64_t index, WhenFull when_full) {
    std::unique_lock lock(mutex_);
    if (finished_) throw InvalidInput("frame " + std::to_string(index) + " was pushed after finish()");
    // One frame is copied while the one before is sent.
    const auto has_room = [&] {
        const bool room = options_.waiting_limit == 0 || outstanding_ < options_.waiting_limit;
        return left_ || ended_ || (room && sent_ == unanswered_.size());
    };
    if (when_full == WhenFull::wait)
        changed_.wait(lock, has_room);
    else if (!has_room())
        return false;
    if (left_)
        throw ServerError("frame " + std::to_string(index) + " was pushed to a stream that was canceled",
                          ErrorCode::canceled);
    if (error_) std::rethrow_exception(error_);
    if (ended_) throw ServerError("the server at " + connection_->address + " ended the stream before its last frame");
    return true;
}

void Stream::Impl::look_for_names() {
    const auto looking = std::make_shared<grpc::ClientContext>();
    looking->set_deadline(deadline_after<std::chrono::system_clock>(connection_->timeout));
    {
        const std::lock_guard lock(mutex_);
        if (left_) return;
        looking_ = looking;
    }
    v1::Session session;
    if (get_session(*connection_, *looking, session_id_, session).ok()) named_ = NamedArrays(session.settings());
}

void Stream::Impl::enqueue(std::shared_ptr<PushedFrame> frame) {
    const std::lock_guard lock(mutex_);
    ++outstanding_;
    unanswered_.push_back(std::move(frame));
    changed_.notify_all();
}

void Stream::Impl::finish() {
    const std::lock_guard lock(mutex_);
    finished_ = true;
    changed_.notify_all();
}

Next<ReceivedFrame> Stream::Impl::next(std::optional<std::chrono::steady_clock::time_point> until) {
    std::unique_lock lock(mutex_);
    const auto has_news = [&] { return left_ || ended_ || !waiting_.empty(); };
    if (!until)
        changed_.wait(lock, has_news);
    else if (!changed_.wait_until(lock, *until, has_news))
        return {};
    if (left_) return {.ended = true};
    if (waiting_.empty()) {
        if (error_) std::rethrow_exception(error_);
        return {.ended = true};
    }
    Next<ReceivedFrame> next{.frame = std::move(waiting_.front())};
    waiting_.pop_front();
    --outstanding_;
    changed_.notify_all();
    return next;
}

std::uint64_t Stream::Impl::dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
}

bool Stream::Impl::may_send() const {
    return call_ && !draining_ && (moving_ || sent_ < unanswered_.size() || (finished_ && !half_closed_));
}

void Stream::Impl::send() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return left_ || ended_ || may_send(); });
        if (left_ || ended_) return;
        const std::shared_ptr<UploadCall> call = call_;
        if (moving_) {
            draining_ = true;
            lock.unlock();
            call->move();
            lock.lock();
            continue;
        }
        if (sent_ == unanswered_.size()) {
            half_closed_ = true;
            lock.unlock();
            call->no_more_frames();
            lock.lock();
            continue;
        }
        const std::shared_ptr<PushedFrame> frame = unanswered_[sent_++];
        changed_.notify_all();
        lock.unlock();
        const bool sent = call->send(*frame);
        if (!resumes()) {
            frame->parts.clear();
            frame->memory.reset();
        }
        lock.lock();
        // The receiving thread finds out why the call broke.
        if (!sent && call_ == call) call_.reset();
    }
}

void Stream::Impl::receive(std::shared_ptr<UploadCall> call) {
    try {
        while (call) {
            const grpc::Status status = read_answers(*call);
            if (status.ok()) {
                const std::lock_guard lock(mutex_);
                if (!unanswered_.empty())
                    throw ServerError("the server at " + connection_->address + " ended the stream before frame " +
                                      std::to_string(unanswered_.front()->index) + " was answered");
                break;
            }
            const bool was_idle = ended_for_idleness(call->context());
            if (!was_idle && !is_worth_another_call(status, *call)) require_ok(status, connection_->address);
            if (was_idle && !wait_for_use(status)) break;
            call = reopen(status);
        }
        end(nullptr);
    } catch (...) {
        end(std::current_exception());
    }
}

grpc::Status Stream::Impl::read_answers(UploadCall& call) {
    FrameReceiver receiver(options_.receive_meshes && options_.part == 0);
    try {
        std::string instance = call.accepted_by();
        if (!instance.empty() && std::exchange(connecting_, false)) report(true, *broken_at_ + options_.reconnect);
        {
            const std::lock_guard lock(mutex_);
            // Answers will not come if none are owed.
            if (!instance.empty() && unanswered_.empty()) broken_at_.reset();
            if (call_.get() == &call) instance_ = std::move(instance);
        }
        v1::StreamResponse response;
        while (call.read(response)) {
            if (response.has_draining()) {
                const std::lock_guard lock(mutex_);
                // Without another call to come it may yet be that this one takes them.
                draining_ = resumes();
            } else if (response.has_frame_dropped()) {
                take(response.frame_dropped());
            } else if (auto frame = receiver.take(response)) {
                take(std::move(*frame));
            }
        }
    } catch (...) {
        call.cancel();
        v1::StreamResponse ignored;
        while (call.read(ignored)) {
        }
        call.finish();
        throw;
    }
    grpc::Status status = call.finish();
    if (status.ok()) receiver.end_of_stream();
    return status;
}

void Stream::Impl::take(ReceivedFrame frame) {
    broken_at_.reset();
    const std::lock_guard lock(mutex_);
    if (!settle(frame.index)) return;
    frame.dropped = std::exchange(dropped_since_, {});
    frame.normals_by = options_.normals_by;
    waiting_.push_back(std::move(frame));
    changed_.notify_all();
}

void Stream::Impl::take(const v1::FrameDropped& dropped) {
    broken_at_.reset();
    const std::lock_guard lock(mutex_);
    if (!settle(dropped.frame_index())) return;
    dropped_since_.push_back({.index = dropped.frame_index(), .reason = from_wire(dropped.reason())});
    ++dropped_;
    --outstanding_;
    changed_.notify_all();
}

bool Stream::Impl::settle(std::uint64_t index) {
    if (sent_ == 0 || unanswered_.front()->index != index) {
        if (last_answered_ && index <= *last_answered_) return false;
        throw ServerError("the server at " + connection_->address + " answered frame " + std::to_string(index) +
                          ", which is not the next one that it was sent");
    }
    last_answered_ = index;
    moving_since_ = Clock::now();
    unanswered_.pop_front();
    --sent_;
    return true;
}

void Stream::Impl::end(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    error_ = std::move(error);
    changed_.notify_all();
    over_.notify_all();
}

Stream::Stream(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&& other) noexcept {
    if (this == &other) return *this;
    leave();
    impl_ = std::move(other.impl_);
    return *this;
}
Stream::~Stream() {
    leave();
}

void Stream::leave() noexcept {
    if (impl_) impl_->leave();
}

void Stream::push(const ParticleFrame& frame, std::uint64_t index, double simulation_time) {
    impl_->push(index, Impl::WhenFull::wait, !frame.arrays.empty(), [&](BytePool& pool, const NamedArrays& named) {
        return copy_frame(frame, named, index, simulation_time, pool);
    });
}

void Stream::push(const StridedPositions& positions, std::uint64_t index, double simulation_time,
                  std::span<const std::uint8_t> levels, std::span<const ParticleArray> arrays) {
    impl_->push(index, Impl::WhenFull::wait, !arrays.empty(), [&](BytePool& pool, const NamedArrays& named) {
        return copy_frame(positions, levels, arrays, named, index, simulation_time, pool);
    });
}

void Stream::push(ParticleBuffer&& buffer, std::uint64_t index, double simulation_time) {
    impl_->push(index, Impl::WhenFull::wait, ParticleBufferMemory::has_arrays(buffer),
                [&](BytePool&, const NamedArrays& named) { return take_frame(buffer, named, index, simulation_time); });
}

bool Stream::try_push(const ParticleFrame& frame, std::uint64_t index, double simulation_time) {
    return impl_->push(index, Impl::WhenFull::give_up, !frame.arrays.empty(),
                       [&](BytePool& pool, const NamedArrays& named) {
                           return copy_frame(frame, named, index, simulation_time, pool);
                       });
}

bool Stream::try_push(const StridedPositions& positions, std::uint64_t index, double simulation_time,
                      std::span<const std::uint8_t> levels, std::span<const ParticleArray> arrays) {
    return impl_->push(index, Impl::WhenFull::give_up, !arrays.empty(), [&](BytePool& pool, const NamedArrays& named) {
        return copy_frame(positions, levels, arrays, named, index, simulation_time, pool);
    });
}

bool Stream::try_push(ParticleBuffer&& buffer, std::uint64_t index, double simulation_time) {
    return impl_->push(
        index, Impl::WhenFull::give_up, ParticleBufferMemory::has_arrays(buffer),
        [&](BytePool&, const NamedArrays& named) { return take_frame(buffer, named, index, simulation_time); });
}

ParticleBuffer Stream::next_buffer(std::size_t particles, bool with_levels, const std::vector<ArrayForm>& arrays) {
    return impl_->next_buffer(particles, with_levels, arrays);
}

void Stream::finish() {
    impl_->finish();
}

std::optional<ReceivedFrame> Stream::next() {
    return impl_->next(std::nullopt).frame;
}

Next<ReceivedFrame> Stream::next(std::chrono::milliseconds timeout) {
    return impl_->next(deadline_after<std::chrono::steady_clock>(timeout));
}

void Stream::cancel() {
    impl_->cancel();
}

std::uint64_t Stream::dropped() const {
    return impl_->dropped();
}

}  // namespace meniscus::client
