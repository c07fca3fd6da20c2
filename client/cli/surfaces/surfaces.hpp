// Where surfaces come from: this process or a server. The commands see no difference.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "cli/options/server_flags.hpp"
#include "cli/options/session_flags.hpp"
#include "meniscus/backend_options.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/codec.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace meniscus::cli {

/// One frame's surface. Its mesh and its bricks are decoded or encoded when they are first asked for.
class Surface {
public:
    /// Reconstructed here; the mesh is borrowed, and given away if it is taken. coding: for a file of bricks.
    Surface(Mesh& mesh, client::FrameStatistics statistics, std::uint64_t index, double simulation_time,
            const CodingOptions& coding);
    /// Received from a server; borrowed.
    explicit Surface(const client::ReceivedFrame& received);

    std::uint64_t index() const { return index_; }
    double simulation_time() const { return simulation_time_; }
    const client::FrameStatistics& statistics() const { return statistics_; }
    /// Throws InvalidInput if the received bricks are not a mesh.
    const Mesh& mesh() const;
    /// The mesh, to be changed, so that none is copied: there is no mesh() afterwards.
    Mesh take_mesh();
    /// Places of the particles left out of the surface.
    std::span<const Point> spray() const;
    /// The encoded bricks, for a file of bricks.
    const client::ReceivedFrame& encoded() const;

private:
    std::uint64_t index_;
    double simulation_time_;
    client::FrameStatistics statistics_;
    CodingOptions coding_;
    Mesh* mesh_ = nullptr;
    const client::ReceivedFrame* received_ = nullptr;
    mutable std::optional<Mesh> decoded_;
    mutable std::optional<client::ReceivedFrame> encoded_;
};

/// Takes frames and hands their surfaces, in order, to a handler.
class Surfaces {
public:
    using Handler = std::function<void(Surface&)>;
    virtual ~Surfaces() = default;

    /// Submits the next frame; its index is the number of frames before it. The frame may be changed afterwards.
    /// Throws the error of this frame, of an earlier frame, or of the handler.
    virtual void submit(const ParticleFrame& frame, double simulation_time) = 0;
    /// Returns when every surface has been handled. Throws as submit() does.
    virtual void finish() = 0;
    /// The id of the session on a server; empty: there is none.
    virtual std::string session() const { return {}; }
};

/// The flag --backend: the backend of this process.
CLI::Option* add_backend_option(CLI::App& command, Backend& backend);

/// The flags --local, --backend, --threads, --normal-bits, --normals-by, --attribute-bits and --codec, and those of a
/// server, a session and a stream to it.
struct SurfacesOptions {
    bool local = false;
    ServerFlags server;              ///< no address: this process
    BackendOptions backend;          ///< of this process
    std::optional<int> normal_bits;  ///< none: unrounded here, the stream's default from a server
    int attribute_bits = 0;          ///< of float32 attributes; 0: exact
    std::optional<Codec> codec;      ///< none: the stream's default from a server, entropy in files of bricks
    SessionFlags session;            ///< on the server
    client::StreamOptions stream;    ///< to it; normals_by counts in this process, too
    bool bricks = false;             ///< no flag: whether surfaces are written as files of bricks
    std::size_t parts = 1;           ///< parts that each frame is made in, in this process; a flag of reconstruct alone
    bool only_one = false;           ///< no flag: whether a single frame is submitted, and its memory can go at once

    void add_to(CLI::App& command);
    /// The handler may be called from another thread, one call at a time. Throws InvalidInput for bits of normals that
    /// the settings leave out or a receiver makes, and for a codec where nothing is encoded.
    std::unique_ptr<Surfaces> open(const Settings& settings, Surfaces::Handler handler) const;
};

}  // namespace meniscus::cli
