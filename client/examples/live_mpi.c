/* A dam break of many ranks, one surface, which they reconstruct themselves: each rank of an MPI job hands over the
 * water in its slab of the tank, and the server's viewer (http://127.0.0.1:9464/) shows the surface while the job runs.
 *
 *   mpicc live_mpi.c -o live_mpi $(pkg-config --cflags --libs meniscus) -lm
 *   mpirun -n 4 ./live_mpi 127.0.0.1:50051
 *
 * Where parts_mpi.c gives the server particles, this gives it a surface that is done.
 */
#define _POSIX_C_SOURCE 199309L /* nanosleep */
#include <math.h>
#include <meniscus/mpi.h>
#include <stdio.h>
#include <time.h>

enum { steps = 3000, most_particles = 20000 /* more than all of the water */ };
static const double radius = 0.02, back = -1.5, front = 3.0, width = 0.6; /* metres; the dam is at x = 0 */

/* Ritter's dam break: the depth of water that stood a metre high behind the dam, `seconds` after it is gone. */
static double depth_at(double x, double seconds) {
    const double speed = sqrt(9.81);
    if (x <= -speed * seconds) return 1.0;
    return x >= 2.0 * speed * seconds ? 0.0 : pow(2.0 * speed - x / seconds, 2.0) / (9.0 * 9.81);
}

/* The water between two places along the tank, x y z of each particle; returns their number. A simulation has these. */
static size_t fill(double from, double to, double seconds, float* positions) {
    size_t count = 0;
    for (double x = back + radius; x < to; x += 2.0 * radius) {
        if (x < from) continue;
        const double depth = depth_at(x, seconds), layers = floor(depth / (2.0 * radius) + 0.5);
        for (double y = radius; y < width; y += 2.0 * radius)
            for (double z = 0.5; z < layers; z += 1.0) {
                float* const particle = positions + 3 * count++;
                particle[0] = (float)x, particle[1] = (float)y, particle[2] = (float)(z * depth / layers);
            }
    }
    return count;
}

int main(int argc, char** argv) {
    int rank = 0, ranks = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    meniscus_options* options = NULL;
    meniscus_options_create(&options);
    meniscus_options_set(options, "server", argc > 1 ? argv[1] : "127.0.0.1:50051");
    meniscus_options_set(options, "name", "a dam break of an MPI job");
    meniscus_options_set(options, "up-axis", "z");
    meniscus_options_set_number(options, "particle-radius", radius);
    meniscus_parts* parts = NULL;
    if (meniscus_parts_create(MPI_COMM_WORLD, options, &parts) < 0) {
        if (rank == 0) fprintf(stderr, "%s\n", meniscus_error_message());
        MPI_Finalize();
        return 1;
    }
    meniscus_options_destroy(options);
    const double slab = (front - back) / ranks, from = back + slab * rank;
    const struct timespec pause = {0, 20000000};
    for (uint64_t step = 0; step < steps; ++step) {
        static float positions[3 * most_particles];
        meniscus_particles mine = MENISCUS_PARTICLES_INIT;
        mine.count = fill(from, from + slab, fmod(0.002 * (double)step, 0.48),
                          positions); /* until the wave is at the back, again */
        mine.positions = positions;
        /* Whatever it returns, the simulation goes on: a frame may be left out, and so may all while the server is
         * away. */
        if (meniscus_parts_push(parts, &mine, step, 0.002 * (double)step) < 0 && rank == 0)
            fprintf(stderr, "%s\n", meniscus_error_message());
        nanosleep(&pause, NULL);
    }
    uint64_t dropped = 0;
    meniscus_parts_dropped(parts, &dropped);
    if (rank == 0) printf("%d frames, %d of them left out\n", (int)steps, (int)dropped);
    if (meniscus_parts_free(parts) < 0 && rank == 0) fprintf(stderr, "%s\n", meniscus_error_message());
    MPI_Finalize();
    return 0;
}
