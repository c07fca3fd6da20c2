// A variable in the shared memory of a block: rubbish at the block's begin, with a guard behind it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

namespace emulated_device {

struct SharedVariable {
    static constexpr std::size_t guard_bytes = 64;
    static constexpr std::byte guard{0xDD};
    static constexpr std::byte rubbish{0xA5};

    unsigned line;  ///< line of its declaration
    std::size_t bytes;
    std::unique_ptr<std::byte[]> room;
    std::byte* memory;

    SharedVariable(unsigned of_line, std::size_t size, std::size_t alignment)
        : line(of_line),
          bytes(size),
          room(std::make_unique_for_overwrite<std::byte[]>(size + alignment + guard_bytes)) {
        void* begin = room.get();
        std::size_t space = size + alignment;
        memory = static_cast<std::byte*>(std::align(alignment, size, begin, space));
        std::fill_n(memory, size, rubbish);
        std::fill_n(memory + size, guard_bytes, guard);
    }
    bool is_whole() const {
        return std::all_of(memory + bytes, memory + bytes + guard_bytes, [](std::byte b) { return b == guard; });
    }
};

}  // namespace emulated_device
