// Tells readers of a file that it is still being written: a lock that ends with the descriptor, however the writer
// ends.
#pragma once

namespace meniscus::files {

/// Of a file open for writing, for as long as the descriptor is open. A file system without locks keeps no mark.
void mark_as_being_written(int descriptor) noexcept;
/// Of a file open for reading. Takes no lock itself.
bool is_being_written(int descriptor) noexcept;
/// Whether it is known that nobody writes to it: false also where the file system keeps no marks.
bool is_closed_by_its_writer(int descriptor) noexcept;

}  // namespace meniscus::files
