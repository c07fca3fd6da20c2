// The size of all recordings in a folder.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

namespace meniscus::server {

/// Sums the folder once, then counts what is added. Blocks on the disk; of one thread.
class RecordedBytes {
public:
    explicit RecordedBytes(std::filesystem::path directory) : directory_(std::move(directory)) {}

    std::uint64_t sum();
    void add(std::uint64_t bytes) { sum_ = sum() + bytes; }
    /// The sum, without the files that others have deleted. Summing takes a tenth of the time at most, however often it
    /// is asked: where there are many files, this may be the sum of a while ago.
    std::uint64_t newest_sum();

private:
    const std::filesystem::path directory_;
    std::optional<std::uint64_t> sum_;
    std::chrono::steady_clock::time_point next_{};
};

}  // namespace meniscus::server
