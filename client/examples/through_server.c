/* Surfaces through a meniscusd, from C: pushes frames, and receives their meshes.
 *
 *   cc through_server.c -o through_server $(pkg-config --cflags --libs meniscus) -lm
 *   ./through_server 127.0.0.1:50051
 */
#include <inttypes.h>
#include <meniscus/meniscus.h>
#include <stdio.h>
#include <stdlib.h>

#include "wave.h"

static void check(meniscus_result result) {
    if (result >= 0) return;
    fprintf(stderr, "%s: %s\n", meniscus_result_name(result), meniscus_error_message());
    exit(1);
}

/* Pushes the frame that the wave has at this time. The server reconstructs it while this program goes on. */
static void push_frame(meniscus_session* session, uint64_t index) {
    static float positions[3 * WAVE_PARTICLES];
    const double seconds = 0.1 * (double)index;
    wave_at(seconds, positions);
    meniscus_particles particles = MENISCUS_PARTICLES_INIT;
    particles.count = WAVE_PARTICLES;
    particles.positions = positions; /* borrowed for the call */
    check(meniscus_session_push(session, &particles, index, seconds));
}

/* Takes the meshes that have come, waiting this long for each. Returns MENISCUS_NOTHING_YET or MENISCUS_ENDED. */
static meniscus_result take_frames(meniscus_session* session, double seconds, meniscus_mesh* mesh) {
    meniscus_frame* frame = NULL;
    meniscus_result result = meniscus_session_next(session, seconds, &frame);
    for (; result == MENISCUS_OK; result = meniscus_session_next(session, seconds, &frame)) {
        uint64_t index = 0;
        size_t triangle_count = 0;
        const uint32_t* triangles = NULL;
        char hash[MENISCUS_SHA256_SIZE];
        check(meniscus_frame_index(frame, &index));
        check(meniscus_frame_mesh(frame, mesh));
        check(meniscus_mesh_triangles(mesh, &triangles, &triangle_count));
        check(meniscus_mesh_sha256(mesh, hash));
        printf("frame %" PRIu64 ": %zu triangles, mesh %s\n", index, triangle_count, hash);
        meniscus_frame_destroy(frame);
    }
    check(result);
    return result;
}

int main(int argc, char** argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: through_server HOST:PORT\n");
        return 2;
    }
    /* Options would be those of TLS, or a token. */
    meniscus_client* client = NULL;
    check(meniscus_client_connect(argv[1], NULL, &client));

    /* The settings, and how viewers show the session. It ends with its handle, or soon after this process has died. */
    meniscus_options* options = NULL;
    check(meniscus_options_create(&options));
    check(meniscus_options_set_number(options, "particle-radius", WAVE_PARTICLE_RADIUS));
    check(meniscus_options_set(options, "cell-size", "1.0"));
    check(meniscus_options_set(options, "name", "standing wave"));
    check(meniscus_options_set(options, "up-axis", "z"));
    meniscus_session* session = NULL;
    check(meniscus_session_open(client, options, &session));
    meniscus_options_destroy(options);
    fprintf(stderr, "session %s\n", meniscus_session_id(session));

    /* A solver's loop: it takes what is there already, and never waits for meshes. */
    meniscus_mesh* mesh = NULL;
    check(meniscus_mesh_create(&mesh));
    for (uint64_t index = 0; index < 5; ++index) {
        push_frame(session, index);
        take_frames(session, 0.0, mesh);
    }
    check(meniscus_session_finish(session));
    while (take_frames(session, 10.0, mesh) != MENISCUS_ENDED) fprintf(stderr, "the server takes its time\n");

    meniscus_mesh_destroy(mesh);
    meniscus_session_destroy(session);
    meniscus_client_destroy(client);
    return 0;
}
