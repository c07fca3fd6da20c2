/* Surfaces in the simulator's own process, from C.
 *
 *   cc in_process.c -o in_process $(pkg-config --cflags --libs meniscus) -lm
 *   ./in_process
 */
#include <meniscus/meniscus.h>
#include <stdio.h>
#include <stdlib.h>

#include "wave.h"

/* Results below 0 are errors. Handles can be used on after one; this program has nothing better to do than to end. */
static void check(meniscus_result result) {
    if (result >= 0) return;
    fprintf(stderr, "%s: %s\n", meniscus_result_name(result), meniscus_error_message());
    exit(1);
}

int main(void) {
    /* The settings, under the names of the command line. All but the radius have defaults. */
    meniscus_options* options = NULL;
    check(meniscus_options_create(&options));
    check(meniscus_options_set_number(options, "particle-radius", WAVE_PARTICLE_RADIUS));
    check(meniscus_options_set(options, "cell-size", "1.0"));
    check(meniscus_options_set(options, "attribute", "velocity"));

    /* One reconstructor and one mesh for all frames: they keep their memory. */
    meniscus_reconstructor* reconstructor = NULL;
    meniscus_mesh* mesh = NULL;
    check(meniscus_reconstructor_create(options, &reconstructor));
    check(meniscus_mesh_create(&mesh));
    meniscus_options_destroy(options);

    static float positions[3 * WAVE_PARTICLES];
    static float velocities[3 * WAVE_PARTICLES];
    const meniscus_array velocity = {"velocity", MENISCUS_FLOAT32, 3, velocities};
    for (int frame = 0; frame < 5; ++frame) {
        wave_at(0.1 * frame, positions);
        wave_velocity_at(0.1 * frame, velocities);
        meniscus_particles particles = MENISCUS_PARTICLES_INIT;
        particles.count = WAVE_PARTICLES;
        particles.positions = positions;
        particles.arrays = &velocity;
        particles.array_count = 1;
        check(meniscus_reconstruct(reconstructor, &particles, mesh));

        /* The mesh's arrays, for a renderer or a file; they are valid until the mesh is filled anew. */
        const float* vertices = NULL;
        const uint32_t* triangles = NULL;
        size_t vertex_count = 0;
        size_t triangle_count = 0;
        check(meniscus_mesh_vertices_float(mesh, &vertices, &vertex_count));
        check(meniscus_mesh_triangles(mesh, &triangles, &triangle_count));
        float highest = -INFINITY;
        for (size_t i = 0; i < vertex_count; ++i) highest = fmaxf(highest, vertices[3 * i + 2]);

        /* What the particles carry, at each vertex: here one array of three numbers. */
        const meniscus_array* attributes = NULL;
        size_t attribute_count = 0;
        check(meniscus_mesh_attributes(mesh, &attributes, &attribute_count));
        const float* values = attribute_count != 0 ? attributes[0].data : NULL;
        float fastest = 0.0F;
        for (size_t i = 0; values != NULL && i < vertex_count; ++i) fastest = fmaxf(fastest, fabsf(values[3 * i + 2]));

        char hash[MENISCUS_SHA256_SIZE];
        check(meniscus_mesh_sha256(mesh, hash));
        printf("frame %d: %zu triangles up to height %.3f, upward or down at most %.3f, mesh %s\n", frame,
               triangle_count, highest, fastest, hash);
    }

    meniscus_mesh_destroy(mesh);
    meniscus_reconstructor_destroy(reconstructor);
    return 0;
}
