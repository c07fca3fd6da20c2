// Memory that the program has freed, and glibc keeps: it goes back to the system.
#pragma once

#include <malloc.h>

namespace meniscus::server {

/// Call it before other threads run. From then on the arrays of reconstructions are no part of glibc's heaps, so that
/// sessions which give their buffers back leave memory for others; by itself glibc comes to keep every array of less
/// than 32 MB. Messages stay in the heaps: to get each from the system would cost its pages again.
inline void keep_arrays_out_of_the_heaps() {
    constexpr int smallest_array = 4 << 20;
    constexpr int kept_at_the_top = 2 << 20;
    mallopt(M_MMAP_THRESHOLD, smallest_array);
    mallopt(M_TRIM_THRESHOLD, kept_at_the_top);
}

/// Gives the free pages within the heaps back, all but those at their tops. Other threads that allocate wait for it,
/// for milliseconds.
inline void return_free_pages() {
    malloc_trim(0);
}

}  // namespace meniscus::server
