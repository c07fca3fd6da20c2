#include "frame.hpp"
#include "mesh.hpp"
#include "result.hpp"

using namespace meniscus::c;

meniscus_result meniscus_frame_mesh(const meniscus_frame* frame, meniscus_mesh* mesh) {
    return guarded([&] {
        meniscus_mesh& filled = required(mesh, "mesh");
        const meniscus::client::ReceivedFrame& received = required(frame, "frame").content;
        filled.forget_arrays();
        filled.content = {};
        filled.content = received.mesh();
        filled.statistics = received.statistics;
        return MENISCUS_OK;
    });
}
