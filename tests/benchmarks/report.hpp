// Where results go: rows of figures as CSV and as JSON, with what is needed to repeat them.
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "meniscus/statistics.hpp"

namespace meniscus::benchmarks {

/// Figures by name, in order, none of them nested; null: none, an empty place in the CSV. The rows of one table have
/// the same names.
using Row = nlohmann::ordered_json;
/// An array of rows.
using Rows = nlohmann::ordered_json;

/// Kept for the reports, with only the last part of absolute paths: the rest says nothing elsewhere.
void remember_command(const std::string& program, int argc, const char* const* argv);

/// The time of a reconstruction, seconds: on a GPU between CUDA's events, from the upload on, without the mesh's way to
/// the host.
double reconstruction_seconds(const Statistics& statistics);
/// The bytes that it takes place in: of the GPU, or of the host with the mesh.
std::uint64_t reconstruction_bytes(const Statistics& statistics);

/// Adds one reconstruction's figures: times in seconds, sizes in bytes.
void add_statistics(Row& row, const Statistics& statistics);

/// Writes `name`.csv, the rows, and `name`.json: machine, commit, command, what `summary` holds, and the rows.
void write_report(const std::filesystem::path& directory, const std::string& name,
                  const nlohmann::ordered_json& summary, const Rows& rows);

/// A table that is there as far as it goes, whenever the program ends: each row is written when it comes, to
/// `name`.csv in `directory` and to standard output.
class GrowingTable {
public:
    GrowingTable(const std::filesystem::path& directory, const std::string& name);
    /// Rows have the same names. A text has no comma.
    void add(const Row& row);
    /// `name`.json beside it, see write_report().
    void finish(const nlohmann::ordered_json& summary) const;
    const Rows& rows() const { return rows_; }

private:
    void write(const std::string& line);

    std::filesystem::path directory_;
    std::string name_;
    std::ofstream csv_;
    Rows rows_ = Rows::array();
};

}  // namespace meniscus::benchmarks
