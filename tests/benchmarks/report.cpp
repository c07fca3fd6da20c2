#include "report.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "formats/bytes/atomic_file.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::benchmarks {
namespace {

std::string command_line;

/// The commit that the sources are at, "-dirty" if they were changed since, "unknown" outside of a checkout. Where this
/// program runs without its sources, MENISCUS_COMMIT may name it.
std::string commit() {
    if (const char* given = std::getenv("MENISCUS_COMMIT")) return given;
    const std::unique_ptr<FILE, int (*)(FILE*)> git(
        popen("git -C '" MENISCUS_SOURCE_DIR "' describe --always --dirty --abbrev=12 --exclude='*' 2>/dev/null", "r"),
        &pclose);
    std::array<char, 64> text{};
    if (!git || std::fgets(text.data(), text.size(), git.get()) == nullptr) return "unknown";
    std::string out(text.data());
    while (!out.empty() && out.back() == '\n') out.pop_back();
    return out;
}

std::string csv_header(const Row& row) {
    std::string out;
    for (const auto& column : row.items()) out += (out.empty() ? "" : ",") + column.key();
    return out + '\n';
}

std::string csv_line(const Row& row) {
    std::string out;
    const char* separator = "";
    for (const auto& value : row) {
        out += separator;
        if (!value.is_null()) out += value.is_string() ? value.get<std::string>() : value.dump();
        separator = ",";
    }
    return out + '\n';
}

std::string to_csv(const Rows& rows) {
    std::string out = csv_header(rows.at(0));
    for (const Row& row : rows) out += csv_line(row);
    return out;
}

}  // namespace

void remember_command(const std::string& program, int argc, const char* const* argv) {
    command_line = program;
    for (int i = 1; i < argc; ++i) {
        const std::filesystem::path argument(argv[i]);
        command_line += ' ';
        command_line += (argument.is_absolute() ? argument.filename() : argument).string();
    }
}

double reconstruction_seconds(const Statistics& s) {
    return s.backend == "cuda" ? std::accumulate(s.stage_seconds.begin(), s.stage_seconds.end(), 0.0) : s.total_seconds;
}

std::uint64_t reconstruction_bytes(const Statistics& s) {
    return s.backend == "cuda" ? s.device_peak_bytes : s.peak_bytes;
}

void add_statistics(Row& row, const Statistics& s) {
    row["total_seconds"] = s.total_seconds;
    row["reconstruction_seconds"] = reconstruction_seconds(s);
    for (const Stage stage : choices<Stage>)
        row[std::string(name_of(stage)) + "_seconds"] = s.stage_seconds[static_cast<std::size_t>(stage)];
    row["triangles"] = s.triangles;
    for (const TriangleLevel level : choices<TriangleLevel>)
        row[std::string(name_of(level)) + "_triangles"] = s.triangles_by_level[static_cast<std::size_t>(level)];
    row["vertices"] = s.vertices;
    row["field_evaluations"] = s.field_evaluations;
    row["peak_bytes"] = s.peak_bytes;
    row["device_peak_bytes"] = s.device_peak_bytes;
    row["allocations"] = s.allocations;
}

GrowingTable::GrowingTable(const std::filesystem::path& directory, const std::string& name)
    : directory_(directory), name_(name) {
    formats::make_directory(directory);
    csv_.open(directory / (name + ".csv"));
    if (!csv_) throw std::runtime_error("cannot write " + (directory / (name + ".csv")).string());
}

void GrowingTable::add(const Row& row) {
    if (rows_.empty()) write(csv_header(row));
    rows_.push_back(row);
    write(csv_line(row));
}

void GrowingTable::write(const std::string& line) {
    csv_ << line << std::flush;
    if (!csv_) throw std::runtime_error("cannot write to " + (directory_ / (name_ + ".csv")).string());
    std::cout << line << std::flush;
}

void GrowingTable::finish(const nlohmann::ordered_json& summary) const {
    if (!rows_.empty()) write_report(directory_, name_, summary, rows_);
}

void write_report(const std::filesystem::path& directory, const std::string& name,
                  const nlohmann::ordered_json& summary, const Rows& rows) {
    nlohmann::ordered_json all;
    all["machine"] = describe_backend(Backend::cpu).device;
    all["compiler"] = __VERSION__;
    all["commit"] = commit();
    all["command"] = command_line;
    all.update(summary);
    all["rows"] = rows;
    formats::make_directory(directory);
    formats::write_file(directory / (name + ".csv"), to_csv(rows));
    formats::write_file(directory / (name + ".json"), all.dump(2) + "\n");
}

}  // namespace meniscus::benchmarks
