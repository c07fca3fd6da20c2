// A chain of launches, captured once and replayed.
#pragma once

#include "engine/cuda/errors.hpp"
#include "engine/cuda/launch_observer.hpp"

namespace meniscus::cuda {

class Graph {
public:
    Graph() = default;
    ~Graph() { drop(); }
    Graph(const Graph&) = delete;
    Graph& operator=(const Graph&) = delete;

    bool is_captured() const { return graph_ != nullptr; }
    void drop() {
        if (graph_ != nullptr) cudaGraphExecDestroy(graph_);
        graph_ = nullptr;
    }

    /// enqueue: puts work on the stream and waits for nothing.
    template <class Enqueue>
    void capture(cudaStream_t stream, const Enqueue& enqueue) {
        // Other sessions' threads go on calling CUDA meanwhile.
        check(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal), "cudaStreamBeginCapture");
        cudaGraph_t chain = nullptr;
        try {
            enqueue();
        } catch (...) {
            cudaStreamEndCapture(stream, &chain);
            if (chain != nullptr) cudaGraphDestroy(chain);
            throw;
        }
        check(cudaStreamEndCapture(stream, &chain), "cudaStreamEndCapture");
        const cudaError_t status = cudaGraphInstantiate(&graph_, chain, 0);
        cudaGraphDestroy(chain);
        check(status, "cudaGraphInstantiate");
    }
    void launch(cudaStream_t stream) {
        const ObservedLaunch observed({.kind = LaunchKind::graph, .stream = stream});
        check(cudaGraphLaunch(graph_, stream), "cudaGraphLaunch");
    }

private:
    cudaGraphExec_t graph_ = nullptr;
};

}  // namespace meniscus::cuda
