#include "model/gpu_constants.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "meniscus/error.hpp"

namespace meniscus::benchmarks {
namespace {

using Cells = std::vector<std::string>;

std::vector<Cells> read_csv(const std::filesystem::path& path) {
    std::ifstream in(path);
    if (!in) throw InvalidInput("cannot read " + path.string());
    std::vector<Cells> rows;
    for (std::string line; std::getline(in, line);) {
        rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
}

Pipe pipe_of(const std::string& name) {
    static const std::map<std::string, Pipe> pipes = {
        {"none", Pipe::none}, {"fp32", Pipe::fp32},     {"integer", Pipe::integer}, {"half", Pipe::half},
        {"fp64", Pipe::fp64}, {"memory", Pipe::memory}, {"shuffle", Pipe::shuffle}};
    return pipes.at(name);
}

}  // namespace

GpuConstants GpuConstants::read(const std::filesystem::path& table, const std::string& name) {
    const std::vector<Cells> rows = read_csv(table);
    std::string known;
    for (std::size_t r = 1; r < rows.size(); ++r) {
        known += (known.empty() ? "" : ", ") + rows[r].at(0);
        if (rows[r][0] != name) continue;
        GpuConstants constants;
        for (std::size_t c = 1; c < rows[r].size(); ++c) constants.figures_[rows[0].at(c)] = std::stod(rows[r][c]);
        return constants;
    }
    throw InvalidInput("the GPU is \"" + name + "\", must be one of " + known + "; add a row to " + table.string());
}

InstructionCosts InstructionCosts::read(const std::filesystem::path& table) {
    InstructionCosts costs;
    const std::vector<Cells> rows = read_csv(table);
    for (std::size_t r = 1; r < rows.size(); ++r)
        costs.rows_.push_back({rows[r].at(0), std::stod(rows[r].at(1)), std::stod(rows[r].at(2)),
                               pipe_of(rows[r].at(3)), std::stod(rows[r].at(4))});
    return costs;
}

const InstructionCost& InstructionCosts::of(const std::string& opcode) const {
    for (const InstructionCost& row : rows_)
        if (opcode.starts_with(row.pattern)) return row;
    throw std::runtime_error("instructions.csv has no row for " + opcode);
}

}  // namespace meniscus::benchmarks
