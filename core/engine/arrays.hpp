// Sizing the backends' arrays: they grow with some room to spare and never shrink, so that a warm frame allocates
// nothing.
#pragma once

#include <cstddef>
#include <memory>

#include "engine/growth.hpp"
#include "meniscus/memory.hpp"

namespace meniscus {

/// Gives its memory back, not its account.
template <class T>
void release(Array<T>& array) {
    array = Array<T>(array.get_allocator());
}

/// Makes an array of n elements whose values do not matter.
template <class T>
void resize_for_overwrite(Array<T>& array, std::size_t n) {
    if (array.capacity() < n) {
        // Gives the old memory back first: nothing of it is needed, and the peak stays low.
        release(array);
        const AccountAllocator<T> allocator = array.get_allocator();
        const auto& account = allocator.account();
        array.reserve(account && account->pins() ? with_pinned_room_to_grow(n, sizeof(T)) : with_room_to_grow(n));
    }
    array.resize(n);
}

template <class T>
Array<T> make_array(const std::shared_ptr<MemoryAccount>& account) {
    return Array<T>(AccountAllocator<T>(account));
}

}  // namespace meniscus
