#include "load/report.hpp"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace meniscus::load {

namespace {

using Json = nlohmann::ordered_json;

struct Percentile {
    const char* name;
    double share;
};
constexpr std::array<Percentile, 5> percentiles{
    {{"p50", 0.5}, {"p90", 0.9}, {"p99", 0.99}, {"p99.9", 0.999}, {"max", 1.0}}};

Json to_json(const Latencies& latencies) {
    Json json{{"count", latencies.count()}, {"mean", latencies.mean()}};
    for (const auto& [name, share] : percentiles) json[name] = latencies.percentile(share);
    return json;
}

Json to_json(const WatchOutcome& outcome, unsigned number) {
    return {{"number", number},
            {"frames", outcome.frames},
            {"skipped", outcome.skipped},
            {"vanished", outcome.vanished},
            {"mesh_bytes", outcome.mesh_bytes},
            {"errors", outcome.errors},
            {"due_to_watcher_seconds", to_json(outcome.latency)}};
}

Json to_json(const LoadOptions& options) {
    return {{"simulators", options.simulators},
            {"watchers", options.watchers},
            {"slow_watchers", options.slow},
            {"slow_seconds", options.slow_seconds},
            {"stalled_watchers", options.stalled},
            {"vanishing_watchers", options.vanishing},
            {"vanish_after", options.vanish_after},
            {"rate", options.rate},
            {"seconds", options.seconds},
            {"warm_up", options.warm_up},
            {"meshes", options.stream.receive_meshes},
            {"particles", options.files.empty() ? Json(options.particles) : Json()},
            {"input", options.files}};
}

double per_second(std::uint64_t amount, const LoadResult& result) {
    return result.seconds > 0.0 ? static_cast<double>(amount) / result.seconds : 0.0;
}

void add_row(std::string& table, const char* name, const Latencies& latencies) {
    constexpr double milliseconds = 1e3;
    std::array<char, 160> row{};
    std::snprintf(row.data(), row.size(), "%-24s %8zu", name, latencies.count());
    table += row.data();
    for (const Percentile& p : percentiles) {
        std::snprintf(row.data(), row.size(), " %9.2f", milliseconds * latencies.percentile(p.share));
        table += row.data();
    }
    table += '\n';
}

std::string errors_of(const LoadResult& result) {
    Errors all = result.uploads.errors;
    for (const WatchOutcome* outcome : {&result.watchers, &result.slow, &result.vanishing})
        for (const auto& [status, count] : outcome->errors) all[status] += count;
    std::string text;
    for (const auto& [status, count] : all) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + status;
    return text.empty() ? "none" : text;
}

}  // namespace

std::string to_json(const LoadOptions& options, const LoadResult& result) {
    const UploadOutcome& uploads = result.uploads;
    const Json json{
        {"server",
         {{"version", result.server.version},
          {"backend", result.server.backend},
          {"device", result.server.device},
          {"threads", result.server.threads}}},
        {"options", to_json(options)},
        {"seconds", result.seconds},
        {"frames",
         {{"due", result.schedule.frames * options.simulators},
          {"sent", uploads.sent},
          {"answered", uploads.answered},
          {"dropped", uploads.dropped},
          {"lost", uploads.lost()},
          {"not_sent", uploads.not_sent}}},
        {"upload_errors", uploads.errors},
        {"due_to_answer_seconds", to_json(uploads.answer)},
        {"due_to_send_seconds", to_json(uploads.send_delay)},
        {"watchers", to_json(result.watchers, options.watchers * options.simulators)},
        {"slow_watchers", to_json(result.slow, options.slow * options.simulators)},
        {"vanishing_watchers", to_json(result.vanishing, options.vanishing * options.simulators)},
        {"throughput",
         {{"frames_per_second", per_second(uploads.answered, result)},
          {"particles_per_second", per_second(uploads.particles, result)},
          {"upload_bytes_per_second", per_second(uploads.upload_bytes, result)},
          {"mesh_bytes_per_second", per_second(uploads.mesh_bytes, result)},
          {"watched_bytes_per_second",
           per_second(result.watchers.mesh_bytes + result.slow.mesh_bytes + result.vanishing.mesh_bytes, result)}}}};
    return json.dump(2) + "\n";
}

std::string to_table(const LoadResult& result) {
    const UploadOutcome& uploads = result.uploads;
    std::string table = "milliseconds from due       count       p50       p90       p99     p99.9       max\n";
    add_row(table, "to the sending", uploads.send_delay);
    add_row(table, "to the answer", uploads.answer);
    if (result.watchers.frames > 0) add_row(table, "to a watcher", result.watchers.latency);
    if (result.slow.frames > 0) add_row(table, "to a slow watcher", result.slow.latency);
    std::array<char, 400> text{};
    std::snprintf(
        text.data(), text.size(),
        "%.2f frames/s answered, %.3g particles/s, %.1f MB/s up, %.2f MB/s of meshes back\n"
        "frames: %llu sent, %llu answered, %llu dropped, %llu lost, %llu not sent in time\n"
        "watchers: %llu frames, %llu skipped; slow: %llu, %llu skipped; vanished %llu times\n",
        per_second(uploads.answered, result), per_second(uploads.particles, result),
        per_second(uploads.upload_bytes, result) / 1e6, per_second(uploads.mesh_bytes, result) / 1e6,
        static_cast<unsigned long long>(uploads.sent), static_cast<unsigned long long>(uploads.answered),
        static_cast<unsigned long long>(uploads.dropped), static_cast<unsigned long long>(uploads.lost()),
        static_cast<unsigned long long>(uploads.not_sent), static_cast<unsigned long long>(result.watchers.frames),
        static_cast<unsigned long long>(result.watchers.skipped), static_cast<unsigned long long>(result.slow.frames),
        static_cast<unsigned long long>(result.slow.skipped),
        static_cast<unsigned long long>(result.vanishing.vanished));
    return table + text.data() + "errors: " + errors_of(result) + "\n";
}

bool has_failures(const LoadResult& result) {
    return result.uploads.lost() > 0 || errors_of(result) != "none";
}

}  // namespace meniscus::load
