// The frames of a session to files, while they come.
#include <algorithm>
#include <chrono>
#include <exception>
#include <future>
#include <iostream>
#include <optional>
#include <utility>

#include "cli/commands/publish_sources.hpp"
#include "cli/options/normals_by.hpp"
#include "cli/surfaces/interrupts.hpp"
#include "files/publication_pace.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/client/publication_writer.hpp"
#include "meniscus/client/session_lookup.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// How long an interrupt waits for the last segment.
constexpr std::chrono::milliseconds longest_end{500};

class LivePublisher {
public:
    LivePublisher(const PublishCommand& command, client::Watcher& watcher, client::PublicationWriter& writer)
        : command_(command), watcher_(watcher), writer_(writer) {}

    /// Until there are no more frames.
    void run() {
        while (true) {
            const bool waits = writer_.is_open();
            client::Next<client::ReceivedFrame> next;
            if (waits)
                next = watcher_.next(std::max(std::chrono::milliseconds(0), left()));
            else
                next.frame = watcher_.next();
            if (next.frame)
                take(*next.frame);
            else if (!waits || next.ended)
                return;
            if (writer_.is_open() && left().count() <= 0) writer_.flush();
        }
    }

private:
    std::chrono::milliseconds left() const {
        return std::chrono::duration_cast<std::chrono::milliseconds>(opened_at_ + files::segment_time - Clock::now());
    }

    void take(const client::ReceivedFrame& frame) {
        if (!command_.is_wanted(frame.index)) return;
        // The watcher begins with the newest frame, which a publisher before may have had.
        if (!goes_on_ && writer_.has(frame.run_id, frame.index)) return;
        goes_on_ = true;
        const Clock::time_point now = Clock::now();
        if (!writer_.is_open()) opened_at_ = now;
        const double seconds = files::shown_seconds(last_ ? std::optional(now - *last_) : std::nullopt);
        last_ = now;
        writer_.add(frame, seconds);
    }

    const PublishCommand& command_;
    client::Watcher& watcher_;
    client::PublicationWriter& writer_;
    Clock::time_point opened_at_{};
    std::optional<Clock::time_point> last_;
    bool goes_on_ = false;  ///< a frame has come that was not there
};

}  // namespace

void publish_session(const PublishCommand& command) {
    if (command.particle_radius || command.settings.any_given())
        throw InvalidInput(
            "with --server SOURCE is a session, which has its own settings: leave out those of the "
            "surface");
    check_normals_by(command.form.options.normals_by, command.form.normal_bits, false);
    client::Client client = command.server.connect();
    const std::string id = client::session_id_of(client, command.source);
    const client::SessionInfo session = client.session(id);
    client::WatchOptions request = command.form.build(session.settings);
    if (!request.codec) request.codec = Codec::lattice_entropy;
    request.spray = true;

    client::PublishOptions options = publish_options(command, session.description);
    options.live = true;
    client::PublicationWriter writer(command.folder, session.settings, options);
    client::Watcher watcher = client.watch(id, request);
    std::promise<void> done;
    const std::shared_future<void> is_done = done.get_future().share();
    const Interrupts interrupts([&watcher, is_done] {
        watcher.cancel();
        (void)is_done.wait_for(longest_end);
    });
    if (!command.verbosity.quiet) std::cerr << command.folder.string() << ": publishing " << id << '\n';
    try {
        LivePublisher(command, watcher, writer).run();
        writer.finish();
    } catch (...) {
        // The frames that have come are there for a run that goes on.
        try {
            writer.flush();
        } catch (const std::exception&) {
            // The first error is the one to report.
        }
        done.set_value();
        throw;
    }
    done.set_value();
    if (command.verbosity.quiet) return;
    const client::PublicationInfo& info = writer.info();
    std::cerr << command.folder.string() << ": " << info.frames << " frames in " << info.segments.size()
              << " segments of " << info.bytes << " bytes\n";
}

}  // namespace meniscus::cli
