// Where results go: rows of figures as CSV and as JSON, with what is needed to repeat them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "meniscus/statistics.hpp"

namespace meniscus::benchmarks {

/// Figures by name, in order, none of them nested. The rows of one table have the same names.
using Row = nlohmann::ordered_json;
/// An array of rows.
using Rows = nlohmann::ordered_json;

/// Kept for the reports, with only the last part of absolute paths: the rest says nothing elsewhere.
void remember_command(int argc, const char* const* argv);

/// What a reconstruction takes, in seconds: on a GPU between CUDA's events, from the upload on, without the mesh's way
/// to the host.
double reconstruction_seconds(const Statistics& statistics);
/// The bytes that it takes place in: of the GPU, or of the host with the mesh.
std::uint64_t reconstruction_bytes(const Statistics& statistics);

/// Adds one reconstruction's figures: times in seconds, sizes in bytes.
void add_statistics(Row& row, const Statistics& statistics);

/// Writes `name`.csv, the rows, and `name`.json: machine, commit, command, what `summary` holds, and the rows.
void write_report(const std::filesystem::path& directory, const std::string& name,
                  const nlohmann::ordered_json& summary, const Rows& rows);

}  // namespace meniscus::benchmarks
