/* Surfaces of particles for C, and for every language that calls C: in process, and through a meniscusd.
 *
 * What stays: within one SONAME, functions keep their parameters, results their numbers, and options their names;
 * structs grow at their end alone, which struct_size shows. New functions, results and options may come. Handles are
 * opaque.
 *
 * Every function that can fail returns a meniscus_result; below 0 it is an error, and meniscus_error_message() says in
 * words what was wrong and what to do. What a function would give is then NULL or unchanged, and the handle can be used
 * on, unless the function says otherwise. No C++ exception leaves the library. A handle that is NULL is an error, too,
 * but to the functions that destroy, which ignore it.
 *
 * One handle is used by one thread at a time, unless its functions say otherwise; several handles may be used side by
 * side. The library stays loaded once it is.
 */
#ifndef MENISCUS_MENISCUS_H
#define MENISCUS_MENISCUS_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define MENISCUS_API __attribute__((visibility("default")))
#else
#define MENISCUS_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Results ---------------------------------------------------------------------------------------------------- */

typedef enum meniscus_result {
    MENISCUS_OK = 0,
    MENISCUS_NOTHING_YET = 1, /* the time was over before a frame came; ask again */
    MENISCUS_ENDED = 2,       /* well, or canceled: no more frames will come */
    MENISCUS_WOULD_WAIT = 3,  /* nothing was taken */

    MENISCUS_INVALID_INPUT = -1,  /* a value, a position, an option, a NULL */
    MENISCUS_LIMIT_EXCEEDED = -2, /* well formed, but more than a limit */
    MENISCUS_OUT_OF_MEMORY = -3,
    MENISCUS_DEVICE = -4,      /* the GPU failed */
    MENISCUS_UNAVAILABLE = -5, /* the server is not there, or went away */
    MENISCUS_NOT_FOUND = -6,   /* there is no such session */
    MENISCUS_ALREADY_EXISTS = -7,
    MENISCUS_UNAUTHENTICATED = -8,
    MENISCUS_PERMISSION_DENIED = -9,
    MENISCUS_FAILED_PRECONDITION = -10, /* not possible now */
    MENISCUS_DEADLINE_EXCEEDED = -11,   /* the server did not answer in time */
    MENISCUS_CANCELED = -12,
    MENISCUS_UNIMPLEMENTED = -13, /* a server of another version, or none of ours; a part that this library lacks */
    MENISCUS_DATA_LOSS = -14,     /* what was received is damaged */
    MENISCUS_ABORTED = -15,       /* gave way to another call */
    MENISCUS_INTERNAL = -16,      /* a defect: please report it with its message */
    MENISCUS_UNKNOWN = -17
} meniscus_result;

/* "ok", "invalid_input" and so on; "unknown" for other numbers. A constant. */
MENISCUS_API const char* meniscus_result_name(meniscus_result result);

/* The message of the last function that failed in this thread; "" before any has. At most 1023 bytes of UTF-8, valid
 * until the next one fails in this thread. */
MENISCUS_API const char* meniscus_error_message(void);

/* The library's version, "major.minor.patch". A constant. */
MENISCUS_API const char* meniscus_version(void);

/* ---- Options: values by name ------------------------------------------------------------------------------------ */

/* Named values in any order, for the functions that take them; each says which names it knows, and refuses others; a
 * name that none of them knows is refused where it is set. The names and values are those of the command line's options
 * without "--"; durations are in seconds. NULL in place of options: none are set. Options may be destroyed after the
 * call that they were for, or used for more calls. */
typedef struct meniscus_options meniscus_options;

MENISCUS_API meniscus_result meniscus_options_create(meniscus_options** options);
MENISCUS_API void meniscus_options_destroy(meniscus_options* options);
/* value: text such as "0.5", "color", "true" or "X0 Y0 Z0 X1 Y1 Z1", whatever the locale; copied. NULL: unset. Whether
 * the value is right is known where it is used. */
MENISCUS_API meniscus_result meniscus_options_set(meniscus_options* options, const char* name, const char* value);
/* Sets a value that is a number. */
MENISCUS_API meniscus_result meniscus_options_set_number(meniscus_options* options, const char* name, double value);

/* ---- Arrays ----------------------------------------------------------------------------------------------------- */

typedef enum meniscus_type {
    MENISCUS_FLOAT32 = 1,
    MENISCUS_UINT8 = 2,
    MENISCUS_INT32 = 4, /* an id, as are those of the next one: never averaged */
    MENISCUS_UINT32 = 5
} meniscus_type;

/* A value that each particle carries, such as a velocity, or that each vertex has of it. This struct does not grow. */
typedef struct meniscus_array {
    const char* name;    /* 1 to 64 of a-z, 0-9 and _ */
    uint32_t type;       /* a meniscus_type */
    uint32_t components; /* numbers of each: 1, 3 or 4 of float32 and uint8, 1 of int32 and uint32 */
    const void* data;    /* those of one after those of the other */
} meniscus_array;

/* ---- Particles -------------------------------------------------------------------------------------------------- */

/* One frame, borrowed for the time of the call. */
typedef struct meniscus_particles {
    size_t struct_size;             /* sizeof(meniscus_particles) */
    size_t count;                   /* particles */
    const float* positions;         /* x y z of each, world units, finite; or NULL, and one of the others is set */
    const double* positions_double; /* each number is rounded to the nearest float32 */
    size_t stride;                  /* bytes from one particle's x to the next one's; 0: there are no gaps */
    const uint8_t* levels;          /* NULL, or one of each: 0 to 3. Level k has 2^k times the radius of level 0 */
    size_t array_count;             /* at most 16, here and below since 0.2 */
    const meniscus_array* arrays;   /* further values of each, whose numbers are finite: those that the option
                                       "attribute" names become attributes of the vertices, others are passed over */
    const float* axes[3];           /* in place of positions: where x, y and z lie, each by itself; since 0.2 */
    const double* axes_double[3];   /* in place of positions_double; since 0.2 */
} meniscus_particles;

/* clang-format off */
#define MENISCUS_PARTICLES_INIT \
    { sizeof(meniscus_particles), 0, NULL, NULL, 0, NULL, 0, NULL, {NULL, NULL, NULL}, {NULL, NULL, NULL} }
/* clang-format on */

/* ---- Meshes ----------------------------------------------------------------------------------------------------- */

/* A closed, oriented triangle mesh; keeps its memory from one frame to the next. The arrays that its functions give
 * belong to it, and are valid until it is filled anew or destroyed. Some are made when they are asked for first, which
 * may fail for want of memory. Of an empty array the pointer is NULL. */
typedef struct meniscus_mesh meniscus_mesh;

/* Makes an empty mesh. */
MENISCUS_API meniscus_result meniscus_mesh_create(meniscus_mesh** mesh);
MENISCUS_API void meniscus_mesh_destroy(meniscus_mesh* mesh);
/* x y z of each of `count` vertices, world units: exact but for one rounding to float64. */
MENISCUS_API meniscus_result meniscus_mesh_vertices(meniscus_mesh* mesh, const double** vertices, size_t* count);
/* The vertices as meniscus_mesh_vertices() has them, rounded to float32. */
MENISCUS_API meniscus_result meniscus_mesh_vertices_float(meniscus_mesh* mesh, const float** vertices, size_t* count);
/* x y z of each, unit length, outward; none without the option "normals". */
MENISCUS_API meniscus_result meniscus_mesh_normals(meniscus_mesh* mesh, const float** normals, size_t* count);
/* Three vertices of each of `count` triangles, from 0, counter-clockwise seen from outside. */
MENISCUS_API meniscus_result meniscus_mesh_triangles(meniscus_mesh* mesh, const uint32_t** triangles, size_t* count);
/* The level of grid of each triangle: 1, 2, 3 (finest), or 0 for crack filling. */
MENISCUS_API meniscus_result meniscus_mesh_triangle_levels(meniscus_mesh* mesh, const uint8_t** levels, size_t* count);
/* x y z of each particle that the surface leaves out, with the option "spray" set to "points"; world units. */
MENISCUS_API meniscus_result meniscus_mesh_spray(meniscus_mesh* mesh, const float** places, size_t* count);
/* The vertices' values of the particles' arrays: `count` arrays, in the order of the option "attribute", each with
 * values of every vertex; their data are NULL in a mesh without vertices. Since 0.2. */
MENISCUS_API meniscus_result meniscus_mesh_attributes(meniscus_mesh* mesh, const meniscus_array** attributes,
                                                      size_t* count);
/* Bytes for meniscus_mesh_sha256(). */
#define MENISCUS_SHA256_SIZE 65
/* The identity of the geometry as the command line's mesh_sha256: 64 hexadecimal digits and a 0. */
MENISCUS_API meniscus_result meniscus_mesh_sha256(const meniscus_mesh* mesh, char digits[MENISCUS_SHA256_SIZE]);
/* The identity of the geometry as a sum over its bricks, the command line's bricks_sha256: where several programs have
 * some bricks each, theirs add up to it, modulo 2^256, as numbers of 64 hexadecimal digits. Since 0.2. */
MENISCUS_API meniscus_result meniscus_mesh_bricks_sha256(const meniscus_mesh* mesh, char digits[MENISCUS_SHA256_SIZE]);

/* ---- Figures ---------------------------------------------------------------------------------------------------- */

/* One frame's figures. Set struct_size, or begin with MENISCUS_STATISTICS_INIT; the library fills in what fits. */
typedef struct meniscus_statistics {
    size_t struct_size; /* sizeof(meniscus_statistics) */
    uint64_t particles;
    uint64_t vertices;
    uint64_t triangles;
    uint64_t triangles_by_level[4]; /* levels 1, 2, 3, crack filling */
    uint64_t spray_particles;       /* without company, whatever the option "spray" makes of them */
    double volume;                  /* enclosed by the mesh, world units cubed */
    double particle_volume;         /* the sum of (2 r)^3, world units cubed */
    uint64_t field_evaluations;
    double total_seconds;
    double stage_seconds[8]; /* of the paper's steps: register particles, split cells, adjust levels, sample field,
                                count triangles, place vertices, emit triangles, fill cracks */
    uint64_t peak_bytes;
    uint64_t device_bytes; /* on the GPU */
    double encode_seconds; /* of a frame from a server, here and below; else 0 */
    double latency_seconds;
    uint64_t encoded_bytes;
    uint64_t vertices_without_particles; /* at which attributes are 0, since no particle is near; since 0.2 */
} meniscus_statistics;

#define MENISCUS_STATISTICS_INIT                                                 \
    {                                                                            \
        sizeof(meniscus_statistics), 0, 0, 0, {0, 0, 0, 0}, 0, 0.0, 0.0, 0, 0.0, \
            {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0, 0, 0.0, 0.0, 0, 0       \
    }

/* ---- In process ------------------------------------------------------------------------------------------------- */

/* Reconstructs the surfaces of frames, one after the other, and keeps its buffers between them. */
typedef struct meniscus_reconstructor meniscus_reconstructor;

/* options: the settings, by the names of their flags in client/README.md without the dashes before them, as cell-size:
 * particle-radius is required, normals is true or false, attribute has names with spaces between them, or all. And
 * backend (auto, cpu or cuda), threads (0: one for each processor), memory-limit (bytes, 0: none), device (which GPU),
 * device-memory-limit, keep-lattice (true: meshes keep what their bricks are made of, for meniscus_publisher_push();
 * false, the default; since 0.2). */
MENISCUS_API meniscus_result meniscus_reconstructor_create(const meniscus_options* options,
                                                           meniscus_reconstructor** reconstructor);
MENISCUS_API void meniscus_reconstructor_destroy(meniscus_reconstructor* reconstructor);
/* Fills the mesh; after an error it is empty, unless `particles` or a handle was wrong in itself. */
MENISCUS_API meniscus_result meniscus_reconstruct(meniscus_reconstructor* reconstructor,
                                                  const meniscus_particles* particles, meniscus_mesh* mesh);
/* The last frame's figures. */
MENISCUS_API meniscus_result meniscus_reconstructor_statistics(const meniscus_reconstructor* reconstructor,
                                                               meniscus_statistics* statistics);

/* ---- Through a server ------------------------------------------------------------------------------------------- */

/* A library that was built without the service starts a program that has it for each session, `meniscus push`: the one
 * that MENISCUS_PROGRAM names, or else `meniscus` in PATH, which meniscus_client_connect() looks for; the server is
 * asked when the session or the publisher is opened. Frames then have index, time and figures, but no mesh. What else
 * is not to be had through that program returns MENISCUS_UNIMPLEMENTED, with a sentence: watchers,
 * meniscus_client_delete_session(), meniscus_session_leave(), meniscus_session_try_push(), meniscus_publisher_leave(),
 * meniscus_frame_mesh(), and the options timeout, route-check and ephemeral set to false. A session's options about
 * meshes change nothing there; a publisher encodes its bricks in this process, as they say. */

/* A connection to one meniscusd; any thread may use it at any time. Sessions and watchers outlive it. */
typedef struct meniscus_client meniscus_client;
/* A session of the server with its one stream: particles go up, meshes come down. */
typedef struct meniscus_session meniscus_session;
/* A session of the server to which this program publishes surfaces that it has made itself. Since 0.2, as are all of
 * its functions. */
typedef struct meniscus_publisher meniscus_publisher;
/* Receives the meshes of somebody's session: always the newest. */
typedef struct meniscus_watcher meniscus_watcher;
/* A received frame, with the mesh still encoded. */
typedef struct meniscus_frame meniscus_frame;

/* address: "HOST:PORT", "HOST" for port 50051, or "unix:PATH". options: tls-ca, tls-cert, tls-key (PEM files),
 * tls-server-name, token, insecure (true or false), timeout (seconds for which a host may not answer), wait (seconds
 * for a server that is starting). */
MENISCUS_API meniscus_result meniscus_client_connect(const char* address, const meniscus_options* options,
                                                     meniscus_client** client);
MENISCUS_API void meniscus_client_destroy(meniscus_client* client);
/* Ends a session, also one that another client made. */
MENISCUS_API meniscus_result meniscus_client_delete_session(meniscus_client* client, const char* session_id);

/* options: the settings, as for meniscus_reconstructor_create(); of the session: session (id: joins it if it is there
 * with equal settings; default: a new one), name, up-axis (x, y or z), length-unit (such as m), ephemeral (true, the
 * default: the server ends it soon after this process has vanished; false), publish (true: the server publishes it as
 * plain files; false, the default); of the stream: meshes (true or false: whether they come back at all), normal-bits
 * (2 to 16, 0 for none), normals-by (server, the default, or receiver: the library computes them from the triangles,
 * none are sent, and normal-bits does not count), attribute-bits (1 to 16, default 8: each float32 of the attributes
 * comes back rounded to one of 2^bits values; 0: exactly), codec (of the meshes: packed, the default from a server on
 * this machine, entropy, the default from others, or draco), waiting-limit (received frames that wait at most; 0, the
 * default: no limit), policy (every-frame, latest or every-nth), nth, parts (sessions with this id, of this and of
 * other processes, that each push a part of every frame, with the same indices and times; whatever ends the stream of
 * one ends all), part (the number of this one, counted from 0; meshes come to part 0 alone), run (with parts: a number
 * from 1 on that all of them share, and no other run), reconnect (seconds, 0: not at all). */
MENISCUS_API meniscus_result meniscus_session_open(meniscus_client* client, const meniscus_options* options,
                                                   meniscus_session** session);
/* Cancels what is in flight, and ends the session if this handle has made it, unless meniscus_session_leave() was
 * called. */
MENISCUS_API void meniscus_session_destroy(meniscus_session* session);
/* Lets the session live on when the handle is destroyed; an ephemeral one then ends as the server has it. */
MENISCUS_API meniscus_result meniscus_session_leave(meniscus_session* session);
/* The session's id, for watchers. Valid as long as the session; NULL for NULL. */
MENISCUS_API const char* meniscus_session_id(const meniscus_session* session);
/* Sends one frame; waits while the server does not take more. `index` is greater than the one before. Once the server
 * has refused a frame the stream has ended: this function and meniscus_session_next() say why again and again.
 *
 * push(), try_push() and finish() may be used by one thread while another uses next(), and any thread calls cancel().
 */
MENISCUS_API meniscus_result meniscus_session_push(meniscus_session* session, const meniscus_particles* particles,
                                                   uint64_t index, double simulation_time);
/* Sends one frame where push() would not wait; else returns MENISCUS_WOULD_WAIT. */
MENISCUS_API meniscus_result meniscus_session_try_push(meniscus_session* session, const meniscus_particles* particles,
                                                       uint64_t index, double simulation_time);
/* No more frames will be pushed; next() then ends after the last one. */
MENISCUS_API meniscus_result meniscus_session_finish(meniscus_session* session);
/* Waits for the next frame, in order. timeout_seconds: 0 does not wait; below 0 waits for as long as it takes.
 * MENISCUS_OK: a frame, to be destroyed. MENISCUS_NOTHING_YET, MENISCUS_ENDED: none, *frame is NULL. */
MENISCUS_API meniscus_result meniscus_session_next(meniscus_session* session, double timeout_seconds,
                                                   meniscus_frame** frame);
/* Ends the stream at once, and what waits in other threads: push() returns MENISCUS_CANCELED from then on, next()
 * MENISCUS_ENDED. */
MENISCUS_API meniscus_result meniscus_session_cancel(meniscus_session* session);
/* Frames that the policy has left out so far. */
MENISCUS_API meniscus_result meniscus_session_dropped(const meniscus_session* session, uint64_t* frames);

/* options: the settings, which are those that the surfaces are made with, and those of the session, as for
 * meniscus_session_open(); of the publisher: codec (of the bricks: packed, the default and the fastest, or entropy, the
 * smallest), normal-bits, attribute-bits (default 8), waiting-limit, policy, nth, reconnect; parts (publishers of the
 * session with this id that each have some of the bricks of every frame; no brick has two owners), part, run. A session
 * takes particles or surfaces, and not both. Where the server has tokens, this needs one of the role publisher. */
MENISCUS_API meniscus_result meniscus_publisher_open(meniscus_client* client, const meniscus_options* options,
                                                     meniscus_publisher** publisher);
/* Ends publisher and session as meniscus_session_destroy() does. */
MENISCUS_API void meniscus_publisher_destroy(meniscus_publisher* publisher);
/* Lets the session live on, as meniscus_session_leave() does. */
MENISCUS_API meniscus_result meniscus_publisher_leave(meniscus_publisher* publisher);
/* The session's id, for watchers. Valid as long as the publisher; NULL for NULL. */
MENISCUS_API const char* meniscus_publisher_session_id(const meniscus_publisher* publisher);
/* Publishes a mesh of meniscus_reconstruct(), of a reconstructor with the option keep-lattice, with its spray, its
 * attributes and its figures: the bricks are encoded here. Waits while the server does not take more. That the surface
 * is closed is the caller's promise. `index`, refusals and threads are those of meniscus_session_push(). */
MENISCUS_API meniscus_result meniscus_publisher_push(meniscus_publisher* publisher, const meniscus_mesh* mesh,
                                                     uint64_t index, double simulation_time);
/* Publishes the bricks from `lowest` to `highest`, x y z, both of them among these, of a mesh that reaches farther,
 * such as that of a rank with particles of its neighbors: with parts, the boxes of all publishers cover the surface,
 * and no brick is in two of them. The brick (x, y, z) covers the world from (x, y, z) to (x + 1, y + 1, z + 1) times
 * its edge, which is 64 times cell-size times particle-radius; INT32_MIN and INT32_MAX stand for no end. With the
 * default settings, the bricks of a box are those of the whole frame where the mesh was made of all particles within 27
 * radii of the box (core/README.md#parts-of-a-frame has the rule). Counts of the mesh and the volume are those of the
 * box; figures of the particles and of the work stay the mesh's. Attributes of float32 want the option attribute-bits
 * set to 0, since all parts round over one range. Since 0.2. */
MENISCUS_API meniscus_result meniscus_publisher_push_box(meniscus_publisher* publisher, const meniscus_mesh* mesh,
                                                         const int32_t lowest[3], const int32_t highest[3],
                                                         uint64_t index, double simulation_time);
/* No more surfaces will be pushed; next() then ends after the last one. */
MENISCUS_API meniscus_result meniscus_publisher_finish(meniscus_publisher* publisher);
/* Waits as meniscus_session_next() does, for the answer that watchers have the next frame: index, time and figures. */
MENISCUS_API meniscus_result meniscus_publisher_next(meniscus_publisher* publisher, double timeout_seconds,
                                                     meniscus_frame** frame);
/* Ends it at once, as meniscus_session_cancel() does. */
MENISCUS_API meniscus_result meniscus_publisher_cancel(meniscus_publisher* publisher);
/* Frames that the policy has left out so far. */
MENISCUS_API meniscus_result meniscus_publisher_dropped(const meniscus_publisher* publisher, uint64_t* frames);

/* options: max-level (1 to 3), normal-bits (2 to 16, 0 for none), normals-by (as above), position-bits, codec (as
 * above), region ("X0 Y0 Z0 X1 Y1 Z1", world units), spray (true or false: whether the particles that the surface
 * leaves out come beside it), bytes-per-second, viewpoint ("X Y Z"), reconnect (seconds), attribute (those of the
 * session's attributes that the meshes have: names with spaces between them, or all; default: none), attribute-bits (as
 * above). */
MENISCUS_API meniscus_result meniscus_watcher_open(meniscus_client* client, const char* session_id,
                                                   const meniscus_options* options, meniscus_watcher** watcher);
MENISCUS_API void meniscus_watcher_destroy(meniscus_watcher* watcher);
/* Waits as meniscus_session_next() does; MENISCUS_ENDED once the session has ended, or the watcher was canceled. */
MENISCUS_API meniscus_result meniscus_watcher_next(meniscus_watcher* watcher, double timeout_seconds,
                                                   meniscus_frame** frame);
/* Ends a next() that waits in another thread. */
MENISCUS_API meniscus_result meniscus_watcher_cancel(meniscus_watcher* watcher);

MENISCUS_API void meniscus_frame_destroy(meniscus_frame* frame);
/* The frame's index and time, as they were pushed. */
MENISCUS_API meniscus_result meniscus_frame_index(const meniscus_frame* frame, uint64_t* index);
MENISCUS_API meniscus_result meniscus_frame_simulation_time(const meniscus_frame* frame, double* seconds);
/* Fills the mesh: decodes and welds what was received, which takes a while. */
MENISCUS_API meniscus_result meniscus_frame_mesh(const meniscus_frame* frame, meniscus_mesh* mesh);
/* The figures of the frame as the server has reconstructed it. */
MENISCUS_API meniscus_result meniscus_frame_statistics(const meniscus_frame* frame, meniscus_statistics* statistics);

/* ---- Many processes that make one surface ----------------------------------------------------------------------- */

/* The processes of a job, its ranks, that reconstruct each frame of their simulation together and publish it to a
 * server, or write it to files. For MPI, meniscus/mpi.h makes it; all of this is since 0.2. */
typedef struct meniscus_parts meniscus_parts;

/* How the ranks exchange bytes. The functions are called within meniscus_parts_open(), _push() and _free() alone, by
 * all ranks in the same order, on the threads that call these; each returns 0, or another number where it has failed.
 */
typedef struct meniscus_exchange {
    size_t struct_size;  /* sizeof(meniscus_exchange) */
    uint32_t rank;       /* the number of this process, from 0 */
    uint32_t ranks;      /* the number of processes */
    uint32_t leads_node; /* 1 in one rank of each machine, else 0 */
    void* context;       /* for the functions */
    /* Writes the bytes of all to `all`, one rank's after the other's. sizes: of each, the same in all ranks; together
     * at most 2^31 - 1. */
    int (*gather)(void* context, const void* mine, const size_t* sizes, void* all);
    /* Writes to from[i] the number that rank i has in to[this rank]. */
    int (*trade_sizes)(void* context, const uint64_t* to, uint64_t* from);
    /* Writes to from[i] the bytes that rank i has in to[this rank], but for this rank's own; any number of bytes. */
    int (*trade)(void* context, const void* const* to, const uint64_t* to_sizes, void* const* from,
                 const uint64_t* from_sizes);
    void (*release)(void* context); /* called last by meniscus_parts_free(), not where meniscus_parts_open() fails; may
                                       be NULL */
} meniscus_exchange;

/* Called by all ranks together with the same options, but for the server, the connection and the backend; opens the
 * session. options: server (HOST:PORT), those of meniscus_client_connect(), of meniscus_reconstructor_create() and of
 * meniscus_publisher_open() but nth, parts, part and run; reconstruct-ranks (the ranks that reconstruct and publish:
 * node, the default, is one of each machine; all; or a number of them), overlap (base cells, default 4), policy (of
 * frames that come while one is being reconstructed: latest, the default, leaves them out; every-frame waits). A frame
 * has at most 256 publishers. A rank that fails makes all fail, here and below; the message names it.
 *
 * output, in place of server and of what is set for it: a folder that the ranks that reconstruct share. It gets
 * surface-FRAME-part-PART.vtp of each of them, and surface.pvd, which lists the frames that are there whole: by their
 * times where these increase, else by their numbers. A folder that has a list is refused. */
MENISCUS_API meniscus_result meniscus_parts_open(const meniscus_exchange* exchange, const meniscus_options* options,
                                                 meniscus_parts** parts);
/* Called by all ranks together. particles: those that this rank owns, wherever they are, also none; each particle of
 * the frame is owned by one rank. They are copied and brought to the ranks that reconstruct: with the policy
 * every-frame by this push, with latest by the next one, for which threads choose them meanwhile. Threads reconstruct
 * between the calls. The push after that publishes the frame, once the parts' surfaces are known to meet. step and
 * time: of the frame, the same in all ranks; step is greater than the one before.
 *
 * MENISCUS_WOULD_WAIT: the frame is left out, by all ranks. An error: it is left out, too, and the next may be pushed.
 * While the server is away frames are left out; that is told once, as MENISCUS_UNAVAILABLE, and once for each attempt
 * to open the session again: 1, 2, 4 and at last 30 seconds lie between these. So it is where files cannot be written,
 * which is MENISCUS_UNKNOWN. */
MENISCUS_API meniscus_result meniscus_parts_push(meniscus_parts* parts, const meniscus_particles* particles,
                                                 uint64_t step, double time);
/* Called by all ranks together: waits until the last frame is shown or listed, and ends the session if this job has
 * made it. An error says what became of the last frames; `parts` is gone in any case. */
MENISCUS_API meniscus_result meniscus_parts_free(meniscus_parts* parts);
/* The session's id, for watchers; empty where files are written. Valid as long as `parts`; NULL for NULL. */
MENISCUS_API const char* meniscus_parts_session_id(const meniscus_parts* parts);
/* Frames left out so far, but for those that were refused. */
MENISCUS_API meniscus_result meniscus_parts_dropped(const meniscus_parts* parts, uint64_t* frames);

#ifdef __cplusplus
}
#endif

#endif /* MENISCUS_MENISCUS_H */
