/* An MPI job that pushes frames from files of x y z as float32, for tests.
 *
 *   mpirun -n K parts_job DEAL NAME=VALUE... FILE...
 *
 * DEAL says which rank owns a particle: random (otherwise in each frame), one (the last rank has all), slabs (along x,
 * all of one width), moving (slabs that pass from rank to rank). NAME=VALUE: options of meniscus_parts_create(). Rank 0
 * reads a line of standard input before each frame, and before the end; the end of the input ends it, too. It answers
 * by a line: the result's name and a message. Before all, each rank writes "pid RANK PID", and rank 0 "session ID".
 */
#define _POSIX_C_SOURCE 200809L
#include <meniscus/mpi.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static int rank, ranks;

static float* read_file(const char* path, size_t* particles) {
    FILE* const file = fopen(path, "rb");
    if (file == NULL) MPI_Abort(MPI_COMM_WORLD, 2);
    fseek(file, 0, SEEK_END);
    const size_t bytes = (size_t)ftell(file);
    rewind(file);
    float* const positions = malloc(bytes + 1);
    if (positions == NULL || fread(positions, 1, bytes, file) != bytes) MPI_Abort(MPI_COMM_WORLD, 2);
    fclose(file);
    *particles = bytes / (3 * sizeof(float));
    return positions;
}

static unsigned mixed(unsigned x) {
    x = (x ^ (x >> 16)) * 0x7feb352dU;
    x = (x ^ (x >> 15)) * 0x846ca68bU;
    return x ^ (x >> 16);
}

static int owner(const char* deal, const float* place, size_t particle, unsigned step, const float* low, float width) {
    if (strcmp(deal, "random") == 0) return (int)(mixed((unsigned)particle + 7919U * step) % (unsigned)ranks);
    if (strcmp(deal, "one") == 0) return ranks - 1;
    const float at = width > 0.0F ? (place[0] - low[0]) / width * (float)ranks : 0.0F;
    const int slab = at < (float)ranks ? (int)at : ranks - 1;
    return strcmp(deal, "moving") == 0 ? (slab + (int)step) % ranks : slab;
}

/* The particles that this rank owns, packed to the front. */
static size_t own(const char* deal, float* positions, size_t count, unsigned step) {
    float low[3] = {0.0F, 0.0F, 0.0F}, high = 0.0F;
    for (size_t i = 0; i < count; ++i) {
        if (i == 0 || positions[3 * i] < low[0]) low[0] = positions[3 * i];
        if (i == 0 || positions[3 * i] > high) high = positions[3 * i];
    }
    size_t mine = 0;
    for (size_t i = 0; i < count; ++i)
        if (owner(deal, positions + 3 * i, i, step, low, high - low[0]) == rank)
            memmove(positions + 3 * mine++, positions + 3 * i, 3 * sizeof(float));
    return mine;
}

static int is_told(void) {
    int told = 0;
    if (rank == 0) {
        char line[64];
        told = fgets(line, sizeof line, stdin) != NULL;
    }
    MPI_Bcast(&told, 1, MPI_INT, 0, MPI_COMM_WORLD);
    return told;
}

/* All ranks must have the same result. */
static void answer(meniscus_result result) {
    int results[2] = {(int)result, -(int)result}, least[2];
    MPI_Reduce(results, least, 2, MPI_INT, MPI_MIN, 0, MPI_COMM_WORLD);
    if (rank != 0) return;
    printf("%s %s\n", least[0] == -least[1] ? meniscus_result_name(result) : "different",
           result < 0 ? meniscus_error_message() : "");
    fflush(stdout);
}

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    meniscus_options* options = NULL;
    meniscus_options_create(&options);
    int next = 2;
    for (char* value; next < argc && (value = strchr(argv[next], '=')) != NULL; ++next) {
        *value = '\0';
        if (meniscus_options_set(options, argv[next], value + 1) < 0) MPI_Abort(MPI_COMM_WORLD, 3);
    }
    printf("pid %d %ld\n", rank, (long)getpid());
    fflush(stdout);
    MPI_Barrier(MPI_COMM_WORLD);
    meniscus_parts* parts = NULL;
    meniscus_result result = meniscus_parts_create(MPI_COMM_WORLD, options, &parts);
    meniscus_options_destroy(options);
    if (rank == 0 && result == MENISCUS_OK) printf("session %s\n", meniscus_parts_session_id(parts));
    answer(result);
    for (unsigned step = 0; result == MENISCUS_OK && next < argc && is_told(); ++step, ++next) {
        meniscus_particles particles = MENISCUS_PARTICLES_INIT;
        float* const positions = read_file(argv[next], &particles.count);
        particles.count = own(argv[1], positions, particles.count, step);
        particles.positions = positions;
        answer(meniscus_parts_push(parts, &particles, step, 0.5 * step));
        free(positions);
    }
    if (result == MENISCUS_OK) is_told();
    answer(meniscus_parts_free(parts));
    MPI_Finalize();
    return 0;
}
