#include "model/model.hpp"

#include <cuda_runtime.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/cuda/launch.hpp"
#include "gpu/kernel_names.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/mesh_download.hpp"
#include "model/gpu_constants.hpp"
#include "model/price.hpp"
#include "model/ptx_grid.hpp"
#include "report.hpp"

namespace meniscus::benchmarks {
namespace {

struct Compiled {
    std::unique_ptr<PtxProgram> program;
    KernelResources resources;
};

/// Every kernel of a folder that kernel-ptx has written, by its plain name: mangled names hold a number of each
/// compilation.
class CompiledKernels {
public:
    CompiledKernels(const std::filesystem::path& folder, const InstructionCosts& costs) {
        std::map<std::string, KernelResources> resources = read_resources(folder / "resources.csv");
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (entry.path().extension() != ".ptx") continue;
            std::ifstream in(entry.path());
            const std::string text{std::istreambuf_iterator<char>(in), {}};
            for (PtxKernel& kernel : read_ptx(text)) {
                const std::string name = plain_kernel_name(kernel.name.c_str());
                const auto found = resources.find(kernel.name);
                if (found == resources.end())
                    throw std::runtime_error("resources.csv has no row for " + kernel.name + ": run kernel-ptx again");
                kernels_[name] = {std::make_unique<PtxProgram>(std::move(kernel), costs), found->second};
            }
        }
    }
    Compiled& of(const void* kernel) {
        const std::string name = kernel_name(kernel);
        const auto found = kernels_.find(name);
        if (found == kernels_.end()) throw std::runtime_error("there is no PTX of " + name + ": run kernel-ptx again");
        return found->second;
    }

private:
    static std::map<std::string, KernelResources> read_resources(const std::filesystem::path& table) {
        std::ifstream in(table);
        if (!in)
            throw std::runtime_error("cannot read " + table.string() + ": give a folder that kernel-ptx has written");
        std::map<std::string, KernelResources> out;
        std::string line;
        std::getline(in, line);
        while (std::getline(in, line)) {
            std::replace(line.begin(), line.end(), ',', ' ');
            std::istringstream cells(line);
            std::string name;
            KernelResources resources;
            cells >> name >> resources.registers >> resources.shared_bytes >> resources.instructions;
            out[name] = resources;
        }
        return out;
    }

    std::map<std::string, Compiled> kernels_;
};

/// One launch of a frame, and what it counted.
struct Counted {
    cuda::Launch launch;
    LaunchCounts counts;
};

/// Runs kernels from their PTX while it is there, and keeps what the newest frame has launched.
class CountingDevice final : public cuda::LaunchObserver {
public:
    /// processors: the number of multiprocessors that the backend sees.
    CountingDevice(CompiledKernels& kernels, const GpuConstants& gpu, unsigned processors)
        : kernels_(kernels), gpu_(gpu) {
        runner_.processors = processors;
        runner_.run = [this](const void* kernel, unsigned blocks, unsigned threads, bool cooperative,
                             void* const* arguments) { run(kernel, blocks, threads, cooperative, arguments); };
        runner_.blocks_of_processor = [this](const void* kernel) { return static_cast<int>(occupancy(kernel)); };
        emulated_device::runner = &runner_;
        cuda::launch_observer = this;
    }
    ~CountingDevice() {
        cuda::launch_observer = nullptr;
        emulated_device::runner = nullptr;
    }
    CountingDevice(const CountingDevice&) = delete;
    CountingDevice& operator=(const CountingDevice&) = delete;

    void before(const cuda::Launch& launch) override { launches_.push_back({launch, {}}); }
    void after(const cuda::Launch&) noexcept override {}
    /// A first frame runs until it has room, again and again from its first kernel on. The last run is a warm one's.
    void keep_last_run() {
        std::size_t begin = 0;
        for (std::size_t i = 0; i < launches_.size(); ++i)
            if (launches_[i].launch.kernel == launches_[0].launch.kernel) begin = i;
        launches_.erase(launches_.begin(), launches_.begin() + static_cast<std::ptrdiff_t>(begin));
    }
    const std::vector<Counted>& launches() const { return launches_; }

private:
    unsigned occupancy(const void* kernel) {
        return blocks_of_processor(kernels_.of(kernel).resources, cuda::block_threads, gpu_);
    }
    void run(const void* kernel, unsigned blocks, unsigned threads, bool cooperative, void* const* arguments) {
        while (launches_.at(next_).launch.kind != cuda::LaunchKind::kernel) ++next_;
        Counted& counted = launches_.at(next_++);
        if (counted.launch.kernel != kernel) throw std::logic_error("kernels run in another order than launched");
        const PtxLaunch launch{blocks, threads, cooperative, occupancy(kernel)};
        counted.counts = kernels_.of(kernel).program->run(launch, arguments, gpu_);
    }

    CompiledKernels& kernels_;
    const GpuConstants& gpu_;
    emulated_device::KernelRunner runner_;
    std::vector<Counted> launches_;
    std::size_t next_ = 0;
};

void add_kernel(Row& row, const Counted& counted, double times, Compiled& compiled, const GpuConstants& gpu) {
    const LaunchCounts& c = counted.counts;
    const Price price =
        price_launch(c, times, compiled.resources, compiled.program->static_issued(), cuda::block_threads, gpu);
    row["registers"] = compiled.resources.registers;
    row["shared_bytes"] = compiled.resources.shared_bytes;
    row["warps_of_processor"] = blocks_of_processor(compiled.resources, cuda::block_threads, gpu) * cuda::block_warps;
    row["warp_instructions"] = std::round(times * c.ptx);
    row["as_compiled"] = compiled.resources.instructions / compiled.program->static_issued();
    row["lanes_in_use"] = c.ptx == 0.0 ? 0.0 : c.lanes / (32.0 * c.ptx);
    row["megabytes_asked"] = times * c.sectors * 32e-6;
    row["megabytes_missed"] = times * c.missed_sectors * 32e-6;
    row["megabytes_own"] = times * c.own_sectors * 32e-6;
    row["grid_barriers"] = c.grid_barriers;
    row["issue_us"] = price.issue;
    row["pipe_us"] = price.pipe;
    row["pipe"] = price.pipe_name;
    row["first_cache_us"] = price.memory;
    row["second_cache_us"] = price.second_cache;
    row["device_memory_us"] = price.device_memory;
    row["latency_us"] = price.latency;
    row["longest_warp_us"] = price.longest_warp;
    row["bound"] = price.bound();
    row["model_us"] = price.total();
}

/// A session's kernels for the lattice codecs, beside those that reconstruct; attributes have others.
bool is_of_packing(const std::string& kernel) {
    constexpr std::array kernels{"keep_bricks", "require_room_for_lattice", "write_bricks", "sum_words"};
    return std::ranges::find(kernels, kernel) != kernels.end();
}

/// Packs the bricks of a mesh that is on its way; returns their bytes. Throws std::runtime_error where one is not the
/// CPU's.
std::size_t pack_as_the_cpu_does(const MeshDownload& download, const Mesh& mesh, const Mesh& expected) {
    const CodingOptions options{.codec = Codec::lattice_packed};
    const auto packed = download.pack(mesh, options);
    if (packed == nullptr || mesh.bricks.size() != expected.bricks.size())
        throw std::runtime_error("the packed bricks are not the CPU's: their number");
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < mesh.bricks.size(); ++i) {
        const EncodedBrick brick = packed->bring(i);
        if (brick.data != encode_brick(expected, i, options).data)
            throw std::runtime_error("the packed bricks are not the CPU's: brick " + std::to_string(i));
        bytes += brick.data.size();
    }
    return bytes;
}

Row empty_row() {
    Row row;
    for (const char* name : {"order",
                             "kernel",
                             "registers",
                             "shared_bytes",
                             "warps_of_processor",
                             "warp_instructions",
                             "as_compiled",
                             "lanes_in_use",
                             "megabytes_asked",
                             "megabytes_missed",
                             "megabytes_own",
                             "grid_barriers",
                             "issue_us",
                             "pipe_us",
                             "pipe",
                             "first_cache_us",
                             "second_cache_us",
                             "device_memory_us",
                             "latency_us",
                             "longest_warp_us",
                             "bound",
                             "model_us"})
        row[name] = nullptr;
    return row;
}

}  // namespace

void run_model(const KernelsOptions& options) {
    if (options.ptx.empty())
        throw std::runtime_error("--model needs --ptx FOLDER, which tests/benchmarks/kernel-ptx writes");
    const std::filesystem::path tables = std::filesystem::path(MENISCUS_SOURCE_DIR) / "tests/benchmarks/model";
    const GpuConstants gpu = GpuConstants::read(tables / "gpus.csv", options.gpu);
    CompiledKernels kernels(options.ptx, InstructionCosts::read(tables / "instructions.csv"));
    setenv("MENISCUS_NO_GRAPH", "1", 1);  // launch by launch

    const std::size_t counted_particles = options.counted == 0 ? options.particles : options.counted;
    // A frame of n basins on all multiprocessors costs n times the counted basin on one n-th of them.
    const double times = static_cast<double>(options.particles) / static_cast<double>(counted_particles);
    const auto processors = static_cast<unsigned>(std::max(1.0, std::round(gpu["processors"] / times)));
    CountingDevice device(kernels, gpu, processors);
    WarmFrame frame(options, counted_particles);
    std::size_t packed_bytes = 0;
    std::size_t triangles = 0;
    frame.reconstruct_as_the_cpu_does([&](const MeshDownload& download, const Mesh& mesh, const Mesh& expected) {
        triangles = expected.triangles.size();
        if (options.packs) packed_bytes = pack_as_the_cpu_does(download, mesh, expected);
    });
    device.keep_last_run();

    GrowingTable table(options.out, "kernels-model");
    double sum = 0.0;
    double packing = 0.0;
    std::size_t order = 0;
    std::size_t launches_of_packing = 0;
    for (const Counted& counted : device.launches()) {
        Row row = empty_row();
        row["order"] = ++order;
        double us = 0.0;
        const cuda::Launch& launch = counted.launch;
        const double elements = times * static_cast<double>(launch.elements);
        const auto bytes = static_cast<double>(launch.element_bytes);
        if (launch.kind == cuda::LaunchKind::kernel) {
            row["kernel"] = kernel_name(launch.kernel);
            add_kernel(row, counted, times, kernels.of(launch.kernel), gpu);
            us = row["model_us"].get<double>();
        } else {
            const bool sorts = launch.kind == cuda::LaunchKind::sort;
            us = sorts ? price_sort(elements, bytes, launch.key_bits, gpu) : price_sum(elements, bytes, gpu);
            row["kernel"] = std::string(sorts ? "CUB sort of " : "CUB sum of ") +
                            std::to_string(static_cast<std::uint64_t>(elements)) + " x " +
                            std::to_string(launch.element_bytes) + " bytes" +
                            (sorts ? " by " + std::to_string(launch.key_bits) + " bits" : "");
            row["model_us"] = us;
        }
        if (is_of_packing(row["kernel"])) {
            packing += us;
            ++launches_of_packing;
        } else {
            sum += us;
        }
        table.add(row);
    }
    const auto add_total = [&](const char* name, double us, const char* bound = nullptr) {
        Row row = empty_row();
        row["kernel"] = name;
        if (bound != nullptr) row["bound"] = bound;
        row["model_us"] = us;
        table.add(row);
    };
    const double gaps = static_cast<double>(order - launches_of_packing) * gpu["launch_us"];
    const double kilobytes = 12e-3 * times * static_cast<double>(frame.particles());
    const double upload = kilobytes / gpu["pcie_gbs"];
    add_total("launches", sum);
    add_total("gaps", gaps);
    add_total("graph", sum + gaps);
    // A frame in pinned memory is fetched by the GPU: before the kernels if it comes alone, while the frame before is
    // worked at if it is sent ahead. Any other is copied by the host first.
    add_total("upload", upload, "bus");
    add_total("upload of memory that is not pinned", kilobytes / gpu["upload_gbs"], "host's copy");
    add_total("frame", sum + gaps + upload);
    add_total("frame sent ahead", std::max(sum + gaps, upload));
    if (options.packs) {
        // The words are zero before; hashes come down beside the frame's counts.
        const double zeros = times * static_cast<double>(packed_bytes) / (1e3 * gpu["memory_gbs"]);
        add_total("packing", packing + static_cast<double>(launches_of_packing + 1) * gpu["launch_us"] + zeros);
    }
    nlohmann::ordered_json summary;
    summary["gpu"] = options.gpu;
    summary["particles"] = times * static_cast<double>(frame.particles());
    summary["counted_particles"] = frame.particles();
    summary["counted_processors"] = processors;
    summary["triangles"] = times * static_cast<double>(triangles);
    if (options.packs) summary["packed_bytes"] = times * static_cast<double>(packed_bytes);
    summary["water"] = options.water;
    summary["field"] = options.field;
    summary["mode"] = options.mode;
    summary["cell_size"] = options.cell_size;
    table.finish(summary);
}

}  // namespace meniscus::benchmarks
