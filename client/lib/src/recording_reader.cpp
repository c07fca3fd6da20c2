#include <utility>

#include "codec_order.hpp"
#include "error_mapping.hpp"
#include "recording_reader_impl.hpp"

namespace meniscus::client {

RecordingReader::Impl::Impl(std::shared_ptr<Connection> connection, const std::string& session_id, std::uint32_t number,
                            const ReadOptions& options)
    : connection_(std::move(connection)), normals_by_(options.normals_by) {
    v1::ReadRecordingRequest request;
    request.set_session_id(session_id);
    request.set_number(number);
    request.set_position(options.position);
    request.set_count(options.count);
    request.set_with_spray(options.spray);
    *request.mutable_codecs() = readable_codecs(*connection_, options.stop);
    connection_->add_metadata(context_, session_id);
    on_stop_.emplace(options.stop, [this] { cancel(); });
    reader_ = connection_->recordings->ReadRecording(&context_, request);
}

RecordingReader::Impl::~Impl() {
    on_stop_.reset();
    cancel();
    wait_.finish();
    if (ended_) return;
    v1::WatchResponse ignored;
    while (reader_->Read(&ignored)) {
    }
    reader_->Finish();
}

void RecordingReader::Impl::cancel() {
    canceled_ = true;
    context_.TryCancel();
}

std::optional<ReceivedFrame> RecordingReader::Impl::receive() {
    if (ended_) return std::nullopt;
    v1::WatchResponse response;
    while (!canceled_ && reader_->Read(&response))
        if (auto frame = receiver_.take(response)) {
            frame->normals_by = normals_by_;
            return frame;
        }
    if (canceled_) return std::nullopt;
    ended_ = true;
    require_ok(reader_->Finish(), connection_->address);
    receiver_.end_of_stream();
    return std::nullopt;
}

RecordingReader::RecordingReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RecordingReader::RecordingReader(RecordingReader&&) noexcept = default;
RecordingReader& RecordingReader::operator=(RecordingReader&&) noexcept = default;
RecordingReader::~RecordingReader() = default;

std::optional<ReceivedFrame> RecordingReader::next() {
    return impl_->next();
}

Next<ReceivedFrame> RecordingReader::next(std::chrono::milliseconds timeout) {
    return impl_->next(timeout);
}

void RecordingReader::cancel() {
    impl_->cancel();
}

}  // namespace meniscus::client
