// meniscus-bench goals: what a GPU is to reach, beside what `experiment` and `scaling` have measured on one. The limits
// for times are those of a model of the kernels (tests/README.md), which was made before any measurement.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "benchmarks.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "meniscus/error.hpp"
#include "warm_runs.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

/// The rows that another command has left in a folder, if it measured a GPU.
Json gpu_rows(const std::filesystem::path& folder, const char* command) {
    const std::filesystem::path path = folder / (std::string(command) + ".json");
    std::ifstream in(path);
    if (!in) return Json::array();
    const Json report = Json::parse(in, nullptr, false);
    if (!report.is_object() || !report.contains("rows"))
        throw InvalidInput(path.string() + " is no report of meniscus-bench " + command + ": run that again");
    return report.value("backend", "") == "cuda" ? report.at("rows") : Json::array();
}

/// A figure of the scaling run with a million particles and coarse cells.
std::optional<double> of_a_million(const Json& scaling, WaterKind water, Field field, Mode mode, const char* figure) {
    constexpr std::size_t particles = 64 * basin_particles;
    for (const Json& row : scaling)
        if (row.at("water") == name_of(water) && row.value("field", "smooth") == name_of(field) &&
            row.at("mode") == name_of(mode) && row.at("cell_size") == 1.0 && row.at("particles") == particles)
            return row.at(figure).get<double>();
    return {};
}

/// Seconds of splashsurf for the same million splashing particles, the field without smoothing, on all processors,
/// where someone has measured them.
std::optional<double> seconds_of_splashsurf(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / "splashsurf.json";
    std::ifstream in(path);
    if (!in) return {};
    const Json report = Json::parse(in, nullptr, false);
    if (!report.is_object() || !report.contains("seconds"))
        throw InvalidInput(path.string() + " has no \"seconds\": write {\"seconds\": S} into it");
    return report.at("seconds").get<double>();
}

std::optional<double> median_frame(const Json& experiment) {
    std::vector<double> seconds;
    for (const Json& row : experiment)
        if (row.at("mode") == "adaptive") seconds.push_back(row.at("reconstruction_seconds").get<double>());
    if (seconds.empty()) return {};
    return median(std::move(seconds));
}

std::optional<double> in_milliseconds(std::optional<double> seconds) {
    if (seconds) *seconds *= 1e3;
    return seconds;
}

std::optional<double> ratio(std::optional<double> over, std::optional<double> under) {
    if (!over || !under) return {};
    return *over / *under;
}

enum class Bound { at_most, at_least };

/// Nothing measured: null.
Json row(const char* goal, const char* unit, Bound bound, double limit, std::optional<double> measured) {
    Json out{{"goal", goal},   {"unit", unit},        {"bound", bound == Bound::at_most ? "at most" : "at least"},
             {"limit", limit}, {"measured", nullptr}, {"holds", nullptr}};
    if (measured) {
        out["measured"] = *measured;
        out["holds"] = bound == Bound::at_most ? *measured <= limit : *measured >= limit;
    }
    return out;
}

Json judge(const std::filesystem::path& folder) {
    const Json scaling = gpu_rows(folder, "scaling");
    const Json experiment = gpu_rows(folder, "experiment");
    const auto figure = [&](WaterKind water, Field field, Mode mode, const char* name) {
        return of_a_million(scaling, water, field, mode, name);
    };
    constexpr const char* seconds = "reconstruction_seconds";
    constexpr const char* bytes = "device_peak_bytes";
    using enum WaterKind;
    const auto frame_milliseconds = [&](Field field, Mode mode) {
        return in_milliseconds(figure(splashing, field, mode, seconds));
    };
    return Json::array({
        row("a million splashing particles, c = 1.0, smooth, uniform", "ms", Bound::at_most, 11.0,
            frame_milliseconds(Field::smooth, Mode::uniform)),
        row("a million splashing particles, c = 1.0, smooth, adaptive", "ms", Bound::at_most, 8.0,
            frame_milliseconds(Field::smooth, Mode::adaptive)),
        row("a million splashing particles, c = 1.0, color, uniform", "ms", Bound::at_most, 5.0,
            frame_milliseconds(Field::color, Mode::uniform)),
        row("a million splashing particles, c = 1.0, color, adaptive", "ms", Bound::at_most, 6.0,
            frame_milliseconds(Field::color, Mode::adaptive)),
        row("the paper's dam break, 16,000 particles, adaptive, median frame", "ms", Bound::at_most, 0.7,
            in_milliseconds(median_frame(experiment))),
        row("a million calm particles, c = 1.0: time of uniform over adaptive", "times", Bound::at_least, 3.0,
            ratio(figure(calm, Field::smooth, Mode::uniform, seconds),
                  figure(calm, Field::smooth, Mode::adaptive, seconds))),
        row("a million calm particles, c = 1.0: memory of adaptive over uniform", "times", Bound::at_most, 1.0 / 3.0,
            ratio(figure(calm, Field::smooth, Mode::adaptive, bytes),
                  figure(calm, Field::smooth, Mode::uniform, bytes))),
        row("a million splashing particles, c = 1.0, color, uniform: time of splashsurf on all processors over ours",
            "times", Bound::at_least, 50.0,
            ratio(seconds_of_splashsurf(folder), figure(splashing, Field::color, Mode::uniform, seconds))),
    });
}

void run_goals(const std::filesystem::path& folder) {
    const Json goals = judge(folder);
    for (const Json& goal : goals)
        std::cout << goal.at("goal").get<std::string>() << ": " << goal.at("bound").get<std::string>() << ' '
                  << goal.at("limit") << ' ' << goal.at("unit").get<std::string>() << ", measured "
                  << goal.at("measured") << '\n';
    formats::make_directory(folder);
    formats::write_file(folder / "goals.json", goals.dump(2) + "\n");
}

}  // namespace

void add_goals(CLI::App& app) {
    auto folder = std::make_shared<std::string>("tests/benchmarks/results");
    CLI::App& command = *app.add_subcommand(
        "goals",
        "What a GPU is to reach, beside what experiment and scaling have measured on one; null where they have not");
    command.add_option("--out", *folder, "Folder with their results, and for goals.json")->capture_default_str();
    command.callback([folder] { run_goals(*folder); });
}

}  // namespace meniscus::benchmarks
