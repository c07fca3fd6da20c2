// The time that the GPU spends in each of the paper's steps, by events between the kernels.
#pragma once

#include <array>
#include <cstddef>

#include "engine/cuda/stream.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::cuda {

class EventClock {
public:
    /// The first stage begins here, outside of any graph.
    void start(cudaStream_t stream) { start_.record(stream); }

    /// Called where the stages are put on the stream. captured: into a graph, which then records the events each time
    /// it runs.
    void begin(cudaStream_t stream, bool captured) {
        stream_ = stream;
        captured_ = captured;
        entered_ = 0;
    }
    void enter(Stage stage) {
        end_stage();
        stages_[entered_++] = stage;
    }
    void finish() { end_stage(); }

    /// The times of the stages, once the stream has been waited for.
    void add_to(Statistics& statistics) const {
        for (std::size_t i = 0; i < entered_; ++i)
            statistics.stage_seconds[static_cast<std::size_t>(stages_[i])] +=
                ends_[i].seconds_since(i == 0 ? start_ : ends_[i - 1]);
    }

private:
    static constexpr std::size_t most = stage_count + 1;  ///< the field is sampled twice

    void end_stage() {
        if (entered_ > 0) ends_[entered_ - 1].record(stream_, captured_);
    }

    Event start_;
    std::array<Event, most> ends_;
    std::array<Stage, most> stages_{};
    std::size_t entered_ = 0;
    cudaStream_t stream_ = nullptr;
    bool captured_ = false;
};

}  // namespace meniscus::cuda
