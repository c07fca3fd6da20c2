// The memory in which the bricks of one mesh are packed, kept from mesh to mesh.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "codec/attribute_extremes.hpp"
#include "codec/lattice/pack_bricks.hpp"
#include "engine/cuda/array_memory.hpp"
#include "engine/cuda/pinned_memory.hpp"
#include "engine/growth.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::cuda {

class PackingMemory {
    /// In the form that ArrayMemory takes.
    auto arrays() {
        return [this](auto& take) {
            take("attribute_extremes", extremes, max_particle_arrays);
            take("packed_places", places, bricks_);
            take("packed_hashes", hashes, bricks_);
            take("packed_words", words, words_);
        };
    }

public:
    PackingMemory(int device, cudaStream_t stream, const std::shared_ptr<MemoryAccount>& account,
                  const std::shared_ptr<MemoryAccount>& device_account)
        : on_device_(device, stream, device_account), tables_(account), packed_(account) {}

    // On the device:
    AttributeExtremes* extremes = nullptr;  ///< one for each attribute
    PackedPlace* places = nullptr;          ///< one for each brick, as are hashes
    WordHash* hashes = nullptr;
    std::uint64_t* words = nullptr;

    /// Makes room for bricks with this number of words in all; what was there is lost if it moves. Throws
    /// LimitExceeded.
    void reserve(std::uint64_t bricks, std::uint64_t words_of_all) {
        if (extremes == nullptr || bricks > bricks_ || words_of_all > words_) {
            extremes = nullptr;  // until there is memory again
            bricks_ = with_room_to_grow(bricks);
            words_ = with_room_to_grow(words_of_all);
            on_device_.assign(arrays());
        }
        on_device_.poison(arrays());
        tables_.reserve(std::max({bricks * sizeof(PackedPlace), bricks * sizeof(WordHash),
                                  max_particle_arrays * sizeof(AttributeExtremes)}));
        packed_.reserve(words_of_all * sizeof(std::uint64_t));
    }
    void require_whole_guards() { on_device_.require_whole_guards(arrays()); }

    /// Pinned, for one table at a time.
    template <class T>
    T* table() const {
        return reinterpret_cast<T*>(tables_.get());
    }
    /// Pinned, for the words.
    std::byte* packed() const { return packed_.get(); }

private:
    std::uint64_t bricks_ = 0, words_ = 0;  ///< room
    ArrayMemory on_device_;
    PinnedMemory tables_, packed_;
};

}  // namespace meniscus::cuda
