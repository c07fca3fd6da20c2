#include "meniscus/reconstructor.hpp"

#include "mesh.hpp"
#include "options.hpp"
#include "particles.hpp"
#include "result.hpp"
#include "sized_struct.hpp"
#include "statistics.hpp"
#include "text_options/backend_options.hpp"
#include "text_options/settings_options.hpp"

using namespace meniscus::c;
using namespace meniscus::text_options;

struct meniscus_reconstructor {
    meniscus::Reconstructor content;
    FrameBuffers buffers;
};

meniscus_result meniscus_reconstructor_create(const meniscus_options* options, meniscus_reconstructor** reconstructor) {
    return guarded([&] {
        required(reconstructor, "reconstructor") = nullptr;
        auto reader = reader_of(options);
        const meniscus::BackendOptions backend = read_backend(reader);
        const meniscus::Settings settings = read_settings(reader);
        reader.finish();
        *reconstructor = new meniscus_reconstructor{meniscus::Reconstructor(settings, backend), {}};
        return MENISCUS_OK;
    });
}

void meniscus_reconstructor_destroy(meniscus_reconstructor* reconstructor) {
    delete reconstructor;
}

meniscus_result meniscus_reconstruct(meniscus_reconstructor* reconstructor, const meniscus_particles* particles,
                                     meniscus_mesh* mesh) {
    return guarded([&] {
        meniscus_reconstructor& used = required(reconstructor, "reconstructor");
        meniscus_mesh& filled = required(mesh, "mesh");
        const meniscus::ParticleFrame frame = read_frame(particles, used.buffers).frame;
        filled.forget_arrays();
        used.content.reconstruct(frame, filled.content);
        filled.statistics = used.content.statistics();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_reconstructor_statistics(const meniscus_reconstructor* reconstructor,
                                                  meniscus_statistics* statistics) {
    return guarded([&] {
        write_struct(to_c(required(reconstructor, "reconstructor").content.statistics()), statistics, "statistics");
        return MENISCUS_OK;
    });
}
