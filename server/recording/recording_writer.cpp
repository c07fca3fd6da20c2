#include "recording/recording_writer.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <system_error>
#include <utility>

#include "files/recording_format.hpp"
#include "log.hpp"
#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

void make_directory(const RecordingOptions& options) {
    require_recordable(options);
    if (::mkdir(options.directory.c_str(), S_IRWXU) != 0 && errno != EEXIST)
        throw InvalidInput(fmt::format("--record {}: cannot be created: {}", options.directory.string(),
                                       std::generic_category().message(errno)));
}

std::uint64_t bytes_of_recordings(const std::filesystem::path& directory) {
    constexpr auto options = std::filesystem::directory_options::skip_permission_denied;
    std::uint64_t bytes = 0;
    std::error_code error;
    for (auto i = std::filesystem::recursive_directory_iterator(directory, options, error);
         i != std::filesystem::recursive_directory_iterator(); i.increment(error)) {
        if (i->path().extension() != files::recording_extension) continue;
        const std::uintmax_t size = i->file_size(error);
        if (!error) bytes += size;
    }
    return bytes;
}

}  // namespace

RecordingWriter::RecordingWriter(const RecordingOptions& options) : options_(options), queue_(options.waiting_limit) {
    make_directory(options_);
    lock_.emplace(options_.directory);
    thread_ = std::thread([this] { write_jobs(); });
}

RecordingWriter::~RecordingWriter() {
    queue_.close();
    thread_.join();
}

bool RecordingWriter::reserve(std::size_t bytes) {
    const bool room = queue_.reserve(bytes);
    if (!room) ++left_out_;
    return room;
}

void RecordingWriter::cancel(std::size_t bytes) {
    ++left_out_;
    queue_.cancel(bytes);
}

void RecordingWriter::write(std::shared_ptr<RecordedRun> run, std::uint64_t frame_index, Frame frame,
                            std::size_t reserved) {
    queue_.put({.run = std::move(run), .frame_index = frame_index, .frame = std::move(frame)}, reserved);
}

RecordingCounters RecordingWriter::counters() const noexcept {
    return {.frames = frames_, .bytes = bytes_, .frames_left_out = left_out_, .stopped = stopped_};
}

std::int64_t RecordingWriter::wall_clock(std::chrono::steady_clock::time_point time) const {
    using std::chrono::duration_cast;
    using std::chrono::microseconds;
    return (duration_cast<microseconds>(wall_start_.time_since_epoch()) +
            duration_cast<microseconds>(time - steady_start_))
        .count();
}

void RecordingWriter::write_jobs() {
    // A file beyond the process's limit (ulimit -f) is an error to report, not the end of the server.
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGXFSZ);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    while (auto job = queue_.take()) perform(*job);
}

void RecordingWriter::perform(Job& job) {
    RecordedSession& session = *job.run->session;
    if (session.stopped) return;
    try {
        if (const auto* mesh = std::get_if<std::shared_ptr<const EncodedFrame>>(&job.frame)) {
            append(*job.run, recorded_mesh(**mesh));
        } else {
            append(*job.run, std::get<RecordingBytes>(job.frame));
            ++frames_;
        }
    } catch (const std::exception& error) {
        session.stopped = true;
        ++stopped_;
        log_error({.session = session.id, .frame = job.frame_index},
                  "its recording stops here, the session goes on: {}", error.what());
    }
}

void RecordingWriter::append(RecordedRun& run, const RecordingBytes& bytes) {
    if (!run.file) {
        const RecordedSession& session = *run.session;
        const std::string begin = recording_begin(session.id, session.settings, run.started_at, session.owner);
        // Counted again with every file, so that room made by deleting recordings is found.
        if (options_.limit != 0) used_ = bytes_of_recordings(options_.directory);
        admit(begin.size() + bytes.size());
        run.file.emplace(options_.directory, session.id);
        run.file->append(begin);
        used_ += begin.size();
        bytes_ += begin.size();
        log_info({.session = session.id}, "recorded in {}", run.file->path().string());
    }
    admit(bytes.size());
    run.file->append(bytes.entry);
    run.file->append(bytes.messages);
    used_ += bytes.size();
    bytes_ += bytes.size();
}

void RecordingWriter::admit(std::uint64_t bytes) {
    if (options_.limit == 0 || (used_ <= options_.limit && bytes <= options_.limit - used_)) return;
    throw LimitExceeded(
        fmt::format("{} bytes of recordings are in {}, {} more would pass --record-limit {}: delete some, or raise it",
                    used_, options_.directory.string(), bytes, options_.limit));
}

}  // namespace meniscus::server
