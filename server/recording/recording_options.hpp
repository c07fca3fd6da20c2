// The options of recording: where, how much, and for how long.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/described.hpp"

namespace meniscus::server {

/// Which recordings go by themselves, none that is being written or read.
struct RecordingRetention {
    std::uint64_t min_frames = 0;         ///< those of fewer frames, once they are closed; 0: none
    std::chrono::milliseconds max_age{};  ///< those to which nothing was written for this time; 0: none

    bool keeps_all() const noexcept { return min_frames == 0 && max_age.count() == 0; }
};

struct RecordingOptions {
    std::filesystem::path directory;  ///< empty: nothing is recorded
    std::uint64_t limit = 0;          ///< bytes of all recordings in it, earlier ones included; 0: no limit
    /// Frames that wait for the disk, bytes over all sessions. Further ones are left out of their recordings.
    std::size_t waiting_limit = std::size_t{256} << 20;
    /// The bits of float32 attributes in the meshes, per component; 0: exact.
    int attribute_bits = default_attribute_bits;
    Codec codec = Codec::lattice_entropy;  ///< of the meshes, where a session can encode it; otherwise Draco
    RecordingRetention retention{};

    /// Calls visit(name, value, facts) for each member that has a flag.
    template <class Self, class Visit>
    static void rows(Self& self, const Visit& visit) {
        visit("record", self.directory,
              {.help = "Folder to keep every session's particles and meshes in; see meniscus recordings, replay, "
                       "convert",
               .argument = "DIR"});
        visit("record_limit", self.limit,
              {.help = "Bytes of all recordings in that folder, as 100G; 0: no limit. Nothing is deleted: recording "
                       "stops",
               .unit = "bytes",
               .argument = "BYTES"});
        visit("record_attribute_bits", self.attribute_bits,
              {.help = "Bits per component of the float32 attributes in recorded meshes, 1 to 16; 0: exact",
               .range = {.most = max_attribute_bits},
               .argument = "BITS"});
        visit("record_codec", self.codec,
              {.help = "Codec of recorded meshes: entropy, packed or draco",
               .subject = "record codec",
               .argument = "NAME"});
        visit("record_min_frames", self.retention.min_frames,
              {.help = "A recording with fewer frames is deleted when it is closed; 0: none is", .argument = "N"});
        visit("record_max_age", self.retention.max_age,
              {.help = "Seconds after which a recording to which nothing more was written is deleted, as 2592000 for "
                       "30 days; 0: none is",
               .unit = "s",
               .range = {.most = 1e9},
               .argument = "SECONDS"});
    }
};

/// Throws InvalidInput if the directory is not one that can be written to, or made. Makes nothing.
void require_recordable(const RecordingOptions& options);

}  // namespace meniscus::server
