#include "cli/surfaces/surfaces.hpp"

#include <CLI/CLI.hpp>
#include <string>
#include <utility>

#include "cli/options/attribute_bits.hpp"
#include "cli/options/codec_option.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/normal_bits.hpp"
#include "cli/options/normals_by.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/policy_options.hpp"
#include "cli/surfaces/local_surfaces.hpp"
#include "cli/surfaces/parts_surfaces.hpp"
#include "cli/surfaces/server_surfaces.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {

Surface::Surface(Mesh& mesh, client::FrameStatistics statistics, std::uint64_t index, double simulation_time,
                 const CodingOptions& coding)
    : index_(index),
      simulation_time_(simulation_time),
      statistics_(std::move(statistics)),
      coding_(coding),
      mesh_(&mesh) {}

Surface::Surface(const client::ReceivedFrame& received)
    : index_(received.index),
      simulation_time_(received.simulation_time),
      statistics_(received.statistics),
      received_(&received) {}

const Mesh& Surface::mesh() const {
    if (mesh_ != nullptr) return *mesh_;
    if (!decoded_) decoded_ = received_->mesh();
    return *decoded_;
}

Mesh Surface::take_mesh() {
    if (mesh_ != nullptr) return std::move(*mesh_);
    mesh();
    return std::move(*std::exchange(decoded_, std::nullopt));
}

std::span<const Point> Surface::spray() const {
    if (mesh_ != nullptr) return mesh_->spray;
    return received_->spray;
}

const client::ReceivedFrame& Surface::encoded() const {
    if (received_ != nullptr) return *received_;
    if (!encoded_) encoded_ = client::encode_frame(*mesh_, statistics_, index_, simulation_time_, coding_);
    return *encoded_;
}

CLI::Option* add_backend_option(CLI::App& command, Backend& backend) {
    return add_named_option(command, "--backend", backend, "Backend of this process; auto: a GPU if one can be used");
}

void SurfacesOptions::add_to(CLI::App& command) {
    const OptionGroup group(command, place_heading);
    auto* here = command.add_flag("--local", local, "Reconstruct in this process (the default)");
    auto* backend_option = add_backend_option(command, backend.backend);
    auto* threads =
        command.add_option("--threads", backend.threads, "Worker threads of this process; 0: one per processor")
            ->check(CLI::Range(0U, max_threads))
            ->capture_default_str();
    {
        const OptionGroup surface(command, surface_heading);
        add_normal_bits(command, normal_bits, " (default: 8 from a server, unrounded in this process)");
        add_normals_by(command, stream.normals_by);
        add_attribute_bits(command, attribute_bits);
        add_codec(command, codec, "packed from a server on this machine, entropy from others and in files of bricks");
    }
    auto* there = server.add_to(command, "Reconstruct on this meniscusd")->excludes(here);
    for (CLI::Option* option : {backend_option, threads}) option->excludes(there);
    session.add_to(command, *there);
    add_stream_options(command, stream, *there);
}

std::unique_ptr<Surfaces> SurfacesOptions::open(const Settings& settings, Surfaces::Handler handler) const {
    if (!settings.normals && normal_bits.value_or(0) != 0)
        throw InvalidInput("--normal-bits " + std::to_string(*normal_bits) +
                           " is of normals, and --no-normals leaves them out: give one of the two");
    check_normals_by(stream.normals_by, normal_bits, bricks);
    if (server.address.empty()) {
        if (codec && !bricks)
            throw InvalidInput(
                "--codec is of meshes from a server and of files of bricks: give --server, or leave it out");
        const Codec of_files = codec.value_or(Codec::lattice_entropy);
        BackendOptions here = backend;
        here.keep_lattice = bricks && needs_lattice(of_files);
        const LocalCoding coding{stream.normals_by, normal_bits, attribute_bits, of_files};
        if (parts > 1)
            return std::make_unique<PartsSurfaces>(settings, here, parts, coding, bricks, std::move(handler));
        return std::make_unique<LocalSurfaces>(settings, here, coding, only_one, std::move(handler));
    }
    client::StreamOptions options = stream;
    if (normal_bits) options.normal_bits = *normal_bits;
    options.codec = codec;
    if (!codec && bricks) options.codec = Codec::lattice_entropy;
    options.attributes = {{.name = {}, .bits = attribute_bits}};
    return std::make_unique<ServerSurfaces>(server, session, settings, options, std::move(handler));
}

}  // namespace meniscus::cli
