// Device memory for a set of arrays: one after the other in one allocation, or each in its own, where faults are looked
// for (fault_finding.hpp).
//
// In one allocation an array's overrun would land in the next array, where neither a GPU's memory checker nor a
// comparison of meshes need see it, and memory that was zero once hides a word that no kernel sets.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/cuda/device_memory.hpp"
#include "engine/cuda/fault_finding.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cuda {

/// `arrays` in the functions below calls its argument as take(name, pointer, number of elements) for every array,
/// always in the same order; see State::arrays().
class ArrayMemory {
public:
    ArrayMemory(int device, cudaStream_t stream, std::shared_ptr<MemoryAccount> account)
        : placement_(array_placement()),
          device_(device),
          stream_(stream),
          memory_(device, stream, std::move(account)) {}

    std::size_t bytes() const { return memory_.bytes(); }
    void release() { memory_.release(); }

    /// The bytes of all arrays.
    template <class Arrays>
    std::size_t bytes_for(const Arrays& arrays) const {
        std::size_t end = 0;
        const auto add = [&](const char*, const auto* pointer, std::uint64_t elements) {
            const std::size_t size = elements * sizeof(*pointer);
            end = is_together() ? aligned(end) + size : end + piece_bytes(size);
        };
        arrays(add);
        return end;
    }

    /// Makes room for the arrays and gives them their places; what was there is lost. Throws as DeviceMemory does.
    template <class Arrays>
    void assign(const Arrays& arrays) {
        if (is_together()) {
            memory_.assign(bytes_for(arrays));
        } else {
            std::vector<std::size_t> sizes;
            const auto add = [&](const char*, const auto* pointer, std::uint64_t elements) {
                sizes.push_back(piece_bytes(elements * sizeof(*pointer)));
            };
            arrays(add);
            memory_.assign(sizes);
        }
        place(arrays);
        if (placement_ == ArrayPlacement::guarded) set_guards(arrays);
    }

    /// Gives the arrays the places that they have here.
    template <class Arrays>
    void place(const Arrays& arrays) const {
        std::size_t number = 0;
        std::size_t end = 0;
        const auto put = [&]<class T>(const char*, T*& pointer, std::uint64_t elements) {
            if (is_together()) {
                end = aligned(end);
                pointer = reinterpret_cast<T*>(memory_.get() + end);
                end += elements * sizeof(T);
            } else {
                pointer = reinterpret_cast<T*>(memory_.get(number++) + guard_bytes());
            }
        };
        arrays(put);
    }

    /// Overwrites what the frame before has left in all arrays but constant ones, with one of two patterns in turn: the
    /// first is not a number and no index, the other an index too large.
    template <class Arrays>
    void poison(const Arrays& arrays) {
        if (placement_ != ArrayPlacement::guarded) return;
        const int pattern = poisoned_++ % 2 == 0 ? 0xFF : 0x7B;
        const auto overwrite = [&]<class T>(const char*, T* pointer, std::uint64_t elements) {
            if constexpr (!std::is_const_v<T>)
                check(cudaMemsetAsync(pointer, pattern, elements * sizeof(T), stream_), "cudaMemsetAsync");
        };
        arrays(overwrite);
        // The arrays may be written on another stream next.
        check(cudaStreamSynchronize(stream_), "cudaStreamSynchronize");
    }

    /// Checks the guards after work that has ended. Throws DeviceError, which names the array, if something was written
    /// beside one.
    template <class Arrays>
    void require_whole_guards(const Arrays& arrays) const {
        if (placement_ != ArrayPlacement::guarded) return;
        std::vector<std::byte> guards;
        const auto make_room = [&](const char*, const auto*, std::uint64_t) {
            guards.resize(guards.size() + 2 * guard);
        };
        arrays(make_room);
        std::byte* next = guards.data();
        const auto fetch = [&](const std::byte* from) {
            check(cudaMemcpyAsync(next, from, guard, cudaMemcpyDeviceToHost, stream_), "cudaMemcpyAsync");
            next += guard;
        };
        for_each_guard(arrays, fetch);
        check(cudaStreamSynchronize(stream_), "cudaStreamSynchronize");
        next = guards.data();
        const auto look = [&](const char* name, const auto* pointer, std::uint64_t elements) {
            const auto is_whole = [](std::byte b) { return b == guard_pattern; };
            const std::byte* const before = next;
            const std::byte* const after = next += guard;
            next += guard;
            const std::size_t size = elements * sizeof(*pointer);
            if (const auto* const bad = std::find_if_not(before, after, is_whole); bad != after)
                throw_overrun(name, size, after - bad, "before its begin");
            if (const auto* const bad = std::find_if_not(after, after + guard, is_whole); bad != after + guard)
                throw_overrun(name, size, bad - after, "after its end");
        };
        arrays(look);
    }

private:
    static constexpr std::size_t guard = 4096;  ///< bytes on each side
    static constexpr std::byte guard_pattern{0xDD};

    static constexpr std::size_t aligned(std::size_t offset) {
        constexpr std::size_t alignment = 256;
        return (offset + alignment - 1) / alignment * alignment;
    }
    bool is_together() const { return placement_ == ArrayPlacement::together; }
    std::size_t guard_bytes() const { return placement_ == ArrayPlacement::guarded ? guard : 0; }
    /// No piece is empty.
    std::size_t piece_bytes(std::size_t size) const { return std::max<std::size_t>(size + 2 * guard_bytes(), 1); }

    /// Calls visit(begin of the guard) for the guard before and the guard after each array.
    template <class Arrays, class Visit>
    static void for_each_guard(const Arrays& arrays, const Visit& visit) {
        const auto visit_both = [&](const char*, const auto* pointer, std::uint64_t elements) {
            const auto* const begin = reinterpret_cast<const std::byte*>(pointer);
            visit(begin - guard);
            visit(begin + elements * sizeof(*pointer));
        };
        arrays(visit_both);
    }
    template <class Arrays>
    void set_guards(const Arrays& arrays) const {
        for_each_guard(arrays, [&](const std::byte* begin) {
            check(cudaMemsetAsync(const_cast<std::byte*>(begin), std::to_integer<int>(guard_pattern), guard, stream_),
                  "cudaMemsetAsync");
        });
    }
    [[noreturn]] void throw_overrun(const char* name, std::size_t size, std::ptrdiff_t distance,
                                    const char* where) const {
        throw DeviceError("the check of guards around arrays",
                          "the array " + std::string(name) + " of " + std::to_string(size) + " bytes was overrun " +
                              std::to_string(distance) + " bytes " + where,
                          device_);
    }

    ArrayPlacement placement_;
    int device_;
    cudaStream_t stream_;
    DeviceMemory memory_;
    unsigned poisoned_ = 0;
};

}  // namespace meniscus::cuda
