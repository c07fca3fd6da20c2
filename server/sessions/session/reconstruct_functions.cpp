#include "sessions/session/reconstruct_functions.hpp"

#include "meniscus/reconstructor.hpp"

namespace meniscus::server {

ReconstructFunctions make_reconstruct(const Settings& settings, const BackendOptions& backend) {
    const auto stop = std::make_shared<StopFlag>();
    BackendOptions stoppable = backend;
    stoppable.stop = stop;
    stoppable.keep_lattice = true;
    const auto reconstructor = std::make_shared<Reconstructor>(settings, stoppable);
    ReconstructFunctions functions{
        .reconstruct =
            [reconstructor](const ParticleFrame& frame, Mesh& mesh) {
                MeshDownload download = reconstructor->reconstruct_for_download(frame, mesh);
                return Reconstructed(reconstructor->statistics(), std::move(download));
            },
        .emit_capped = [reconstructor](int max_level, Mesh& mesh) { reconstructor->emit_capped(max_level, mesh); },
        .stop = stop,
        .release_memory = [reconstructor] { reconstructor->release_memory(); },
        .limit_memory = [reconstructor](std::size_t bytes) { reconstructor->limit_memory(bytes); }};
    if (backend.backend != Backend::cpu)
        functions.send_ahead = [weak = std::weak_ptr(reconstructor)](const ParticleFrame& frame) {
            // A call may keep a session for longer than it keeps its buffers.
            const auto alive = weak.lock();
            return alive ? alive->send_ahead(frame) : FrameUpload();
        };
    return functions;
}

}  // namespace meniscus::server
