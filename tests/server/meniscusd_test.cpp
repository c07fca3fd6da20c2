// The program: its flags, its signals, its exit codes.
#include <grpc/grpc.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "meniscus/client/client.hpp"
#include "observation/metrics.hpp"
#include "process.hpp"
#include "test_folder.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

std::size_t bytes_of(pid_t pid, const std::string& field) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/status");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(field)) return std::stoul(line.substr(field.size())) << 10U;
    return 0;
}

/// Without those of files.
std::size_t resident_bytes(pid_t pid) {
    return bytes_of(pid, "RssAnon:");
}

/// The most that has been resident. The kernel sums counters of its processors: a later value may be a few pages less.
std::size_t peak_bytes(pid_t pid) {
    return bytes_of(pid, "VmHWM:");
}

TEST(Meniscusd, EndsWellOnSigtermAndSigint) {
    for (const int number : {SIGTERM, SIGINT}) {
        Process process(on_free_port());
        const std::string address = process.address();
        client::Client client(address);
        EXPECT_EQ(client.server_info().threads, 2U);
        process.signal(number);
        EXPECT_NE(process.rest().find("stopped"), std::string::npos);
        EXPECT_EQ(process.exit_code(), 0);
    }
}

TEST(Meniscusd, AnswersTheFramesInFlightOnSigterm) {
    Process process(on_free_port());
    client::Client client(process.address());
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto stream = client.stream(id);
    const Particles particles = wave(16, 0.0);
    stream.push(particles.view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    stream.push(particles.view(), 1, 0.0);
    while (client.session(id).frames < 2) {
    }
    process.signal(SIGTERM);
    const auto frame = stream.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
    EXPECT_THROW(stream.next(), client::ServerError);
    process.rest();
    EXPECT_EQ(process.exit_code(), 0);
}

TEST(Meniscusd, LosesNoFrameAndAnswersNoneTwiceWhenItIsKilledAndStartedAgain) {
    auto process = std::make_unique<Process>(on_free_port());
    const std::string address = process->address();
    client::Client client(address);
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto stream = client.stream(id, {.reconnect = std::chrono::seconds(60)});
    constexpr std::uint64_t count = 30;
    std::thread pusher([&] {
        for (std::uint64_t i = 0; i < count; ++i) stream.push(wave(12, static_cast<double>(i)).view(), i, 0.0);
        stream.finish();
    });
    std::uint64_t received = 0;
    int kills = 0;
    auto killed_at = std::chrono::steady_clock::now();
    double slowest = 0.0;  // seconds from a kill to the next answer
    while (const auto frame = stream.next()) {
        const std::chrono::duration<double> since = std::chrono::steady_clock::now() - killed_at;
        if (frame->index == 6 || frame->index == 18) slowest = std::max(slowest, since.count());
        EXPECT_EQ(frame->index, received++);
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(wave(12, static_cast<double>(frame->index))));
        if (frame->index != 5 && frame->index != 17) continue;
        ++kills;
        killed_at = std::chrono::steady_clock::now();
        process->signal(SIGKILL);
        EXPECT_EQ(process->exit_code(), 128 + SIGKILL);
        process = std::make_unique<Process>(std::vector<std::string>{"--listen", address, "--threads", "2"});
        process->address();
    }
    pusher.join();
    EXPECT_EQ(received, count);
    std::printf("killed %d times: %llu of %llu frames, each once and right; the next one after %.2f s at most\n", kills,
                static_cast<unsigned long long>(received), static_cast<unsigned long long>(count), slowest);
}

TEST(Meniscusd, EndsWellWithAClientThatNeverReads) {
    Process process(on_free_port({"--shutdown-grace", "0.5"}));
    client::Client client(process.address());
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto watcher = client.watch(id);
    auto stream = client.stream(id, {.receive_meshes = false});
    const Particles particles = spray(12);
    Particles moved = particles;
    for (float& p : moved.positions) p += 0.03F;
    for (std::uint64_t i = 0; i < 60; ++i) stream.push((i % 2 == 0 ? particles : moved).view(), i, 0.0);
    stream.finish();
    while (stream.next()) {
    }
    process.signal(SIGTERM);
    process.rest();
    EXPECT_EQ(process.exit_code(), 0);
}

// Whose simulators have their answers: a client that only watches, and has stopped reading, is owed nothing.
TEST(Meniscusd, EndsWithItsWorkThoughWatchersHaveStoppedReadingOrVanished) {
    Process process(on_free_port({"--shutdown-grace", "60"}));
    const std::string address = process.address();
    client::Client client(address);
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    std::vector<client::Watcher> stalled;
    stalled.reserve(6);
    for (int i = 0; i < 6; ++i) stalled.push_back(client.watch(id));
    auto gone = std::make_unique<client::Client>(address);
    auto vanished = std::make_unique<client::Watcher>(gone->watch(id));
    auto stream = client.stream(id, {.receive_meshes = false});
    const Particles particles = spray(12);
    Particles moved = particles;
    for (float& p : moved.positions) p += 0.03F;
    for (std::uint64_t i = 0; i < 60; ++i) {
        stream.push((i % 2 == 0 ? particles : moved).view(), i, 0.0);
        if (i == 30) vanished.reset();
    }
    stream.finish();
    while (stream.next()) {
    }
    const auto begin = std::chrono::steady_clock::now();
    process.signal(SIGTERM);
    const std::string log = process.rest();
    EXPECT_EQ(process.exit_code(), 0);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    std::printf("ended %.2f s after SIGTERM\n", taken.count());
    EXPECT_LT(taken.count(), 5.0);
    EXPECT_EQ(log.find("unfinished"), std::string::npos) << log;
}

/// Calls with one message of 64 MiB of zeros.
class Bomber {
public:
    explicit Bomber(const std::string& address) : stub_(channel(address)) {}

    grpc::StatusCode throw_at(const std::string& method, grpc_compression_algorithm algorithm) {
        grpc::ClientContext context;
        context.set_compression_algorithm(algorithm);
        const grpc::Slice slice(zeros_.data(), zeros_.size(), grpc::Slice::STATIC_SLICE);
        const grpc::ByteBuffer bomb(&slice, 1);
        std::promise<grpc::Status> status;
        grpc::ByteBuffer answer;
        stub_.UnaryCall(&context, method, grpc::StubOptions(), &bomb, &answer,
                        [&](grpc::Status s) { status.set_value(std::move(s)); });
        return status.get_future().get().error_code();
    }

private:
    static std::shared_ptr<grpc::Channel> channel(const std::string& address) {
        // Never undone: the last object's end would wait for gRPC's threads, up to ten seconds.
        static const bool kept = (grpc_init(), true);
        static_cast<void>(kept);
        grpc::ChannelArguments arguments;
        arguments.SetMaxSendMessageSize(-1);
        return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
    }

    const std::vector<char> zeros_ = std::vector<char>(std::size_t{64} << 20U);
    grpc::GenericStub stub_;
};

TEST(Meniscusd, DecompressesNothing) {
    Process process(on_free_port());
    Bomber bomber(process.address());
    const std::size_t before = peak_bytes(process.pid());
    for (const auto algorithm : {GRPC_COMPRESS_GZIP, GRPC_COMPRESS_DEFLATE})
        for (const char* method : {"/meniscus.v1.SessionService/ListSessions", "/meniscus.v1.SurfaceService/Watch",
                                   "/grpc.health.v1.Health/Check"})
            EXPECT_EQ(bomber.throw_at(method, algorithm), grpc::StatusCode::UNIMPLEMENTED) << method;
    EXPECT_LT(peak_bytes(process.pid()), before + (std::size_t{16} << 20U));
    process.signal(SIGTERM);
    const std::string log = process.rest();
    EXPECT_EQ(log.find("ompression"), std::string::npos) << log;
    EXPECT_EQ(process.exit_code(), 0);
}

TEST(Meniscusd, GivesTheSystemBackWhatIdleSessionsGiveBack) {
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "the address sanitizer keeps what is freed, to see who reads it";
#endif
    Process process(on_free_port({"--idle-buffers", "0.2"}));
    client::Client client(process.address());
    Settings large = settings();
    large.cell_size = 0.25;
    large.mode = Mode::uniform;
    const Particles particles = wave(24, 0.0);
    constexpr std::size_t megabyte = std::size_t{1} << 20U;
    const std::size_t before = resident_bytes(process.pid());
    // One after the other: the arrays of those before could be in the way.
    for (int i = 0; i < 4; ++i) {
        const std::string id = client::new_session_id();
        client.create_session(id, large);
        client::Stream stream = client.stream(id, {.receive_meshes = false});
        stream.push(particles.view(), 0, 0.0);
        ASSERT_TRUE(stream.next());
    }
    EXPECT_GT(peak_bytes(process.pid()), before + 60 * megabyte) << "there is something to give back";
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (resident_bytes(process.pid()) > before + 15 * megabyte && std::chrono::steady_clock::now() < deadline)
        std::this_thread::yield();
    EXPECT_LT(resident_bytes(process.pid()), before + 15 * megabyte);
}

/// The bytes by which a server's memory grows for a call of a caller without a token, with a message of 64 MiB that the
/// server would take.
std::size_t growth_without_token(const std::string& method, grpc::StatusCode code) {
    const TestFolder folder;
    Process process(on_free_port({"--tokens", folder.write("tokens", "admin root token-of-root-0123456789\n"),
                                  "--record", folder / "recordings", "--max-message-bytes", "65M"}));
    Bomber bomber(process.address());
    const std::size_t before = peak_bytes(process.pid());
    EXPECT_EQ(bomber.throw_at(method, GRPC_COMPRESS_NONE), code) << method;
    const std::size_t after = peak_bytes(process.pid());
    process.signal(SIGTERM);
    process.rest();
    EXPECT_EQ(process.exit_code(), 0);
    return std::max(after, before) - before;
}

TEST(Meniscusd, ReceivesNoMessageBeforeTheTokenIsKnown) {
    constexpr std::size_t window = std::size_t{16} << 20U;
    const auto expect = [&](const std::string& method, grpc::StatusCode code) {
        // HTTP/2's window may be open wide before the refusal has arrived, as the threads' turns have it. A message
        // that is received is there each time.
        std::size_t growth = growth_without_token(method, code);
        for (int others = 0; others < 4 && growth >= window; ++others)
            growth = std::min(growth, growth_without_token(method, code));
        EXPECT_LT(growth, window) << method;
    };
    for (const char* method :
         {"ServerService/GetServerInfo", "SessionService/CreateSession", "SessionService/GetSession",
          "SessionService/ListSessions", "SessionService/DeleteSession", "SurfaceService/Stream",
          "SurfaceService/Watch", "SurfaceService/WatchParticles", "RecordingService/ListRecordings",
          "RecordingService/ReadRecording", "RecordingService/DeleteRecording"})
        expect(std::string("/meniscus.v1.") + method, grpc::StatusCode::UNAUTHENTICATED);
    expect("/grpc.health.v1.Health/Check", grpc::StatusCode::OK);
    expect("/meniscus.v1.SessionService/NoCall", grpc::StatusCode::UNIMPLEMENTED);
}

TEST(Meniscusd, DoesNotWaitForAReconstructionThatOutlivesTheGracePeriod) {
    Process process(on_free_port({"--shutdown-grace", "0.2", "--http", "127.0.0.1:0"}));
    client::Client client(process.address());
    const std::string http = process.http_address();
    const std::string id = client::new_session_id();
    Settings fine = settings();
    fine.cell_size = 0.1;
    client.create_session(id, fine);
    auto stream = client.stream(id);
    const Particles minutes = spray(60);
    stream.push(minutes.view(), 0, 0.0);
    scrape_until(http, "meniscus_upload_bytes_total", 12.0 * static_cast<double>(minutes.view().count()));
    process.signal(SIGTERM);
    // When its call is canceled the frame is stopped, which may or may not be before the grace period's end.
    const std::string log = process.rest();
    EXPECT_TRUE(log.find("the reconstruction of frame 0 of session " + id + " was left unfinished") != log.npos ||
                log.find("session " + id + ", frame 0: stopped") != log.npos)
        << log;
    EXPECT_EQ(process.exit_code(), 0);
}

/// All of it is this machine's; other tests have other processes.
std::string own_loopback_address() {
    const auto pid = static_cast<unsigned>(::getpid());
    return "127." + std::to_string(1 + pid / 65536 % 254) + "." + std::to_string(pid / 256 % 256) + "." +
           std::to_string(pid % 256);
}

TEST(Meniscusd, ServesAViewerOnLoopbackUnaskedBesideAnotherToo) {
    const std::vector<std::string> flags{"--listen", own_loopback_address() + ":0", "--threads", "1"};
    Process first(flags);
    first.address();
    const std::string http = first.http_address();
    EXPECT_EQ(http, own_loopback_address() + ":9464");
    Process second(flags);
    second.address();
    const std::string other = second.http_address();
    EXPECT_NE(other, http);
    EXPECT_TRUE(other.starts_with(own_loopback_address() + ":")) << other;
    for (const std::string& address : {http, other}) EXPECT_EQ(http_get(address, "/readyz").status, 200) << address;
}

TEST(Meniscusd, ServesNoViewerWhereNobodyAskedAndOthersCouldComeOrItIsOff) {
    const TestFolder folder;
    for (const std::vector<std::string>& flags :
         {std::vector<std::string>{"--listen", "unix:" + (folder / "socket")},
          {"--listen", "0.0.0.0:0", "--insecure"},
          {"--listen", "127.0.0.1:0", "--http", "off"},
          {"--listen", "127.0.0.1:0", "--config", folder.write("config", "http =\n")}}) {
        Process process(flags);
        process.address();
        process.signal(SIGTERM);
        const std::string log = process.rest();
        EXPECT_EQ(log.find("http"), std::string::npos) << log;
        EXPECT_EQ(process.exit_code(), 0);
    }
}

TEST(Meniscusd, RefusesWrongFlagsInOneLine) {
    const std::vector<std::vector<std::string>> wrong{
        {"--nonsense"},
        {"--threads", "many"},
        {"--backend", "abacus"},
        {"--memory-limit", "4X"},
        {"--device-memory-limit", "4X"},
        {"--devices", "0,two"},
        {"--devices", "-1"},
        {"--devices", "1000"},
        {"--backend", "cpu", "--devices", "0"},
        {"--max-sessions", "-1"},
        {"--max-message-bytes", "1M"},
        {"--max-idle", "-1"},
        {"--max-idle", "nan"},
        {"--shutdown-grace", "inf"},
        {"--memory-limit", "-5"},
        {"--memory-limit", "99999999999G"},
        {"--max-bytes-in-flight", "99999999999999999999"},
        {"--record-limit", ""},
        {"--max-particles", "99999999999999999999"},
        {"--max-connections", "-1"},
        {"--trusted-proxies", "10.0.0.0/99"},
        {"--web-frame-ancestors", "https://a.example,*"},
        {"--config", "/dev/zero", "--check-config"},
        {"--listen", "127.0.0.1:99999"},
        {"--listen", "127.0.0.1:0", "--http", "127.0.0.1:65536"},
        {"--listen", "127.0.0.1:0", "--http", "off", "--probes", "127.0.0.1:-1"},
        {"--log-level", "loud"},
        {"--listen"}};
    for (const auto& flags : wrong) {
        Process process(flags);
        const std::string output = process.rest();
        EXPECT_EQ(process.exit_code(), 2) << output;
        EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
        EXPECT_TRUE(output.starts_with("meniscusd: ")) << output;
    }
}

// With 1, which is worth another attempt, as systemd makes it: settings that are wrong end with 2.
TEST(Meniscusd, EndsWith1AndALineForAnAddressInUse) {
    const TestFolder folder;
    const std::string path = "unix:" + folder / "socket";
    Process first(on_free_port({"--http", "127.0.0.1:0"}));
    const std::string address = first.address();
    const std::string http = first.http_address();
    Process on_path({"--listen", path, "--threads", "1"});
    EXPECT_EQ(on_path.address(), path);
    for (const std::vector<std::string>& flags : std::vector<std::vector<std::string>>{
             {"--listen", address}, {"--listen", path}, {"--listen", "127.0.0.1:0", "--http", http}}) {
        Process second(flags);
        const std::string output = second.rest();
        EXPECT_EQ(second.exit_code(), 1) << output;
        const std::size_t refusal = output.find("meniscusd: cannot ");
        ASSERT_NE(refusal, std::string::npos) << output;
        EXPECT_EQ(std::count(output.begin() + static_cast<std::ptrdiff_t>(refusal), output.end(), '\n'), 1) << output;
        EXPECT_NE(output.find(flags.back(), refusal), std::string::npos) << output;
    }
}

TEST(Meniscusd, TakesLimitsWithUnits) {
    Process process(on_free_port({"--memory-limit",
                                  "4G",
                                  "--device-memory-limit",
                                  "2G",
                                  "--max-sessions",
                                  "5",
                                  "--max-watchers",
                                  "6",
                                  "--max-particles",
                                  "7",
                                  "--max-frame-work",
                                  "12.5",
                                  "--max-frame-seconds",
                                  "13.5",
                                  "--max-bytes-in-flight",
                                  "8M",
                                  "--max-frames-per-second",
                                  "9",
                                  "--max-chunks",
                                  "10",
                                  "--max-idle",
                                  "11.5",
                                  "--max-upload-seconds",
                                  "12.5",
                                  "--min-upload-rate",
                                  "13K",
                                  "--orphan-seconds",
                                  "14.5",
                                  "--max-sessions-per-name",
                                  "2",
                                  "--max-watchers-per-name",
                                  "3",
                                  "--max-frames-per-second-per-name",
                                  "4",
                                  "--max-bytes-in-flight-per-name",
                                  "5M",
                                  "--max-connections",
                                  "123",
                                  "--max-connections-per-peer",
                                  "45",
                                  "--max-formats",
                                  "3",
                                  "--max-recording-readers",
                                  "6",
                                  "--max-message-bytes",
                                  "2M"}));
    client::Client client(process.address());
    const client::ServerInfo info = client.server_info();
    EXPECT_EQ(info.max_bytes_per_session, std::uint64_t{4} << 30U);
    EXPECT_EQ(info.max_device_bytes_per_session, std::uint64_t{2} << 30U);
    EXPECT_EQ(info.max_sessions, 5U);
    EXPECT_EQ(info.max_watchers_per_session, 6U);
    EXPECT_EQ(info.max_particles_per_frame, 7U);
    EXPECT_EQ(info.max_frame_work, 12.5);
    EXPECT_EQ(info.max_frame_seconds, 13.5);
    EXPECT_EQ(info.max_bytes_in_flight, std::uint64_t{8} << 20U);
    EXPECT_EQ(info.max_frames_per_second, 9U);
    EXPECT_EQ(info.max_chunks_per_frame, 10U);
    EXPECT_EQ(info.max_idle_seconds, 11.5);
    EXPECT_EQ(info.max_upload_seconds, 12.5);
    EXPECT_EQ(info.min_upload_bytes_per_second, 13U << 10U);
    EXPECT_EQ(info.max_orphan_seconds, 14.5);
    EXPECT_EQ(info.max_sessions_per_name, 2U);
    EXPECT_EQ(info.max_watchers_per_name, 3U);
    EXPECT_EQ(info.max_frames_per_second_per_name, 4U);
    EXPECT_EQ(info.max_bytes_in_flight_per_name, std::uint64_t{5} << 20U);
    EXPECT_EQ(info.max_connections, 123U);
    EXPECT_EQ(info.max_connections_per_peer, 45U);
    EXPECT_EQ(info.max_formats_per_session, 3U);
    EXPECT_EQ(info.max_recording_readers, 6U);
    EXPECT_EQ(info.max_message_bytes, std::uint64_t{2} << 20U);
}

TEST(Meniscusd, TellsItsVersionAndHelp) {
    Process tells_version({"--version"});
    EXPECT_EQ(tells_version.rest(), "meniscusd " + std::string(version()) + "\n");
    EXPECT_EQ(tells_version.exit_code(), 0);
    Process help({"--help"});
    EXPECT_NE(help.rest().find("--listen"), std::string::npos);
    EXPECT_EQ(help.exit_code(), 0);
}

}  // namespace
}  // namespace meniscus::server::test
