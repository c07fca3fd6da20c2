// A rank's publisher of the parts that it makes.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "meniscus/live_parts.hpp"
#include "ranks/brick_upload.hpp"
#include "ranks/parts_options.hpp"

namespace meniscus::ranks {

class PartsPublisher final : public LivePublisher {
public:
    explicit PartsPublisher(const PartsArguments& arguments);

    /// part: the number of this publisher, from 0. parts: the number of publishers. run: names the job's frames.
    /// session_id: empty for that of the options, or a new one. Throws as open_brick_upload().
    void open(std::size_t part, std::size_t parts, std::uint64_t run, const std::string& session_id);
    const std::string& session_id() const { return session_id_; }
    /// Waits until all is answered.
    void finish();

    /// Opens the session again, if it is not open.
    void publish(const LivePart& part) override;
    void abandon() noexcept override;
    bool is_away() const noexcept override { return Clock::now() < next_attempt_; }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds first_pause{1}, longest_pause{30};

    void open();
    client::ReceivedFrame encoded(const LivePart& part) const;

    std::string server_;
    text_options::Options connection_, session_;
    CodingOptions coding_;
    std::vector<AttributeWish> wishes_;
    Mesh empty_;  ///< of a rank that has no part of a frame
    Statistics of_empty_;
    std::string session_id_;
    std::uint64_t run_ = 0;
    std::unique_ptr<BrickUpload> upload_;
    std::chrono::seconds pause_ = first_pause;
    Clock::time_point next_attempt_{};
};

}  // namespace meniscus::ranks
