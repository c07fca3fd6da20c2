// A surface that was made elsewhere: its bricks, as they came and in other forms.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"
#include "sessions/limits/memory_charge.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// Checked; immutable.
struct FinishedBricks {
    std::uint32_t offset_bits = 0;
    Codec codec = Codec::lattice_packed;
    int normal_bits = 0;
    std::vector<CodedAttribute> attributes;  ///< that they carry
    std::vector<SharedBrick> bricks;         ///< ordered by place (z, y, x)
    std::uint64_t triangles = 0;
    std::shared_ptr<const MemoryCharge> charge;  ///< for what they take once they are parsed
};

/// The bricks in one form. All that is passed by reference outlives it.
class RecodedBricks {
public:
    /// options: as for encode_brick(); their attributes are some of those that the bricks carry.
    RecodedBricks(const FinishedBricks& finished, const CodingOptions& options);

    /// The brick of that number: as it came, where that is the form that is asked for. before: bricks of an earlier
    /// frame in this form, ordered by place, of which one with the same content serves again. Thread-safe. Throws
    /// LimitExceeded if the account of the scratch memory would pass its limit.
    SharedBrick brick(std::size_t number, const std::vector<SharedBrick>& before, BrickScratch& scratch) const;

private:
    const FinishedBricks& finished_;
    const CodingOptions& options_;
    std::vector<CodedAttribute> forms_;  ///< of the bricks and of what they become, which content hashes hold
    bool is_as_it_came_ = false;
};

}  // namespace meniscus::server
