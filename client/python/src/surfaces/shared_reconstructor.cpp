#include "surfaces/shared_reconstructor.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include "meniscus/error.hpp"
#include "threads/ending.hpp"
#include "threads/process.hpp"
#include "threads/waiting.hpp"

namespace meniscus::python {
namespace {

BackendOptions stopped_by(BackendOptions options, std::shared_ptr<const StopFlag> stop) {
    options.stop = std::move(stop);
    return options;
}

}  // namespace

SharedReconstructor::SharedReconstructor(const Settings& settings, const BackendOptions& options)
    : content_(settings, stopped_by(options, stop_)),
      backend_(describe_backend(options.backend, options.device).name) {}

void SharedReconstructor::run(const std::function<void(OwnedFrame&)>& prepare,
                              const std::function<void(Work&)>& compute, const std::function<void(const Work&)>& use) {
    require_own_process();
    rest_at_end();
    try {
        run_in_turn(prepare, compute, use);
    } catch (const Stopped&) {
        rest_at_end();
        throw;
    }
}

void SharedReconstructor::run_in_turn(const std::function<void(OwnedFrame&)>& prepare,
                                      const std::function<void(Work&)>& compute,
                                      const std::function<void(const Work&)>& use) {
    using std::chrono::milliseconds;
    Turns::Turn turn(turns_);
    if (turn.is_nested())
        throw InvalidInput(
            "this Reconstructor is within a call of the same thread: a signal's handler needs its own one");
    if (!turn.wait(milliseconds(0)))
        wait_in_pieces([&turn](milliseconds piece) { return turn.wait(piece); }, std::nullopt);
    prepare(frame_);
    stop_->lower();
    const Computation computation(stop_);
    ++calls_;
    Work work{content_, frame_, MeshPool::take(meshes_)};
    wait_for([&] { compute(work); }, [this] { stop_->raise(); });
    use(work);
}

void SharedReconstructor::release_memory() {
    run([](OwnedFrame& frame) { frame.clear(); },
        [this](Work& work) {
            work.content.release_memory();
            work.mesh.reset();
            meshes_->clear();
        },
        [](const Work&) {});
}

}  // namespace meniscus::python
