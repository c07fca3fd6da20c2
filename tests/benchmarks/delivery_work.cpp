// delivery-work PARTICLES: what a server's threads do with a frame after a GPU's last kernel, on the device in
// software, for a tool that counts instructions (delivery-instructions): the way from the mesh or its packed bricks to
// the last byte of their messages in a socket. The work of gRPC is not in it.
#include <sys/socket.h>
#include <unistd.h>
#include <valgrind/callgrind.h>

#include <array>
#include <cstddef>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pipeline/backend.hpp"
#include "sessions/sending/frame_encoder.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

/// A download whose kernels have run already: bricks are packed before anything is counted.
class AfterItsKernels final : public MeshDownload::Source {
public:
    AfterItsKernels(const MeshDownload& download, std::shared_ptr<PackedBricks> packed)
        : download_(download), packed_(std::move(packed)) {}

    void start() override { download_.start(); }
    void bring(std::size_t brick) override { download_.bring(brick); }
    void finish() override { download_.finish(); }
    std::shared_ptr<PackedBricks> pack(const CodingOptions&) override { return packed_; }
    std::vector<AttributeRange> attribute_ranges() override { return {}; }
    void abandon() noexcept override {}
    double seconds() const override { return download_.seconds(); }

private:
    const MeshDownload& download_;
    std::shared_ptr<PackedBricks> packed_;
};

/// A socket whose other end is read and forgotten.
class Socket {
public:
    Socket() {
        if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends_.data()) != 0) throw std::runtime_error("there is no socket");
        reader_ = std::thread([end = ends_[1]] {
            std::vector<char> buffer(std::size_t{1} << 20);
            while (::read(end, buffer.data(), buffer.size()) > 0) {
            }
        });
    }
    ~Socket() {
        ::close(ends_[0]);
        reader_.join();
        ::close(ends_[1]);
    }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;

    void write(const std::string& message) {
        for (std::size_t at = 0; at < message.size();) {
            const ssize_t written = ::write(ends_[0], message.data() + at, message.size() - at);
            if (written <= 0) throw std::runtime_error("the socket is broken");
            at += static_cast<std::size_t>(written);
        }
    }

private:
    std::array<int, 2> ends_{};
    std::thread reader_;
};

/// A GPU's frames, one after the other, to the messages of each codec.
class Delivery {
public:
    explicit Delivery(std::size_t particles)
        : water_(make_any_water(WaterKind::splashing, particles, radius)), scratch_(account_) {
        settings_.particle_radius = static_cast<double>(radius);
        settings_.cell_size = 1.0;
        settings_.mode = Mode::uniform;
        BackendOptions options;
        options.keep_lattice = true;
        backend_ = cuda::make_reconstruction(settings_, options, account_, account_);
    }

    /// Prints a line for each codec, if it is counted: its name, triangles and bytes.
    void send(bool is_counted) {
        server::ReconstructedFrame frame;
        frame.mesh.cell_size = world_cell_size(settings_);
        frame.mesh.offset_bits = offset_bits(settings_);
        ParticleFrame particles;
        particles.positions = water_;
        const MeshDownload download = backend_->reconstruct(particles, frame.mesh, frame.statistics);
        // Draco last: it takes the mesh down.
        for (const Codec codec : {Codec::lattice_packed, Codec::lattice_entropy, Codec::draco}) {
            server::MeshFormat format;
            format.normal_bits = 8;
            format.codec = codec;
            auto packed = download.pack(frame.mesh, {.normal_bits = format.normal_bits, .codec = codec});
            frame.download = MeshDownload(std::make_shared<AfterItsKernels>(download, std::move(packed)));
            std::size_t bytes = 0;
            const auto sink = [&](const server::SharedMessage& message) {
                socket_.write(*message);
                bytes += message->size();
            };
            CALLGRIND_ZERO_STATS;
            if (is_counted) CALLGRIND_TOGGLE_COLLECT;
            static_cast<void>(server::encode_frame(frame, format, nullptr, workers_, scratch_, sink));
            if (!is_counted) continue;
            CALLGRIND_TOGGLE_COLLECT;
            CALLGRIND_DUMP_STATS;
            std::cout << name_of(codec) << ' ' << frame.mesh.triangles.size() << ' ' << bytes << '\n';
        }
        frame.download = {};
    }

private:
    static constexpr float radius = 0.025F;

    std::vector<float> water_;
    Settings settings_;
    std::shared_ptr<MemoryAccount> account_ = std::make_shared<MemoryAccount>();
    std::unique_ptr<BackendReconstruction> backend_;
    server::WorkerPool workers_{1};
    server::ScratchPool scratch_;
    Socket socket_;
};

}  // namespace
}  // namespace meniscus::benchmarks

int main(int argc, char** argv) {
    try {
        if (argc != 2) throw std::runtime_error("usage: delivery-work PARTICLES");
        meniscus::benchmarks::Delivery delivery(std::stoul(argv[1]));
        // A first frame has the program's libraries loaded and its memory taken.
        delivery.send(false);
        delivery.send(true);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "delivery-work: " << error.what() << '\n';
        return 1;
    }
}
