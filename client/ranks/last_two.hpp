// Where the frames of a rank that are on their way lie.
#pragma once

#include <array>
#include <cstddef>

namespace meniscus::ranks {

/// Two in turn: what a rank hands over stays until the next frame but one is asked for (HandedFrame).
template <class Buffers>
class LastTwo {
public:
    /// That of the frame before stays as it is.
    Buffers& next() {
        newest_ = 1 - newest_;
        return both_[newest_];
    }

private:
    std::array<Buffers, 2> both_;
    std::size_t newest_ = 0;
};

}  // namespace meniscus::ranks
