// Meetings of the device's threads, and their places: all must come to the same one.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "cuda_runtime.h"

namespace emulated_device {

struct Waiting {
    Meeting meeting{};
    Place place;
    unsigned mask = 0;

    bool is_at_place_of(const Waiting& other) const {
        return meeting == other.meeting && place.line() == other.place.line() && place.column() == other.place.column();
    }
    bool operator==(const Waiting& other) const { return mask == other.mask && is_at_place_of(other); }
    std::string text() const {
        static constexpr const char* names[] = {"__syncwarp",      "__ballot_sync", "__shfl_sync", "__shfl_up_sync",
                                                "__shfl_xor_sync", "__syncthreads", "grid sync"};
        char mask_text[32];
        std::snprintf(mask_text, sizeof(mask_text), " by mask %08X", mask);
        return std::string(names[static_cast<std::size_t>(meeting)]) + " in line " + std::to_string(place.line()) +
               mask_text;
    }
};

/// The threads of a block, or of a grid.
struct Barrier {
    unsigned arrived = 0;
    Waiting waiting;  ///< meeting of the first thread that has arrived
};

}  // namespace emulated_device
