// meniscus-bench check: all that a first run on a GPU shall find out, in a few minutes and one file.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "check/command.hpp"
#include "check/steps.hpp"
#include "gpu/gpu.hpp"
#include "gpu/time_budget.hpp"
#include "meniscus/error.hpp"
#include "program.hpp"
#include "report.hpp"

namespace meniscus::benchmarks {
namespace {

namespace fs = std::filesystem;

struct CheckOptions {
    std::string out = "check-results";
    double seconds = 540.0;
    std::size_t particles = 64 * 16'000;
    std::vector<std::string> only;
    bool is_list = false;
};

/// A result that is larger is left out: it would not come home.
constexpr std::uintmax_t most_result_bytes = 15'000'000;

/// Ways in which a step that hangs or fails runs once more: they tell whose fault it is.
const std::vector<std::pair<std::string, std::string>> other_ways{{"MENISCUS_NO_GRAPH", "1"},
                                                                  {"MENISCUS_COOPERATIVE_BLOCKS", "1"}};

class Check {
public:
    Check(const CheckOptions& options, const CLI::App& app)
        : options_(options), app_(app), table_(options.out, "check"), budget_(options.seconds) {}

    void run() {
        for (const Step& step : chosen_steps()) perform(step);
        nlohmann::ordered_json summary;
        summary["seconds"] = budget_.elapsed();
        summary["failed"] = failed_;
        summary["interrupted"] = is_asked_to_end();
        table_.finish(summary);
        std::cout << "results: " << pack() << '\n';
        if (failed_ != 0) throw std::runtime_error(std::to_string(failed_) + " steps have failed or were cut off");
    }

private:
    std::vector<Step> chosen_steps() const {
        std::vector<Step> steps = check_steps(options_.particles, fs::absolute(options_.out));
        for (const std::string& name : options_.only)
            if (std::ranges::find(steps, name, &Step::name) == steps.end())
                throw InvalidInput("--only is '" + name + "', must be one of the steps that --list names");
        std::erase_if(steps, [&](const Step& step) {
            return !options_.only.empty() && std::ranges::find(options_.only, step.name) == options_.only.end();
        });
        return steps;
    }

    void perform(const Step& step) {
        std::string missing;
        const std::vector<std::string> words = with_paths(step.words, missing);
        if (missing.empty() && step.words[0] == this_program && !has_command(step.words[1]))
            missing = "the command " + step.words[1];
        if (!missing.empty()) return add(step, "", "not run", {.last_line = missing + " is not here"});
        const CommandEnd end = perform(step, {.words = words}, step.name);
        if (!step.is_tried_again || (end.exit_code == 0 && !end.is_cut_off)) return;
        for (const auto& way : other_ways)
            perform(step, {.words = words, .environment = {way}}, step.name + "-" + way.first);
    }

    bool has_command(const std::string& name) const {
        return !app_.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; }).empty();
    }

    CommandEnd perform(const Step& step, const Command& command, const std::string& name) {
        const std::string way = command.environment.empty() ? "" : command.environment[0].first + "=1";
        const double left = options_.seconds - budget_.elapsed();
        if (left < 1.0 || is_asked_to_end()) {
            add(step, way, "left out", {});
            return {};
        }
        CommandEnd end =
            run_command(command, (fs::path(options_.out) / (name + ".log")).string(), std::min(left, step.seconds));
        const bool has_passed = end.exit_code == 0 && !end.is_cut_off;
        // The last step takes the rest of the time, and none is at fault where the run is told to end.
        const bool is_open_end = end.is_cut_off && (left <= step.seconds || is_asked_to_end());
        if (!has_passed && !is_open_end && command.environment.empty()) ++failed_;
        add(step, way, has_passed ? "passed" : end.is_cut_off ? "cut off" : "failed", end);
        return end;
    }

    void add(const Step& step, const std::string& way, const std::string& result, const CommandEnd& end) {
        std::string detail = result == "passed" ? "" : end.last_line;
        std::ranges::replace(detail, ',', ';');
        table_.add({{"step", step.name},
                    {"way", way},
                    {"result", result},
                    {"seconds", end.seconds},
                    {"exit_code", end.exit_code},
                    {"detail", detail}});
    }

    /// Puts the results into one file, the smallest first.
    std::string pack() const {
        std::vector<fs::path> files;
        for (const auto& entry : fs::recursive_directory_iterator(options_.out))
            if (entry.is_regular_file()) files.push_back(entry.path());
        std::ranges::sort(files, {}, [](const fs::path& path) { return fs::file_size(path); });
        Command tar{.words = {find_program("tar"), "-czf", fs::absolute(options_.out).string() + ".tar.gz", "-C",
                              fs::absolute(options_.out).string()},
                    .ends_on_signals = false};
        if (tar.words[0].empty()) throw std::runtime_error("the results stay in " + options_.out + ": there is no tar");
        std::uintmax_t bytes = 0;
        for (const fs::path& file : files) {
            bytes += fs::file_size(file);
            if (bytes > most_result_bytes) {
                std::cout << "left out of the file of results, which would be too large: " << file.string() << '\n';
                continue;
            }
            tar.words.push_back(fs::relative(file, options_.out).string());
        }
        const CommandEnd end = run_command(tar, options_.out + ".tar.log", 60.0);
        if (end.exit_code != 0) throw std::runtime_error("the results stay in " + options_.out + ": " + end.last_line);
        fs::remove(options_.out + ".tar.log");
        return tar.words[2];
    }

    const CheckOptions& options_;
    const CLI::App& app_;
    GrowingTable table_;
    TimeBudget budget_;
    int failed_ = 0;
};

/// Where the loader does not find the driver's library, it often lies near nvidia-smi: begins anew with that folder.
void find_driver_near_its_tool() {
    constexpr const char* begun_anew = "MENISCUS_DRIVER_FOLDER";
    const std::string tool = find_program("nvidia-smi");
    if (tool.empty() || std::getenv(begun_anew) != nullptr) return;
    const fs::path prefix = fs::weakly_canonical(tool).parent_path().parent_path();
    for (const char* const folder : {"lib64", "lib", "lib/x86_64-linux-gnu", "nvidia/lib64", "local/nvidia/lib64"}) {
        if (!fs::exists(prefix / folder / "libcuda.so.1")) continue;
        const char* const before = std::getenv("LD_LIBRARY_PATH");
        const std::string path = (prefix / folder).string() + (before != nullptr ? ":" + std::string(before) : "");
        ::setenv(begun_anew, (prefix / folder).c_str(), 1);
        ::setenv("LD_LIBRARY_PATH", path.c_str(), 1);
        ::execv(program_path().c_str(), const_cast<char* const*>(program_arguments()));
    }
}

}  // namespace

void add_check(CLI::App& app) {
    auto options = std::make_shared<CheckOptions>();
    CLI::App& command = *app.add_subcommand(
        "check",
        "All that a first run on a GPU shall find out, the most telling first; exit code 1 where a step fails or "
        "hangs, 77 without a GPU");
    command.add_option("--out", options->out, "Folder for the results, which end as FOLDER.tar.gz")
        ->capture_default_str();
    command.add_option("--seconds", options->seconds, "In all")->check(CLI::PositiveNumber)->capture_default_str();
    command.add_option("--particles", options->particles, "Of the large frames")
        ->check(CLI::Range(std::size_t{640}, std::size_t{1} << 32U))
        ->capture_default_str();
    command.add_option("--only", options->only, "Steps, by their names");
    command.add_flag("--list", options->is_list, "Name the steps, with the seconds that each may take");
    command.callback([options, &app] {
        if (options->is_list) {
            for (const Step& step : check_steps(options->particles, options->out))
                std::cout << step.name << ' ' << step.seconds << '\n';
            return;
        }
        try {
            require_gpu();
        } catch (const NoGpu&) {
            find_driver_near_its_tool();
            throw;
        }
        end_commands_on_signals();
        Check(*options, app).run();
    });
}

}  // namespace meniscus::benchmarks
