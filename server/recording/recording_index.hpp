// Where the meshes of one recording are in its file. Grows with it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/random_access_file.hpp"
#include "files/recording_scan.hpp"

namespace meniscus::server {

/// 40 bytes for each frame; what is recorded of one takes a kilobyte or more on the disk.
struct MeshPlace {
    std::uint64_t frame_index = 0;
    files::RecordedRange messages;
};

class RecordingIndex {
public:
    /// Takes in what the file holds beyond what is known of it: entries alone, never a frame. A file that has taken the
    /// place of the one before is read anew. Damage ends the index there, and is logged. Throws InvalidInput if the
    /// file is no recording.
    void update(const files::RandomAccessFile& file);

    const v1::RecordingBegin& begin() const noexcept { return begin_; }
    /// The meshes by rising frame index.
    const std::vector<MeshPlace>& meshes() const noexcept { return meshes_; }
    std::uint64_t bytes() const noexcept { return bytes_; }
    bool being_written() const noexcept { return being_written_; }
    bool damaged() const noexcept { return damaged_; }

private:
    void take(const files::RecordingScan& scan, const files::RecordingScan::Item& item);

    v1::RecordingBegin begin_;
    std::vector<MeshPlace> meshes_;
    std::uint64_t position_ = 0;  ///< of the first entry that is not known
    std::uint64_t bytes_ = 0;
    bool being_written_ = false;
    bool damaged_ = false;
};

}  // namespace meniscus::server
