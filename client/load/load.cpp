#include "load/load.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <list>

#include "load/frames.hpp"
#include "load/simulator.hpp"
#include "load/stalled_watcher.hpp"
#include "load/watcher.hpp"

namespace meniscus::load {

namespace {

/// The time for all threads to begin before the first frame is due.
constexpr auto head_start = std::chrono::milliseconds(200);

/// A session with its clients, each on a connection of its own.
class Party {
public:
    explicit Party(const LoadOptions& options)
        : options_(options), connection_(options.server.connection()), client_(options.server.address, connection_) {
        client_.create_session(session_, options.settings.build(options.particle_radius));
        for (unsigned i = 0; i < options.stalled; ++i)
            stalled_.emplace_back(options.server.address, connection_, session_);
        for (unsigned i = 0; i < options.watchers + options.slow; ++i) {
            watching_.emplace_back(options.server.address, connection_);
            watchers_.push_back(watching_.back().watch(session_));
        }
    }

    void start(const Frames& frames, const Schedule& schedule) {
        uploads_ = std::async(std::launch::async, [this, &frames, &schedule] {
            return simulate(client_, session_, options_.stream, frames, schedule);
        });
        for (std::size_t i = 0; i < watchers_.size(); ++i) {
            const double pause = i < options_.watchers ? 0.0 : options_.slow_seconds;
            outcomes_.push_back(std::async(std::launch::async, [this, &watcher = watchers_[i], &schedule, pause] {
                return watch(watcher, schedule, pause, over_);
            }));
        }
        for (unsigned i = 0; i < options_.vanishing; ++i)
            vanishing_.push_back(std::async(std::launch::async, [this, &schedule] {
                return watch_and_vanish(options_.server.address, connection_, session_, schedule, options_.vanish_after,
                                        over_);
            }));
    }

    /// Waits for the simulator, ends the session, which ends its watchers, and adds what all have seen.
    void finish(LoadResult& result) {
        result.uploads.add(uploads_.get());
        over_ = true;
        try {
            client_.delete_session(session_);
        } catch (...) {
            // Then the server is gone, and the watchers end with it.
            count_error(result.uploads.errors, std::current_exception());
        }
        for (std::size_t i = 0; i < outcomes_.size(); ++i)
            (i < options_.watchers ? result.watchers : result.slow).add(outcomes_[i].get());
        for (auto& outcome : vanishing_) result.vanishing.add(outcome.get());
    }

private:
    const LoadOptions& options_;
    const client::ConnectionOptions connection_;
    const std::string session_ = client::new_session_id();
    client::Client client_;
    std::list<client::Client> watching_;
    std::vector<client::Watcher> watchers_;
    std::list<StalledWatcher> stalled_;
    std::atomic<bool> over_{false};
    std::future<UploadOutcome> uploads_;
    std::vector<std::future<WatchOutcome>> outcomes_;
    std::vector<std::future<WatchOutcome>> vanishing_;
};

}  // namespace

LoadResult run_load(const LoadOptions& options) {
    const Frames frames = options.files.empty() ? Frames::moving_water(options.particles, options.particle_radius)
                                                : Frames::read(options.files);
    LoadResult result;
    result.server = options.server.connect().server_info();
    std::list<Party> parties;
    for (unsigned i = 0; i < options.simulators; ++i) parties.emplace_back(options);
    result.schedule = {.start = Clock::now() + head_start,
                       .frames_per_second = options.rate,
                       .frames = static_cast<std::uint64_t>(std::ceil(options.seconds * options.rate)),
                       .warm_up_frames = static_cast<std::uint64_t>(std::ceil(options.warm_up * options.rate))};
    // Simulators take turns within a frame's time, as those that know nothing of each other do in the mean.
    std::list<Schedule> schedules;
    const std::chrono::duration<double> step(1.0 / (options.rate * options.simulators));
    for (Party& party : parties) {
        Schedule& schedule = schedules.emplace_back(result.schedule);
        schedule.start += std::chrono::duration_cast<Clock::duration>(step * static_cast<double>(schedules.size() - 1));
        party.start(frames, schedule);
    }
    for (Party& party : parties) party.finish(result);
    result.seconds = std::max(0.0, seconds_between(result.schedule.start, result.uploads.last_answer));
    return result;
}

}  // namespace meniscus::load
