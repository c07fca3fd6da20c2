// One of the streams that send parts of frames, as a session sees it, played by a test.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/intake/frame_assembler.hpp"
#include "sessions/session/joint_upload.hpp"
#include "sessions/session/session.hpp"

namespace meniscus::server::test {

/// A frame as its parts send it: particle i of part p has the position (index, p, i).
struct SentFrame {
    std::uint64_t index = 0;
    std::size_t particles = 0;

    v1::FrameBegin begin() const {
        v1::FrameBegin message;
        message.set_frame_index(index);
        message.set_particle_count(particles);
        *message.mutable_arrays() = conversion::particle_arrays(false, false);
        return message;
    }
    std::string bytes(std::uint32_t part) const {
        std::string all;
        for (std::size_t i = 0; i < particles; ++i)
            for (const float number : {static_cast<float>(index), static_cast<float>(part), static_cast<float>(i)})
                all.append(reinterpret_cast<const char*>(&number), sizeof number);
        return all;
    }
};

/// Plays one connection of one part, in the thread that calls play(): sends frames in chunks of random sizes, and takes
/// the answers.
class PartPlayer final : public PartStream, public std::enable_shared_from_this<PartPlayer> {
public:
    enum class Outcome { ended, broken };

    PartPlayer(const Limits& limits, std::uint32_t part, std::vector<SentFrame> frames, unsigned seed)
        : part_(part), frames_(std::move(frames)), random_(seed), assembler_(limits) {}

    void wake() override { put(Event::answers); }
    void read_next() override { put(Event::read); }
    void begun(std::optional<std::vector<FramePiece>> pieces) override {
        {
            const std::lock_guard lock(mutex_);
            pieces_ = std::move(pieces);
        }
        put(Event::begun);
    }
    void stop_reading() override {}

    /// Throws as JointUpload::open().
    void open(const std::shared_ptr<Session>& session, const UploadOptions& options) {
        joint_ = JointUpload::open(session, options, part_, weak_from_this());
        joint_->ready(part_);
    }
    /// Until the stream ends, or, if it stays, all its frames are answered; or before one of its events, of which one
    /// in `breaks` breaks the connection; 0: none.
    Outcome play(unsigned breaks) {
        take_answers();
        while (!ended_) {
            if (stays && answers.size() == frames_.size()) return Outcome::broken;
            const Event event = next();
            if (breaks != 0 && random_() % breaks == 0) return Outcome::broken;
            if (event == Event::answers) {
                take_answers();
            } else if (joint_->enter()) {
                try {
                    work(event);
                } catch (...) {
                    joint_->fail(part_, std::current_exception());
                }
                joint_->leave();
            }
        }
        return Outcome::ended;
    }
    const Upload& upload() const { return *joint_->upload(); }
    /// The connection is over, and the server knows.
    void done(UploadEnd end) {
        joint_->finished();
        joint_->done(part_, end);
    }

    /// Of frames, in order: "7", or "-7" for one that is told to be incomplete.
    std::vector<std::string> answers;
    std::exception_ptr error;
    bool stays = false;  ///< open, once all frames are sent

private:
    enum class Event { answers, read, begun, go_on };

    void put(Event event) {
        {
            const std::lock_guard lock(mutex_);
            events_.push_back(event);
        }
        changed_.notify_one();
    }
    Event next() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !events_.empty(); });
        const Event event = events_.front();
        events_.pop_front();
        return event;
    }

    void work(Event event) {
        switch (event) {
            case Event::answers:
                return;
            case Event::read:
                if (sent_ == frames_.size()) return stays ? void() : joint_->close(part_);
                announced_ = assembler_.announce(frames_[sent_].begin());
                left_ = frames_[sent_].bytes(part_);
                return joint_->begin(part_, announced_);
            case Event::begun: {
                const std::lock_guard lock(mutex_);
                passes_over_ = !pieces_;
                if (passes_over_)
                    assembler_.pass_over(announced_);
                else
                    assembler_.place(announced_, *std::move(pieces_));
                break;
            }
            case Event::go_on:
                if (left_.empty()) {
                    assembler_.end();
                    ++sent_;
                    return joint_->end(part_);
                }
                v1::FrameChunk chunk;
                chunk.set_data(left_.substr(0, 1 + random_() % 40));
                left_.erase(0, chunk.data().size());
                assembler_.append(chunk, joint_->input());
        }
        if (passes_over_ ||
            joint_->book(assembler_.take_kept(), [self = shared_from_this()] { self->put(Event::go_on); }))
            put(Event::go_on);
    }

    void take_answers() {
        for (;;) {
            const auto next = joint_->upload()->output.take(part_);
            if (const auto* message = std::get_if<SharedMessage>(&next)) {
                v1::StreamResponse response;
                response.ParseFromString(**message);
                if (response.has_frame_statistics())
                    answers.push_back(std::to_string(response.frame_statistics().frame_index()));
                if (response.has_frame_dropped())
                    answers.push_back("-" + std::to_string(response.frame_dropped().frame_index()));
                continue;
            }
            if (const auto* end = std::get_if<OutputQueue::End>(&next)) {
                error = end->error;
                ended_ = true;
            }
            return;
        }
    }

    const std::uint32_t part_;
    const std::vector<SentFrame> frames_;
    std::mt19937 random_;
    FrameAssembler assembler_;
    FramePart announced_;
    std::string left_;  ///< of the frame's bytes
    std::size_t sent_ = 0;
    bool passes_over_ = false;
    bool ended_ = false;
    std::shared_ptr<JointUpload> joint_;

    std::mutex mutex_;  ///< for what follows
    std::condition_variable changed_;
    std::deque<Event> events_;
    std::optional<std::vector<FramePiece>> pieces_;
};

}  // namespace meniscus::server::test
