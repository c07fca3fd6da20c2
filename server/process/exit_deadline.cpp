#include "process/exit_deadline.hpp"

#include <spdlog/spdlog.h>

#include <cstdlib>
#include <string>

#include "meniscus/seconds.hpp"
#include "process/open_work.hpp"

namespace meniscus::server {

ExitDeadline::~ExitDeadline() {
    if (!watching_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        is_met_ = true;
    }
    met_.notify_one();
    watching_.join();
}

void ExitDeadline::start(std::chrono::milliseconds time) {
    const auto deadline = std::chrono::steady_clock::now() + time;
    watching_ = std::thread([this, deadline, time] {
        std::unique_lock lock(mutex_);
        if (met_.wait_until(lock, deadline, [this] { return is_met_; })) return;
        const std::string unfinished = open_work().text();
        spdlog::warn("stopped at the end of the {:.3g} s of grace: {} left unfinished", seconds_of(time),
                     unfinished.empty() ? "the release of its memory was" : unfinished + " was");
        // Nobody is owed anything any more, and threads that still work use what an orderly exit would destroy.
        std::_Exit(EXIT_SUCCESS);
    });
}

}  // namespace meniscus::server
