#include <algorithm>
#include <utility>

#include "conversion/settings_conversion.hpp"
#include "error_mapping.hpp"
#include "meniscus/error.hpp"
#include "stream_impl.hpp"

namespace meniscus::client {

namespace {

/// The largest that the server takes.
constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

}  // namespace

Stream::Impl::Impl(std::shared_ptr<Connection> connection, const std::string& session_id, const StreamOptions& options)
    : connection_(std::move(connection)), options_(options) {
    connection_->add_metadata(context_, session_id);
    call_ = connection_->surfaces->Stream(&context_);
    v1::StreamRequest request;
    v1::StreamOpen& open = *request.mutable_open();
    open.set_session_id(session_id);
    open.set_receive_meshes(options.receive_meshes);
    open.set_normal_bits(static_cast<std::uint32_t>(options.normal_bits));
    // A refusal arrives as the call's status, which the reader gets.
    call_->Write(request);
    reader_ = std::thread([this] { read(); });
}

Stream::Impl::~Impl() {
    {
        const std::lock_guard lock(mutex_);
        if (!ended_) context_.TryCancel();
    }
    reader_.join();
}

void Stream::Impl::read() {
    FrameReceiver receiver(options_.receive_meshes);
    std::exception_ptr error;
    try {
        v1::StreamResponse response;
        while (call_->Read(&response)) {
            auto frame = receiver.take(response);
            if (!frame) continue;
            const std::lock_guard lock(mutex_);
            waiting_.push_back(std::move(*frame));
            changed_.notify_all();
        }
    } catch (...) {
        error = std::current_exception();
        context_.TryCancel();
        v1::StreamResponse ignored;
        while (call_->Read(&ignored)) {
        }
    }
    const grpc::Status status = call_->Finish();
    if (!error) {
        try {
            require_ok(status, connection_->address);
            receiver.end_of_stream();
        } catch (...) {
            error = std::current_exception();
        }
    }
    const std::lock_guard lock(mutex_);
    ended_ = true;
    error_ = error;
    changed_.notify_all();
}

void Stream::Impl::wait_for_room() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] {
        return ended_ || options_.waiting_limit == 0 || outstanding_ < options_.waiting_limit;
    });
    if (ended_ && error_) std::rethrow_exception(error_);
    ++outstanding_;
}

void Stream::Impl::send(const v1::StreamRequest& request) {
    if (call_->Write(request)) return;
    // The call has ended: its status says why.
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ended_; });
    if (error_) std::rethrow_exception(error_);
    throw ServerError("the server at " + connection_->address + " ended the stream before its last frame");
}

void Stream::Impl::send_chunks(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const auto chunk = bytes.first(std::min(bytes.size(), chunk_bytes));
        chunk_.mutable_frame_chunk()->mutable_data()->assign(reinterpret_cast<const char*>(chunk.data()), chunk.size());
        send(chunk_);
        bytes = bytes.subspan(chunk.size());
    }
}

void Stream::Impl::push(const ParticleFrame& frame, std::uint64_t index, double simulation_time) {
    if (finished_) throw InvalidInput("frame " + std::to_string(index) + " was pushed after finish()");
    wait_for_room();
    v1::StreamRequest request;
    v1::FrameBegin& begin = *request.mutable_frame_begin();
    begin.set_frame_index(index);
    begin.set_simulation_time(simulation_time);
    begin.set_particle_count(frame.count());
    begin.set_has_levels(!frame.levels.empty());
    if (frame.is_quantized()) {
        begin.set_encoding(v1::POSITION_ENCODING_UINT16);
        *begin.mutable_quantization_box() = conversion::to_wire(frame.quantization_box);
    } else {
        begin.set_encoding(v1::POSITION_ENCODING_FLOAT32);
    }
    send(request);
    send_chunks(std::as_bytes(frame.positions));
    send_chunks(std::as_bytes(frame.quantized));
    send_chunks(std::as_bytes(frame.levels));
    request.mutable_frame_end();
    send(request);
}

void Stream::Impl::finish() {
    if (std::exchange(finished_, true)) return;
    call_->WritesDone();
}

std::optional<ReceivedFrame> Stream::Impl::next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ended_ || !waiting_.empty(); });
    if (waiting_.empty()) {
        if (error_) std::rethrow_exception(error_);
        return std::nullopt;
    }
    std::optional<ReceivedFrame> frame(std::move(waiting_.front()));
    waiting_.pop_front();
    --outstanding_;
    changed_.notify_all();
    return frame;
}

Stream::Stream(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&&) noexcept = default;
Stream::~Stream() = default;

void Stream::push(const ParticleFrame& frame, std::uint64_t index, double simulation_time) {
    impl_->push(frame, index, simulation_time);
}

void Stream::finish() {
    impl_->finish();
}

std::optional<ReceivedFrame> Stream::next() {
    return impl_->next();
}

}  // namespace meniscus::client
