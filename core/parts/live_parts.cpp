// Frames one after the other, while the simulation goes on: one is prepared while that before it is made.
#include "meniscus/live_parts.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/frame_order.hpp"
#include "parts/agreement.hpp"
#include "parts/presence.hpp"
#include "parts/worker.hpp"

namespace meniscus {
class LiveParts::Impl {
public:
    Impl(const Settings& settings, const BackendOptions& backend, const PartsOptions& options, LivePolicy policy,
         PartExchange& exchange, LivePublisher& publisher)
        : policy_(policy),
          publisher_(publisher),
          is_maker_(options.makers.empty() ||
                    std::find(options.makers.begin(), options.makers.end(), exchange.rank()) != options.makers.end()),
          parts_(settings, backend, options, exchange),
          agreement_(exchange) {}

    bool push(const FrameGiver& given, std::uint64_t index, double simulation_time) {
        const bool are_free = come_together({.index = index, .simulation_time = simulation_time},
                                            [&] { require_frame_order(last_index_, index, simulation_time); });
        last_index_ = index;
        if (!are_free || !settle(policy_ == LivePolicy::every_frame)) {
            ++dropped_;
            return false;
        }
        take(given, {index, simulation_time});
        return true;
    }

    void finish() {
        std::string failed;
        std::exception_ptr error;
        come_to_rest(failed);
        // The frame that is being made, then the one that was taken after it.
        while (begun_ || taken_) {
            try {
                settle(true);
                bring();
            } catch (...) {
                if (!error) error = std::current_exception();
            }
            work();
            come_to_rest(failed);
        }
        if (error) std::rethrow_exception(error);
        if (!failed.empty()) throw PublishingFailed(failed);
    }

    std::uint64_t next_index() const { return last_index_ ? *last_index_ + 1 : 0; }
    std::uint64_t dropped() const { return dropped_; }

private:
    struct Frame {
        std::uint64_t index = 0;
        double simulation_time = 0.0;
    };
    /// The part that a maker has made last.
    struct MadeMesh {
        std::size_t part = 0;
        Mesh mesh;
        Statistics statistics;
    };

    /// Whether all processes are free for a frame. check: of this one. An error of one is thrown by all.
    template <class Check>
    bool come_together(Presence mine, const Check& check) {
        if (policy_ == LivePolicy::every_frame) worker_.wait();
        std::vector<Presence> all;
        for (const PartExchange::Bytes& bytes : agreement_.gather([&] {
                 check();
                 all.reserve(agreement_.ranks());
                 mine.is_at_work = !worker_.is_idle();
                 if (!mine.is_at_work) mine.failure = failure_;
                 mine.is_away = !mine.is_at_work && is_maker_ && !mine.ends && publisher_.is_away();
                 return packed(mine);
             }))
            all.push_back(unpacked_presence(bytes));
        require_one_frame(all);
        const auto is_one = [&all](bool Presence::*member) {
            return std::any_of(all.begin(), all.end(), [member](const Presence& its) { return its.*member; });
        };
        // A failure is told once no process is at work: all can then close their uploads.
        if (is_one(&Presence::is_at_work)) return false;
        const auto failed =
            std::find_if(all.begin(), all.end(), [](const Presence& its) { return !its.failure.empty(); });
        if (failed != all.end()) fail("rank " + std::to_string(failed - all.begin()) + ": " + failed->failure);
        if (is_maker_) publisher_.confirm();
        return !is_one(&Presence::is_away);
    }

    /// Waits until no process is at work. failed: gets the error of a frame that was not published: the next one still
    /// may be.
    void come_to_rest(std::string& failed) {
        for (bool is_at_rest = false; !is_at_rest;) {
            worker_.wait();
            try {
                is_at_rest = come_together({.ends = true}, [] {});
            } catch (const PublishingFailed& failure) {
                failed.append(failed.empty() ? "" : "; ").append(failure.what());
            }
        }
    }

    [[noreturn]] void fail(const std::string& what) {
        failure_.clear();
        if (is_maker_) worker_.start([this] { publisher_.abandon(); });
        throw PublishingFailed(what);
    }

    /// Whether the frame that is being made, if there is one, has equal seams. waits: until it has; else its parts are
    /// made again meanwhile.
    bool settle(bool waits) {
        if (!begun_) return true;
        try {
            while (parts_.go_on()) {
                making_ = Making::again;
                work();
                if (!waits) return false;
                worker_.wait();
            }
        } catch (...) {
            begun_.reset();
            throw;
        }
        settled_ = std::exchange(begun_, std::nullopt);
        return true;
    }

    /// The frame that was taken, if there is one, is to be made now.
    void bring() {
        const std::optional<Frame> frame = std::exchange(taken_, std::nullopt);
        if (!frame) return;
        parts_.bring();
        begun_ = frame;
        making_ = Making::anew;
    }

    void take(const FrameGiver& given, const Frame& frame) {
        try {
            bring();
            parts_.begin(given);
            taken_ = frame;
            is_to_prepare_ = policy_ == LivePolicy::latest;
            if (!is_to_prepare_) {
                // Where the simulation waits for surfaces, they come the sooner.
                parts_.prepare();
                bring();
            }
        } catch (...) {
            work();
            throw;
        }
        work();
    }

    enum class Making { nothing, again, anew };

    /// Publishes the frame that has settled, if there is one; makes, then prepares what is to be.
    void work() {
        if (!is_maker_) {
            settled_.reset();
            making_ = Making::nothing;
        }
        if (!is_to_prepare_ && !settled_ && making_ == Making::nothing) return;
        // What is to be done is kept in members: a function with it would need memory, which may not be there.
        worker_.start([this] {
            if (const std::optional<Frame> frame = std::exchange(settled_, std::nullopt)) publish(*frame);
            if (making_ != Making::nothing) make();
            if (std::exchange(is_to_prepare_, false)) parts_.prepare();
        });
    }

    void make() noexcept {
        if (std::exchange(making_, Making::nothing) == Making::anew) has_part_ = false;
        parts_.make([this](const FinishedPart& part) {
            made_.part = part.number;
            std::swap(made_.mesh, part.mesh);
            made_.statistics = part.statistics;
            has_part_ = true;
        });
    }

    /// What belongs to no part counts in the first.
    static Statistics share_of(const PartsReport& report, const MadeMesh& made) {
        const bool is_first = made.part == 0;
        Statistics statistics = made.statistics;
        statistics.particles = is_first ? report.whole.particles : 0;
        statistics.particle_volume = is_first ? report.whole.particle_volume : 0.0;
        statistics.volume = is_first ? report.whole.volume : 0.0;
        statistics.vertices = report.own_vertices[made.part];
        return statistics;
    }

    void publish(const Frame& frame) {
        try {
            const PartsReport report = parts_.report();
            LivePart part{frame.index, frame.simulation_time, nullptr, 0, {}, report};
            if (has_part_) {
                part.mesh = &made_.mesh;
                part.number = made_.part;
                part.statistics = share_of(report, made_);
            }
            publisher_.publish(part);
        } catch (const std::exception& error) {
            failure_ = error.what();
        } catch (...) {
            failure_ = "an exception that is none of this library's";
        }
    }

    LivePolicy policy_;
    LivePublisher& publisher_;
    bool is_maker_;
    PartsReconstructor parts_;
    Agreement agreement_;
    std::optional<std::uint64_t> last_index_;
    std::uint64_t dropped_ = 0;
    std::optional<Frame> taken_;  ///< its particles are here
    std::optional<Frame> begun_;  ///< is being made
    // The worker's, while it is at work; what is to be done comes first:
    std::optional<Frame> settled_;  ///< is to be published
    Making making_ = Making::nothing;
    bool is_to_prepare_ = false;  ///< the frame that was taken
    MadeMesh made_;
    bool has_part_ = false;  ///< whether it is of the frame
    std::string failure_;    ///< of the publisher; empty: none
    Worker worker_;          ///< goes first
};

LiveParts::LiveParts(const Settings& settings, const BackendOptions& backend, const PartsOptions& options,
                     LivePolicy policy, PartExchange& exchange, LivePublisher& publisher)
    : impl_(std::make_unique<Impl>(settings, backend, options, policy, exchange, publisher)) {}
LiveParts::~LiveParts() = default;

bool LiveParts::push(const FrameGiver& mine, std::uint64_t index, double simulation_time) {
    return impl_->push(mine, index, simulation_time);
}

void LiveParts::finish() {
    impl_->finish();
}

std::uint64_t LiveParts::next_index() const {
    return impl_->next_index();
}

std::uint64_t LiveParts::dropped() const {
    return impl_->dropped();
}

}  // namespace meniscus
