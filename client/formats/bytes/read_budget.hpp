// What a file may still make grow. Nothing is given back, though memory is: what a file says again and again costs time
// each time, so that the budget bounds both.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_limits.hpp"

namespace meniscus::formats {

class ReadBudget {
public:
    /// file_bytes: what the file takes itself. Throws by `at` if that is too much already.
    ReadBudget(const ReadLimits& limits, std::uint64_t file_bytes, const ByteCursor& at)
        : most_(limits.most_bytes), left_(limits.most_bytes) {
        take(file_bytes, at, "the file");
    }

    std::uint64_t left() const { return left_; }
    /// To be called before the memory is allocated. what: that which needs it. Throws by `at` if too little is left.
    void take(std::uint64_t bytes, const ByteCursor& at, std::string_view what) {
        if (bytes > left_)
            at.fail(std::to_string(bytes) + " bytes for " + std::string(what) + ", but only " + std::to_string(left_) +
                    " are left of the " + std::to_string(most_) + " that a file may take with all that it makes grow");
        left_ -= bytes;
    }

private:
    std::uint64_t most_;
    std::uint64_t left_;
};

}  // namespace meniscus::formats
