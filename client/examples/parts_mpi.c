/* Many ranks, one surface: each rank of an MPI job pushes the particles that it has, and the server joins them.
 *
 *   mpicc parts_mpi.c -o parts_mpi $(pkg-config --cflags --libs meniscus) -lm
 *   mpirun -n 4 ./parts_mpi 127.0.0.1:50051
 *
 * Whatever a rank owns is right: slabs, any other decomposition, none at all; but no particle twice.
 */
#include <inttypes.h>
#include <meniscus/meniscus.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "wave.h"

enum { steps = 20, id_size = 37 };

static void check(meniscus_result result) {
    if (result >= 0) return;
    fprintf(stderr, "%s: %s\n", meniscus_result_name(result), meniscus_error_message());
    MPI_Abort(MPI_COMM_WORLD, 1);
}

static void set_number(meniscus_options* options, const char* name, uint64_t number) {
    char text[24];
    snprintf(text, sizeof text, "%" PRIu64, number);
    check(meniscus_options_set(options, name, text));
}

/* A number that this run alone has: part 0 draws it, and all ranks get it. */
static uint64_t number_of_run(int rank) {
    uint64_t run = 0;
    if (rank == 0) {
        FILE* const random = fopen("/dev/urandom", "rb");
        while (run == 0)
            if (random == NULL || fread(&run, sizeof run, 1, random) != 1) MPI_Abort(MPI_COMM_WORLD, 1);
        fclose(random);
    }
    MPI_Bcast(&run, sizeof run, MPI_BYTE, 0, MPI_COMM_WORLD);
    return run;
}

/* Rank 0 makes the session, and the others join it. */
static meniscus_session* open_session(meniscus_client* client, int rank, int ranks) {
    meniscus_options* options = NULL;
    check(meniscus_options_create(&options));
    check(meniscus_options_set_number(options, "particle-radius", WAVE_PARTICLE_RADIUS));
    check(meniscus_options_set_number(options, "reconnect", 30.0));
    set_number(options, "run", number_of_run(rank));
    set_number(options, "parts", (uint64_t)ranks);
    set_number(options, "part", (uint64_t)rank);
    char id[id_size] = "";
    meniscus_session* session = NULL;
    if (rank == 0) {
        check(meniscus_session_open(client, options, &session));
        strncpy(id, meniscus_session_id(session), id_size - 1);
    }
    MPI_Bcast(id, id_size, MPI_CHAR, 0, MPI_COMM_WORLD);
    if (rank != 0) {
        check(meniscus_options_set(options, "session", id));
        check(meniscus_session_open(client, options, &session));
    }
    meniscus_options_destroy(options);
    return session;
}

/* Takes the answers that have come, waiting this long for each: meshes at rank 0, figures alone at the others. */
static meniscus_result take_answers(meniscus_session* session, int rank, double seconds) {
    meniscus_frame* frame = NULL;
    meniscus_result result = meniscus_session_next(session, seconds, &frame);
    for (; result == MENISCUS_OK; result = meniscus_session_next(session, seconds, &frame)) {
        meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
        uint64_t index = 0;
        check(meniscus_frame_index(frame, &index));
        check(meniscus_frame_statistics(frame, &statistics));
        if (rank == 0)
            printf("frame %" PRIu64 ": %" PRIu64 " particles, %" PRIu64 " triangles\n", index, statistics.particles,
                   statistics.triangles);
        meniscus_frame_destroy(frame);
    }
    check(result);
    return result;
}

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    int rank = 0;
    int ranks = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (argc != 2) {
        if (rank == 0) fprintf(stderr, "usage: parts_mpi HOST:PORT\n");
        MPI_Finalize();
        return 2;
    }
    meniscus_client* client = NULL;
    check(meniscus_client_connect(argv[1], NULL, &client));
    meniscus_session* session = open_session(client, rank, ranks);

    for (uint64_t step = 0; step < steps; ++step) {
        static float positions[3 * WAVE_PARTICLES];
        const double seconds = 0.1 * (double)step;
        wave_at(seconds, positions); /* a simulation would have this rank's particles alone */
        const size_t begin = WAVE_PARTICLES * (size_t)rank / (size_t)ranks;
        const size_t end = WAVE_PARTICLES * ((size_t)rank + 1) / (size_t)ranks;
        meniscus_particles mine = MENISCUS_PARTICLES_INIT;
        mine.count = end - begin;
        mine.positions = positions + 3 * begin;
        check(meniscus_session_push(session, &mine, step, seconds)); /* the same index and time on every rank */
        take_answers(session, rank, 0.0);
    }
    check(meniscus_session_finish(session));
    while (take_answers(session, rank, 10.0) != MENISCUS_ENDED) fprintf(stderr, "the server takes its time\n");

    MPI_Barrier(MPI_COMM_WORLD); /* rank 0 ends the session */
    meniscus_session_destroy(session);
    meniscus_client_destroy(client);
    MPI_Finalize();
    return 0;
}
