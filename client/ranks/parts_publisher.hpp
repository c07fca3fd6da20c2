// A rank's publisher of the parts that it makes: it pauses where publishing has failed, longer each time.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "meniscus/live_parts.hpp"

namespace meniscus::ranks {

/// Which of the makers a publisher is of, and what they share.
struct MakerPlace {
    std::size_t number = 0;  ///< from 0
    std::size_t makers = 1;
    std::uint64_t run = 1;   ///< names the job's frames
    std::string session_id;  ///< that the first maker has opened; empty for the first itself
};

class PartsPublisher : public LivePublisher {
public:
    /// Returns the session's id, empty where there is no session. Throws what hinders it.
    virtual std::string open(const MakerPlace& place) = 0;
    /// Waits until what was published, and confirmed, is where it goes.
    virtual void finish() = 0;

    void publish(const LivePart& part) final {
        show(part);
        pause_ = first_pause;
    }
    void abandon() noexcept final;
    bool is_away() const noexcept final { return Clock::now() < next_attempt_; }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds first_pause{1};

    virtual void show(const LivePart& part) = 0;
    /// Of the frame that was shown last some part is missing, and a pause begins.
    virtual void leave() noexcept = 0;

    std::chrono::seconds pause_ = first_pause;
    Clock::time_point next_attempt_{};
};

}  // namespace meniscus::ranks
