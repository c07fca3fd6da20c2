// The mark of a file that is still being written: a lock that ends with the descriptor, however the writer ends.
#pragma once

namespace meniscus::files {

/// Marks a file open for writing, until the descriptor is closed. A file system without locks keeps no mark.
void mark_as_being_written(int descriptor) noexcept;
/// Whether a file open for reading has the mark. Takes no lock itself.
bool is_being_written(int descriptor) noexcept;
/// Whether the file is known to have no writer: false also where the file system keeps no marks.
bool is_closed_by_its_writer(int descriptor) noexcept;

}  // namespace meniscus::files
