// The model's constants: a row of gpus.csv for each GPU, and one of instructions.csv for each kind of instruction.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace meniscus::benchmarks {

/// Figures of a GPU by the names of gpus.csv's columns.
class GpuConstants {
public:
    /// Throws InvalidInput for a name that is not in the table, with those that are.
    static GpuConstants read(const std::filesystem::path& table, const std::string& name);
    /// Throws std::out_of_range for a column that is not there.
    double operator[](const std::string& column) const { return figures_.at(column); }
    unsigned count(const std::string& column) const { return static_cast<unsigned>(figures_.at(column)); }

private:
    std::map<std::string, double> figures_;
};

/// Where an instruction is computed. Each pipe has its own number of lanes a cycle.
enum class Pipe : std::uint8_t { none, fp32, integer, half, fp64, memory, shuffle };
inline constexpr std::size_t pipe_count = 7;

/// The cost of an opcode of PTX.
struct InstructionCost {
    std::string pattern;          ///< beginning of the opcode
    double issued = 0.0;          ///< machine instructions
    double cycles_of_pipe = 0.0;  ///< number of those that go to the pipe
    Pipe pipe = Pipe::none;
    double latency = 0.0;  ///< cycles until the result can be used; for memory see gpus.csv
};

class InstructionCosts {
public:
    static InstructionCosts read(const std::filesystem::path& table);
    /// That of the first row whose pattern the opcode begins with. Throws std::runtime_error without any.
    const InstructionCost& of(const std::string& opcode) const;

private:
    std::vector<InstructionCost> rows_;
};

}  // namespace meniscus::benchmarks
