#include "recording/recording_writer.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <iterator>
#include <map>
#include <system_error>
#include <utility>

#include "meniscus/error.hpp"
#include "process/log.hpp"
#include "process/open_work.hpp"
#include "recording/delete_recording.hpp"

namespace meniscus::server {

namespace {

void make_directory(const RecordingOptions& options) {
    require_recordable(options);
    if (::mkdir(options.directory.c_str(), S_IRWXU) != 0 && errno != EEXIST)
        throw InvalidInput(fmt::format("--record {}: cannot be created: {}", options.directory.string(),
                                       std::generic_category().message(errno)));
}

/// The cost of an entry beside its bytes: the memory of its objects, and the time for a file that it may begin.
constexpr std::size_t entry_bytes = std::size_t{16} << 10;

/// The name whose room in the queue the session's frames take.
const std::string& name_of(const RecordedSession& session) {
    return session.owner.empty() ? session.id : session.owner;
}

}  // namespace

RecordingWriter::RecordingWriter(const RecordingOptions& options)
    : options_(options), recorded_(options.directory), queue_(options.waiting_limit) {
    make_directory(options_);
    lock_.emplace(options_.directory);
    thread_ = std::thread([this] { write_jobs(); });
}

RecordingWriter::~RecordingWriter() {
    const OpenWork::Entry working(open_work(), "the writing of recordings");
    queue_.close();
    leave_out_what_waits();
    thread_.join();
    while (auto job = queue_.take()) perform(*job);  // runs that have ended with what was left out
}

bool RecordingWriter::reserve(const RecordedSession& session, std::size_t bytes) {
    const bool room = queue_.reserve(name_of(session), entry_bytes + bytes);
    if (!room) ++left_out_;
    return room;
}

void RecordingWriter::cancel(const RecordedSession& session, std::size_t bytes) {
    ++left_out_;
    queue_.cancel(name_of(session), entry_bytes + bytes);
}

void RecordingWriter::write(std::shared_ptr<RecordedRun> run, std::uint64_t frame_index, Frame frame,
                            std::size_t reserved) {
    std::string name = name_of(*run->session);
    queue_.put({.run = std::move(run), .frame_index = frame_index, .frame = std::move(frame)}, std::move(name),
               entry_bytes + reserved);
}

std::shared_ptr<RecordedRun> RecordingWriter::begin_run(std::shared_ptr<RecordedSession> session,
                                                        std::int64_t started_at) {
    return {new RecordedRun{.session = std::move(session), .started_at = started_at},
            [this](RecordedRun* run) { end(std::unique_ptr<RecordedRun>(run)); }};
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
    if (job.ended) return close(*job.ended);
    RecordedSession& session = *job.run->session;
    if (session.stopped) return;
    try {
        if (const auto* mesh = std::get_if<std::shared_ptr<const EncodedFrame>>(&job.frame)) {
            append(*job.run, recorded_mesh(**mesh));
            ++job.run->meshes;
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

void RecordingWriter::leave_out_what_waits() {
    std::map<std::string, std::uint64_t> left;  // by session
    queue_.finish(finish_by_, [&](const Job& job) {
        if (job.ended) return close(*job.ended);
        if (!job.run->session->stopped) ++left[job.run->session->id];
    });
    if (left.empty()) return;
    std::uint64_t all = 0;
    std::string sessions;
    constexpr std::size_t named = 16;
    for (auto session = left.begin(); session != left.end(); ++session) {
        all += session->second;
        const auto before = static_cast<std::size_t>(std::distance(left.begin(), session));
        if (before < named) sessions += (before == 0 ? "" : ", ") + session->first;
    }
    left_out_ += all;
    log_warning({},
                "the server's end came before the disk: {} particles or meshes of frames are left out at the ends of "
                "the recordings of {} sessions: {}{}",
                all, left.size(), sessions, left.size() > named ? ", ..." : "");
}

void RecordingWriter::append(RecordedRun& run, const RecordingBytes& bytes) {
    if (!run.file) {
        const RecordedSession& session = *run.session;
        const std::string begin =
            recording_begin(session.id, session.settings, run.started_at, session.owner, session.description);
        admit(begin.size() + bytes.size());
        run.file.emplace(options_.directory, session.id);
        run.file->append(begin);
        count(run, begin.size());
        if (const auto kept_back = lines_.pass())
            log_info({.session = session.id}, "recorded in {}{}", run.file->path().string(), left_out(*kept_back));
    }
    admit(bytes.size());
    run.file->append(bytes.entry);
    run.file->append(bytes.messages);
    count(run, bytes.size());
}

void RecordingWriter::count(RecordedRun& run, std::uint64_t written) {
    run.bytes += written;
    bytes_ += written;
    if (options_.limit != 0) recorded_.add(written);
}

void RecordingWriter::end(std::unique_ptr<RecordedRun> run) noexcept {
    if (!run->file) return;
    try {
        std::string name = name_of(*run->session);
        queue_.put({.ended = std::move(run)}, std::move(name), 0);
    } catch (const std::exception&) {
        // For want of memory. Its file is closed here; the next look into the folder finds out if it is too short.
    }
}

void RecordingWriter::close(const RecordedRun& run) const noexcept {
    const std::uint64_t least = options_.retention.min_frames;
    if (!run.file || run.meshes >= least) return;
    try {
        delete_recording(run.file->path(), {.session_id = run.session->id, .number = run.file->number()}, run.meshes,
                         run.bytes, fewer_frames_than(least));
    } catch (const std::exception& error) {
        log_error({.session = run.session->id}, "{}", error.what());
    }
}

void RecordingWriter::admit(std::uint64_t bytes) {
    if (options_.limit == 0) return;
    const auto fits = [&](std::uint64_t used) { return used <= options_.limit && bytes <= options_.limit - used; };
    if (fits(recorded_.sum()) || fits(recorded_.newest_sum())) return;
    throw LimitExceeded(
        fmt::format("{} bytes of recordings are in {}, {} more would pass --record-limit {}: delete some, or raise it",
                    recorded_.sum(), options_.directory.string(), bytes, options_.limit));
}

}  // namespace meniscus::server
