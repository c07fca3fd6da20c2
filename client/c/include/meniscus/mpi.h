/* Surfaces of the particles of an MPI job: this header is compiled by the job's own mpicc, for libmeniscus links no
 * MPI. With MPI_THREAD_FUNNELED or more: MPI is called in meniscus_parts_create(), meniscus_parts_push() and
 * meniscus_parts_free() alone, on the thread that calls them, on a communicator of their own.
 *
 *   meniscus_parts* parts = NULL;
 *   meniscus_parts_create(MPI_COMM_WORLD, options, &parts);
 *   for (...) meniscus_parts_push(parts, &mine, step, time);
 *   meniscus_parts_free(parts);
 */
#ifndef MENISCUS_MPI_H
#define MENISCUS_MPI_H

#include <meniscus/meniscus.h>
#include <mpi.h>
#include <stdlib.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct meniscus_mpi_context {
    MPI_Comm comm;
    int rank;
    int ranks;
    int* counts; /* of MPI_Allgatherv, as are the places behind them */
} meniscus_mpi_context;

static inline int meniscus_mpi_gather(void* context, const void* mine, const size_t* sizes, void* all) {
    meniscus_mpi_context* const mpi = (meniscus_mpi_context*)context;
    int* const counts = mpi->counts;
    int* const places = counts + mpi->ranks;
    int place = 0;
    for (int i = 0; i < mpi->ranks; ++i) {
        counts[i] = (int)sizes[i];
        places[i] = place;
        place += counts[i];
    }
    return MPI_Allgatherv(mine, counts[mpi->rank], MPI_BYTE, all, counts, places, MPI_BYTE, mpi->comm);
}

static inline int meniscus_mpi_trade_sizes(void* context, const uint64_t* to, uint64_t* from) {
    return MPI_Alltoall(to, 1, MPI_UINT64_T, from, 1, MPI_UINT64_T, ((meniscus_mpi_context*)context)->comm);
}

/* The length of the piece of `size` bytes that begins at `at`: MPI counts in int. */
static inline int meniscus_mpi_piece(uint64_t size, uint64_t at) {
    const uint64_t most = (uint64_t)1 << 30;
    return at >= size ? 0 : (int)(size - at < most ? size - at : most);
}

/* In turns: to each rank, from the one that is as far on the other side. */
static inline int meniscus_mpi_trade(void* context, const void* const* to, const uint64_t* to_sizes, void* const* from,
                                     const uint64_t* from_sizes) {
    meniscus_mpi_context* const mpi = (meniscus_mpi_context*)context;
    for (int turn = 1; turn < mpi->ranks; ++turn) {
        const int next = (mpi->rank + turn) % mpi->ranks;
        const int before = (mpi->rank + mpi->ranks - turn) % mpi->ranks;
        for (uint64_t at = 0; at < to_sizes[next] || at < from_sizes[before]; at += (uint64_t)1 << 30) {
            const int sent = meniscus_mpi_piece(to_sizes[next], at);
            const int received = meniscus_mpi_piece(from_sizes[before], at);
            const int failed = MPI_Sendrecv((const char*)to[next] + at, sent, MPI_BYTE, sent ? next : MPI_PROC_NULL, 0,
                                            (char*)from[before] + at, received, MPI_BYTE,
                                            received ? before : MPI_PROC_NULL, 0, mpi->comm, MPI_STATUS_IGNORE);
            if (failed != MPI_SUCCESS) return failed;
        }
    }
    return MPI_SUCCESS;
}

static inline void meniscus_mpi_release(void* context) {
    meniscus_mpi_context* const mpi = (meniscus_mpi_context*)context;
    MPI_Comm_free(&mpi->comm);
    free(mpi->counts);
    free(mpi);
}

/* Collective over comm, which is duplicated: meniscus_parts_open() for it. */
static inline meniscus_result meniscus_parts_create(MPI_Comm comm, const meniscus_options* options,
                                                    meniscus_parts** parts) {
    meniscus_exchange exchange = {sizeof(meniscus_exchange), 0, 0, 0, NULL, NULL, NULL, NULL, NULL};
    meniscus_mpi_context* const mpi = (meniscus_mpi_context*)malloc(sizeof(meniscus_mpi_context));
    MPI_Comm node = MPI_COMM_NULL;
    int rank_in_node = 0;
    if (mpi == NULL) MPI_Abort(comm, MPI_ERR_NO_MEM);
    MPI_Comm_dup(comm, &mpi->comm);
    MPI_Comm_rank(mpi->comm, &mpi->rank);
    MPI_Comm_size(mpi->comm, &mpi->ranks);
    mpi->counts = (int*)malloc(2 * sizeof(int) * (size_t)mpi->ranks);
    if (mpi->counts == NULL) MPI_Abort(comm, MPI_ERR_NO_MEM);
    MPI_Comm_split_type(mpi->comm, MPI_COMM_TYPE_SHARED, mpi->rank, MPI_INFO_NULL, &node);
    MPI_Comm_rank(node, &rank_in_node);
    MPI_Comm_free(&node);
    exchange.rank = (uint32_t)mpi->rank;
    exchange.ranks = (uint32_t)mpi->ranks;
    exchange.leads_node = rank_in_node == 0;
    exchange.context = mpi;
    exchange.gather = meniscus_mpi_gather;
    exchange.trade_sizes = meniscus_mpi_trade_sizes;
    exchange.trade = meniscus_mpi_trade;
    exchange.release = meniscus_mpi_release;
    {
        const meniscus_result result = meniscus_parts_open(&exchange, options, parts);
        if (result < 0) meniscus_mpi_release(mpi);
        return result;
    }
}

#ifdef __cplusplus
}
#endif

#endif /* MENISCUS_MPI_H */
