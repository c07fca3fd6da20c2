// meniscus-bench upload: particle bytes from a client into a session's buffer, nothing being done with them there.
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>

#include "benchmarks.hpp"
#include "meniscus/client/client.hpp"
#include "report.hpp"
#include "rpc/services/services.hpp"
#include "sessions/session/session_registry.hpp"
#include "socket_copy.hpp"
#include "warm_runs.hpp"

namespace meniscus::benchmarks {
namespace {

struct UploadOptions {
    std::size_t particles = 1'000'000;
    unsigned frames = 100;
    unsigned repeats = 5;
    double reconnect = 0.0;
    std::string out = "tests/benchmarks/results";
};

/// A server whose sessions take frames and give none of them a surface.
class IdleServer {
public:
    explicit IdleServer(const std::string& listen) {
        int port = 0;
        grpc::ServerBuilder builder;
        builder.AddListeningPort(listen, grpc::InsecureServerCredentials(), &port);
        builder.RegisterService(&session_service_);
        builder.RegisterService(&surface_service_);
        grpc_ = builder.BuildAndStart();
        address_ = listen.starts_with("unix:") ? listen : "127.0.0.1:" + std::to_string(port);
    }
    ~IdleServer() { grpc_->Shutdown(); }
    IdleServer(const IdleServer&) = delete;
    IdleServer& operator=(const IdleServer&) = delete;

    const std::string& address() const { return address_; }

private:
    server::SessionRegistry registry_{server::Limits{},
                                      BackendOptions{.backend = Backend::cpu},
                                      1,
                                      {},
                                      std::make_shared<server::Metrics>(),
                                      nullptr,
                                      [](const Settings&, const BackendOptions&) {
                                          return server::ReconstructFunctions{
                                              .reconstruct = [](const ParticleFrame&, Mesh&) { return Statistics{}; },
                                              .emit_capped = nullptr};
                                      }};
    const server::Authorizer everyone_;
    server::Refusals refusals_{std::make_shared<server::Metrics>()};
    server::ActiveCalls streams_;
    server::ActiveCalls watchers_;
    server::SessionServiceImpl session_service_{registry_, nullptr, everyone_, refusals_};
    server::SurfaceServiceImpl surface_service_{registry_, everyone_, refusals_, streams_, watchers_};
    std::unique_ptr<grpc::Server> grpc_;
    std::string address_;
};

/// Rate of particle data, over frames that are all answered.
double upload_bytes_per_second(const std::string& address, const UploadOptions& options) {
    client::Client client(address);
    const std::string id = client::new_session_id();
    Settings settings;
    settings.particle_radius = 0.1;
    client.create_session(id, settings);
    client::StreamOptions stream_options;
    stream_options.receive_meshes = false;
    stream_options.reconnect = std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * options.reconnect));
    auto stream = client.stream(id, stream_options);
    const std::vector<float> positions(3 * options.particles, 0.5F);
    ParticleFrame frame;
    frame.positions = positions;
    // The first frames find memory that nobody has touched.
    constexpr std::uint64_t warm = 6;
    for (std::uint64_t i = 0; i < warm; ++i) stream.push(frame, i, 0.0);
    for (std::uint64_t i = 0; i < warm; ++i) stream.next();
    const auto start = std::chrono::steady_clock::now();
    for (std::uint64_t i = 0; i < options.frames; ++i) stream.push(frame, warm + i, 0.0);
    stream.finish();
    while (stream.next()) {
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    client.delete_session(id);
    return static_cast<double>(frame.positions.size_bytes()) * options.frames / seconds.count();
}

Row measure(Transport transport, const UploadOptions& options) {
    const bool tcp = transport == Transport::tcp;
    const auto path = std::filesystem::temp_directory_path() / ("meniscus-bench-" + std::to_string(::getpid()));
    const IdleServer server(tcp ? "127.0.0.1:0" : "unix:" + path.string());
    const std::size_t bytes = 12 * options.particles * options.frames;
    std::vector<double> uploads;
    std::vector<double> sockets;
    for (unsigned i = 0; i < options.repeats; ++i) {  // in turn, so that both see the same machine
        uploads.push_back(upload_bytes_per_second(server.address(), options));
        sockets.push_back(socket_bytes_per_second(transport, bytes));
    }
    Row row;
    row["transport"] = tcp ? "tcp" : "unix";
    row["upload_bytes_per_second"] = median(uploads);
    row["socket_bytes_per_second"] = median(sockets);
    row["upload_over_socket"] = median(uploads) / median(sockets);
    row["best_upload_bytes_per_second"] = *std::ranges::max_element(uploads);
    return row;
}

void run_upload(const UploadOptions& options) {
    spdlog::set_level(spdlog::level::warn);
    std::cout << "transport  upload GB/s  best  plain socket GB/s  ratio\n" << std::fixed << std::setprecision(2);
    Rows rows = Rows::array();
    for (const Transport transport : {Transport::tcp, Transport::unix_socket}) {
        const Row row = measure(transport, options);
        const auto number = [&row](const char* name) { return row[name].get<double>(); };
        std::cout << std::left << std::setw(9) << row["transport"].get<std::string>() << std::right << std::setw(13)
                  << 1e-9 * number("upload_bytes_per_second") << std::setw(6)
                  << 1e-9 * number("best_upload_bytes_per_second") << std::setw(19)
                  << 1e-9 * number("socket_bytes_per_second") << std::setw(7) << number("upload_over_socket")
                  << std::endl;
        rows.push_back(row);
    }
    nlohmann::ordered_json summary;
    summary["runs"] = "client and server in one process; median of " + std::to_string(options.repeats) +
                      ", each beside a plain copy through a socket";
    summary["particles"] = options.particles;
    summary["frames"] = options.frames;
    summary["reconnect_seconds"] = options.reconnect;
    write_report(options.out, "upload", summary, rows);
}

}  // namespace

void add_upload(CLI::App& app) {
    auto options = std::make_shared<UploadOptions>();
    CLI::App& command = *app.add_subcommand(
        "upload", "Particle bytes into a session's buffer, over TCP and a Unix socket of this machine");
    command.add_option("--particles", options->particles, "Of a frame")->capture_default_str();
    command.add_option("--frames", options->frames, "Of a run")
        ->check(CLI::Range(1U, 1'000'000U))
        ->capture_default_str();
    command.add_option("--repeats", options->repeats, "Runs, of which the median counts")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command
        .add_option("--reconnect", options->reconnect,
                    "Seconds; above 0 the client keeps frames until they are answered")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_upload(*options); });
}

}  // namespace meniscus::benchmarks
