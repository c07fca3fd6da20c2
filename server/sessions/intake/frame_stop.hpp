// Ends the frame that a session is reconstructing, early.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>

#include "meniscus/stop_flag.hpp"
#include "sessions/handover/timer.hpp"
#include "sessions/intake/upload.hpp"

namespace meniscus::server {

/// One of each session. Its thread begins and ends frames; others cancel them.
class FrameStop {
public:
    enum class Reason : std::uint8_t {
        none,
        canceled,  ///< nobody reads its stream any more
        closed,    ///< the session ends
        too_long,  ///< on the device
    };

    /// flag: none where nothing can be stopped. longest: 0 for no limit.
    FrameStop(std::shared_ptr<StopFlag> flag, std::shared_ptr<Timer> deadlines, std::chrono::milliseconds longest)
        : flag_(std::move(flag)), deadlines_(std::move(deadlines)), longest_(longest) {}

    /// A frame, or meshes of the last one, while they have the device: their time runs.
    class UnderWay {
    public:
        /// upload: of the frame, or none.
        UnderWay(FrameStop& stop, const Upload* upload) : stop_(stop) { stop_.begin(upload); }
        ~UnderWay() { stop_.end(); }
        UnderWay(const UnderWay&) = delete;
        UnderWay& operator=(const UnderWay&) = delete;

    private:
        FrameStop& stop_;
    };

    /// Stops the upload's frame if it is under way, or as it begins.
    void cancel(Upload& upload);
    /// Stops what is under way, and all that begins later.
    void close();
    /// Why the last frame was stopped.
    Reason reason() const;

private:
    void begin(const Upload* upload);
    void end();
    /// With the lock held.
    void stop(Reason reason);

    const std::shared_ptr<StopFlag> flag_;
    const std::shared_ptr<Timer> deadlines_;
    const std::chrono::milliseconds longest_;

    mutable std::mutex mutex_;  ///< for what follows
    const Upload* upload_ = nullptr;
    bool closed_ = false;
    bool under_way_ = false;
    Reason reason_ = Reason::none;

    std::uint64_t deadline_ = 0;  ///< the session's thread alone
};

}  // namespace meniscus::server
