// Surfaces that were made here, for a session's watchers.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_box.hpp"
#include "meniscus/client/next.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/client/reconnect_event.hpp"
#include "meniscus/client/stream.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::client {

class Connection;
class MadeSessions;

struct PublisherOptions {
    // How push() encodes a mesh. Receivers that ask for this form are sent the bricks as they are, others what the
    // server makes of them.

    Codec codec = Codec::lattice_packed;  ///< or lattice_entropy: fewer bytes, more time here
    int normal_bits = 8;                  ///< 2 to 16; where the session's settings ask for no normals, there are none
    int attribute_bits = default_attribute_bits;  ///< of float32, 1 to 16, or 0 for exact values

    // As in StreamOptions.

    std::size_t waiting_limit = 0;
    UploadPolicy policy = UploadPolicy::every_frame;
    std::uint32_t nth = 1;
    /// Publishers, of this and of other processes, that each have some of the bricks of every frame.
    std::uint32_t parts = 1;
    std::uint32_t part = 0;
    std::uint64_t run = 0;
    std::chrono::milliseconds reconnect{0};
    std::chrono::milliseconds route_check{2000};
    ReconnectHandler on_reconnect{};
    std::stop_token stop{};

    /// The options that C and Python set by name.
    template <class Visit>
    static void rows(const Visit& visit) {
        using P = PublisherOptions;
        visit("codec", &P::codec, {.help = "codec of the bricks: packed, the fastest, or entropy, the smallest"});
        visit("normal_bits", &P::normal_bits,
              {.help = "bits per component of the normals, 2 to 16; 0: no normals", .range = {.least = 0.0}});
        upload_rows<P>(visit);
    }
};

/// Publishes surfaces, in order, to a session that no particles come to. The session's settings are those that the
/// surfaces were made with. That they are closed is the caller's promise. Threads as of Stream: push() and finish()
/// belong to one, next() to one (other), cancel() and dropped() to any.
///
/// push() and next() throw InvalidInput and LimitExceeded, as the server answered, or ServerError.
class Publisher {
public:
    Publisher(Publisher&&) noexcept;
    Publisher& operator=(Publisher&&) noexcept;
    ~Publisher();  ///< cancels what is in flight

    /// Publishes a surface of Reconstructor::reconstruct(), which has kept its lattice (BackendOptions::keep_lattice),
    /// with its spray and all of its attributes. `index` is greater than the one before. Blocks as Stream::push() does.
    /// own: with `parts`, the bricks that this one publishes of a mesh that reaches farther, such as that of a rank
    /// with the particles of its neighbors within halo(settings) around these bricks. The boxes of all parts cover
    /// the surface, and no brick is in two of them; part_of() says what becomes of the statistics. Throws InvalidInput,
    /// too, for a mesh without its lattice.
    void push(const Mesh& mesh, const Statistics& statistics, std::uint64_t index, double simulation_time,
              const BrickBox& own = all_bricks);
    /// Publishes bricks that are encoded: a whole frame, or those that this part has. Bricks carry all attributes that
    /// the frame has. With `parts`: the statistics are those of this part, a vertex on the border of two parts counts
    /// in one of them, and coded_attributes, which are the same in all parts, hold the values of the whole frame.
    void push(const ReceivedFrame& frame);

    /// No more frames will come; next() then ends after the last one.
    void finish();
    /// Waits for the next answer: a frame without its mesh, which watchers have; none when all is answered, or after
    /// cancel().
    std::optional<ReceivedFrame> next();
    /// Likewise, no longer than the timeout.
    Next<ReceivedFrame> next(std::chrono::milliseconds timeout);
    /// Ends it at once. Frames without an answer are lost.
    void cancel();
    /// Frames dropped by the policy so far.
    std::uint64_t dropped() const;

private:
    friend class Client;
    friend class Session;
    Publisher(std::shared_ptr<Connection> connection, const std::string& session_id, const PublisherOptions& options,
              std::shared_ptr<MadeSessions> made = nullptr);
    CodingOptions coding_;  ///< but for the attributes
    std::vector<AttributeWish> wishes_;
    std::shared_ptr<Stream::Impl> impl_;  ///< shared with its threads
};

}  // namespace meniscus::client
