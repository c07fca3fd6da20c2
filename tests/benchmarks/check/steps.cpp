#include "check/steps.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "program.hpp"

namespace meniscus::benchmarks {
namespace {

using Words = std::vector<std::string>;

/// Steps and the words that many of them share.
class StepList {
public:
    StepList(std::size_t million, std::filesystem::path folder) : million_(million), folder_(std::move(folder)) {}

    void add(const std::string& name, double seconds, const Words& words, bool is_tried_again = false) {
        steps.push_back({name, seconds, words, is_tried_again});
    }
    /// A command of this program, whose results go to a folder of the step's name.
    void add_own(const std::string& name, double seconds, const Words& words, bool is_tried_again = false) {
        Words all{this_program};
        all.insert(all.end(), words.begin(), words.end());
        all.insert(all.end(), {"--out", (folder_ / name).string()});
        add(name, seconds, all, is_tried_again);
    }
    void add_same(const std::string& name, double seconds, std::size_t particles, const Words& words) {
        Words all{"same", "--particles", std::to_string(particles), "--cell-sizes", "1"};
        all.insert(all.end(), words.begin(), words.end());
        add_own(name, seconds, all, true);
    }
    void add_kernels(const std::string& name, double seconds, std::size_t particles, const std::string& mode,
                     const Words& options = {}) {
        Words words{"kernels", "--particles", std::to_string(particles), "--mode", mode};
        words.insert(words.end(), options.begin(), options.end());
        add_own(name, seconds, words);
    }
    void add_times(double seconds, std::size_t particles) {
        const std::string n = std::to_string(particles);
        add_own("times-" + n, seconds,
                {"scaling", "--backend", "cuda", "--min-particles", n, "--max-particles", n, "--fields", "smooth",
                 "--cell-sizes", "1", "--repeats", "20", "--seconds-per-case", "2"});
    }
    void add_profile(const std::string& kernel, double seconds) {
        add("profile-" + kernel, seconds,
            {"ncu",
             "--set",
             "full",
             "--clock-control",
             "none",
             "-k",
             "regex:" + kernel,
             "-c",
             "2",
             "--profile-from-start",
             "off",
             "--force-overwrite",
             "-o",
             (folder_ / kernel).string(),
             this_program,
             "kernels",
             "--particles",
             std::to_string(million_),
             "--repeats",
             "1",
             "--out",
             (folder_ / ("profile-" + kernel)).string()});
    }
    void add_sanitizer(const std::string& tool, double seconds) {
        add(tool, seconds,
            {"compute-sanitizer", "--tool", tool, "--error-exitcode", "86", "cuda_test",
             "--gtest_filter=CudaSmall.GivesTheCpusMeshForParticleLevelsQuantizedPositionsAndDomains"});
    }

    std::vector<Step> steps;

private:
    std::size_t million_;
    std::filesystem::path folder_;
};

bool is_program(const std::filesystem::path& path) {
    return ::access(path.c_str(), X_OK) == 0 && !std::filesystem::is_directory(path);
}

}  // namespace

std::vector<Step> check_steps(std::size_t million, const std::filesystem::path& folder) {
    StepList list(million, folder);
    list.add("device", 10,
             {"nvidia-smi", "--format=csv",
              "--query-gpu=name,driver_version,memory.total,power.limit,clocks.current.sm,clocks.max.sm"});
    list.add_own("transfers", 20, {"transfers"});
    list.add("tests", 60, {"cuda_test", "--gtest_filter=-*ThousandFrames*"}, true);
    list.add_same("same-small", 30, million / 64, {"--threads", "1"});
    list.add_same("same-million", 60, million, {"--waters", "splashing", "--replays", "1", "--threads", "1"});
    list.add_own("exact", 15, {"exact", "--elements", "1000000"});
    for (const std::size_t particles : {million / 64, million / 10, million}) list.add_times(15, particles);
    list.add_kernels("kernels-uniform", 20, million, "uniform");
    list.add_kernels("kernels-adaptive", 20, million, "adaptive");
    list.add_kernels("kernels-packed", 20, million, "uniform", {"--packed"});
    list.add_kernels("kernels-packed-adaptive", 20, million, "adaptive", {"--packed"});
    list.add_kernels("kernels-small", 10, million / 64, "adaptive");
    list.add_own("delivery", 60, {"delivery", "--particles", std::to_string(million), "--meniscusd", "meniscusd"});
    for (const char* const kernel :
         {"sample_list", "place_listed", "sum_at_each_particle", "settle_band", "emit_cells"})
        list.add_profile(kernel, 30);
    list.add_same("same-threads", 30, million / 4,
                  {"--fields", "smooth", "--modes", "adaptive", "--replays", "0", "--threads", "4"});
    list.add_sanitizer("memcheck", 45);
    list.add_sanitizer("racecheck", 35);
    list.add_same("same-large", 60, 4 * million, {"--fields", "smooth", "--replays", "1", "--threads", "1"});
    list.add_own("same-rest", 600, {"same", "--threads", "1"});
    return list.steps;
}

std::string find_program(const std::string& name) {
    const std::filesystem::path own = program_path();
    if (name == this_program) return own.string();
    if (is_program(own.parent_path() / name)) return (own.parent_path() / name).string();
    const char* const path = std::getenv("PATH");
    std::istringstream folders(std::string(path != nullptr ? path : "") + ":/usr/local/cuda/bin");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (!folder.empty() && is_program(std::filesystem::path(folder) / name))
            return (std::filesystem::path(folder) / name).string();
    return {};
}

std::vector<std::string> with_paths(const std::vector<std::string>& words, std::string& missing) {
    constexpr std::array programs{this_program, "cuda_test", "meniscusd"};
    std::vector<std::string> result = words;
    for (std::size_t i = 0; i < result.size(); ++i) {
        if (i != 0 && std::ranges::find(programs, result[i]) == programs.end()) continue;
        result[i] = find_program(words[i]);
        if (result[i].empty()) {
            missing = words[i];
            return {};
        }
    }
    return result;
}

}  // namespace meniscus::benchmarks
