// A kernel as nvcc's PTX says it, read for the interpreter (ptx_grid.hpp): every operand is a slot of 64 bits for each
// lane, be it a register, a constant or a special register.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus::benchmarks {

struct PtxLanes;
struct PtxInstruction;
/// Computes the destination in the lanes of the mask.
using PtxCompute = void (*)(const PtxInstruction&, PtxLanes* slots, std::uint32_t mask);

/// 64 bits of each lane of a warp; narrower values fill up with zeros.
struct alignas(64) PtxLanes {
    std::uint64_t of[32];
};

enum class PtxKind : std::uint8_t {
    compute,
    load,
    store,
    atomic,
    branch,
    shuffle,
    ballot,
    warp_barrier,
    block_barrier,
    end,
    trap,
    nothing,  ///< fences, whose effect a machine without races has anyway
};
enum class PtxSpace : std::uint8_t { global, shared, parameter };

struct PtxInstruction {
    PtxKind kind = PtxKind::nothing;
    PtxSpace space = PtxSpace::global;
    bool is_target = false;  ///< branches come here
    bool guard_is_negated = false;
    bool is_acquire = false;  ///< a load on which a thread may wait for others
    std::uint8_t element_bytes = 0;
    std::uint8_t elements = 1;  ///< elements of a vector
    bool is_signed = false;
    std::uint8_t detail = 0;  ///< kind of a shuffle or an atomic operation
    std::uint8_t to_count = 0;
    std::uint8_t from_count = 0;
    std::int32_t guard = -1;  ///< slot of the predicate
    std::int32_t to[4] = {-1, -1, -1, -1};
    std::int32_t from[5] = {-1, -1, -1, -1, -1};  ///< for a load and a store the address comes first
    std::int64_t offset = 0;                      ///< offset to the address
    std::int32_t target = -1;
    PtxCompute compute = nullptr;
    std::string opcode;
};

/// A slot whose value is known when a warp begins.
struct PtxPreset {
    enum class What : std::uint8_t {
        constant,
        parameter_address,
        thread,
        block,
        threads,
        blocks,
        lane,
        workspace_high,
        workspace_low
    };
    std::int32_t slot;
    What what;
    std::uint64_t value;  ///< a constant's value, or a parameter's number
};

struct PtxKernel {
    std::string name;  ///< mangled
    std::uint32_t parameters = 0;
    std::uint64_t shared_bytes = 0;
    std::int32_t slots = 0;
    std::vector<PtxPreset> presets;
    std::vector<PtxInstruction> instructions;
};

/// The kernels of a text. Throws std::runtime_error for an instruction that the interpreter does not know, with it.
std::vector<PtxKernel> read_ptx(std::string_view text);

/// The function that computes an opcode, from ptx_operations.cpp; null if it is not known there.
PtxCompute find_computation(const std::string& opcode);

}  // namespace meniscus::benchmarks
