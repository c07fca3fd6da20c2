// meniscus-bench transfers: how fast memory comes up to the GPU and down, and what it takes to pin it.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "engine/cuda/device.hpp"
#include "engine/cuda/device_memory.hpp"
#include "engine/cuda/pinned_memory.hpp"
#include "gpu/gpu.hpp"
#include "meniscus/memory.hpp"
#include "report.hpp"

namespace meniscus::benchmarks {
namespace {

struct TransfersOptions {
    std::size_t bytes = 285'000'000;  ///< the mesh of a million splashing particles, uniform
    unsigned repeats = 3;
    std::string out = "transfers-results";
};

class Transfers {
public:
    explicit Transfers(const TransfersOptions& options)
        : options_(options), table_(options.out, "transfers"), device_(0, stream_.get(), account_) {
        device_.assign(options.bytes);
        stream_.synchronize();
    }

    void run() {
        Array<std::byte> memory{AccountAllocator<std::byte>(account_)};
        time("first touch", 1, [&] { memory.assign(options_.bytes, std::byte{1}); });
        for (const char* const of : {"pageable", "pinned"}) {
            if (std::string(of) == "pinned")
                time("pin", 1, [&] {
                    cuda::check(cudaHostRegister(memory.data(), memory.size(), cudaHostRegisterPortable),
                                "cudaHostRegister");
                });
            time(std::string("up ") + of, options_.repeats,
                 [&] { copy(device_.get(), memory.data(), cudaMemcpyHostToDevice); });
            time(std::string("down ") + of, options_.repeats,
                 [&] { copy(memory.data(), device_.get(), cudaMemcpyDeviceToHost); });
        }
        time("unpin", 1, [&] { cuda::check(cudaHostUnregister(memory.data()), "cudaHostUnregister"); });
        nlohmann::ordered_json summary;
        summary["device"] = cuda::device_name(0);
        table_.finish(summary);
    }

private:
    void copy(void* to, const void* from, cudaMemcpyKind kind) {
        cuda::check(cudaMemcpyAsync(to, from, options_.bytes, kind, stream_.get()), "cudaMemcpyAsync");
        stream_.synchronize();
    }
    template <class Work>
    void time(const std::string& what, unsigned repeats, const Work& work) {
        for (unsigned i = 0; i < repeats; ++i) {
            const auto begin = std::chrono::steady_clock::now();
            work();
            const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            table_.add({{"what", what},
                        {"bytes", options_.bytes},
                        {"seconds", seconds},
                        {"gigabytes_per_second", static_cast<double>(options_.bytes) / seconds * 1e-9}});
        }
    }

    const TransfersOptions& options_;
    GrowingTable table_;
    std::shared_ptr<MemoryAccount> account_ = std::make_shared<MemoryAccount>();
    cuda::Stream stream_;
    cuda::DeviceMemory device_;
};

}  // namespace

void add_transfers(CLI::App& app) {
    auto options = std::make_shared<TransfersOptions>();
    CLI::App& command = *app.add_subcommand(
        "transfers", "Copies to the GPU and back, and the time to pin memory; exit code 77 without a GPU");
    command.add_option("--bytes", options->bytes, "Of a copy")
        ->check(CLI::Range(std::size_t{65'536}, std::size_t{1} << 36U))
        ->capture_default_str();
    command.add_option("--repeats", options->repeats, "Of each copy")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] {
        require_gpu();
        Transfers(*options).run();
    });
}

}  // namespace meniscus::benchmarks
