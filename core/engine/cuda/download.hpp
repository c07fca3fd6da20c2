// Finished arrays on their way from the device: straight to their place if that is pinned, else through two pieces of
// pinned memory, of which one fills while the other is emptied.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>

#include "engine/cuda/pinned_memory.hpp"
#include "engine/cuda/stream.hpp"

namespace meniscus::cuda {

class Download {
public:
    explicit Download(const std::shared_ptr<MemoryAccount>& account) : staging_(account) {
        staging_.reserve(pieces_.size() * piece_bytes);
    }

    /// Bytes may be on their way until finish().
    template <class T>
    void fetch(const T* from, std::size_t count, T* to, cudaStream_t stream) {
        const auto* bytes = reinterpret_cast<const std::byte*>(from);
        if (copy_straight(to, from, count * sizeof(T), cudaMemcpyDeviceToHost, stream)) {
            straight_ = true;
            return;
        }
        for (std::size_t at = 0; at < count * sizeof(T); at += piece_bytes)
            fetch_piece(bytes + at, std::min(piece_bytes, count * sizeof(T) - at),
                        reinterpret_cast<std::byte*>(to) + at, stream);
    }
    void finish(Stream& stream) {
        for (std::size_t i = 0; i < pieces_.size(); ++i) empty(i);
        if (std::exchange(straight_, false)) stream.synchronize();
    }
    /// Ends it after a failure: pieces under way are not delivered, and nothing is written to the caller's memory from
    /// here on.
    void forget(Stream& stream) noexcept {
        for (Piece& piece : pieces_) piece.bytes = 0;
        if (std::exchange(straight_, false)) stream.settle();
    }

private:
    static constexpr std::size_t piece_bytes = std::size_t{4} << 20;

    struct Piece {
        AwaitedEvent arrived;
        std::byte* to = nullptr;
        std::size_t bytes = 0;
    };

    std::byte* memory(std::size_t i) const { return staging_.get() + i * piece_bytes; }
    void fetch_piece(const std::byte* from, std::size_t bytes, std::byte* to, cudaStream_t stream) {
        empty(next_);
        check(cudaMemcpyAsync(memory(next_), from, bytes, cudaMemcpyDeviceToHost, stream), "cudaMemcpyAsync");
        pieces_[next_].arrived.record(stream);
        pieces_[next_].to = to;
        pieces_[next_].bytes = bytes;
        next_ = 1 - next_;
        // The piece before this one arrives first.
        empty(next_);
    }
    void empty(std::size_t i) {
        Piece& piece = pieces_[i];
        if (piece.bytes == 0) return;
        piece.arrived.wait();
        std::memcpy(piece.to, memory(i), piece.bytes);
        piece.bytes = 0;
    }

    PinnedMemory staging_;
    std::array<Piece, 2> pieces_;
    std::size_t next_ = 0;
    bool straight_ = false;  ///< whether copies to the caller's memory may be under way
};

}  // namespace meniscus::cuda
