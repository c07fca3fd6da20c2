/* Many ranks, one surface, which they reconstruct themselves: each rank of an MPI job hands over the particles that it
 * owns, and the server's viewer (http://127.0.0.1:9464/) shows the surface while the job runs.
 *
 *   mpicc live_mpi.c -o live_mpi $(pkg-config --cflags --libs meniscus) -lm
 *   mpirun -n 4 ./live_mpi 127.0.0.1:50051
 *
 * Where parts_mpi.c gives the server particles, this gives it a surface that is done.
 */
#include <meniscus/mpi.h>
#include <stdio.h>

#include "wave.h"

enum { steps = 2000 };

int main(int argc, char** argv) {
    int rank = 0;
    int ranks = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);

    meniscus_options* options = NULL;
    meniscus_options_create(&options);
    meniscus_options_set(options, "server", argc > 1 ? argv[1] : "127.0.0.1:50051");
    meniscus_options_set(options, "name", "an MPI job");
    meniscus_options_set(options, "up-axis", "z");
    meniscus_options_set_number(options, "particle-radius", WAVE_PARTICLE_RADIUS);
    meniscus_parts* parts = NULL;
    if (meniscus_parts_create(MPI_COMM_WORLD, options, &parts) < 0) {
        if (rank == 0) fprintf(stderr, "%s\n", meniscus_error_message());
        MPI_Finalize();
        return 1;
    }
    meniscus_options_destroy(options);

    for (uint64_t step = 0; step < steps; ++step) {
        static float positions[3 * WAVE_PARTICLES];
        const double seconds = 0.02 * (double)step;
        wave_at(seconds, positions); /* a simulation would have this rank's particles alone */
        const size_t begin = WAVE_PARTICLES * (size_t)rank / (size_t)ranks;
        const size_t end = WAVE_PARTICLES * ((size_t)rank + 1) / (size_t)ranks;
        meniscus_particles mine = MENISCUS_PARTICLES_INIT;
        mine.count = end - begin;
        mine.positions = positions + 3 * begin;
        /* Whatever it returns, the simulation goes on: a frame may be left out, and so may all while the server is
         * away. */
        if (meniscus_parts_push(parts, &mine, step, seconds) < 0 && rank == 0)
            fprintf(stderr, "%s\n", meniscus_error_message());
    }
    uint64_t dropped = 0;
    meniscus_parts_dropped(parts, &dropped);
    if (rank == 0) printf("%d frames, %d of them left out\n", (int)steps, (int)dropped);
    if (meniscus_parts_free(parts) < 0 && rank == 0) fprintf(stderr, "%s\n", meniscus_error_message());
    MPI_Finalize();
    return 0;
}
