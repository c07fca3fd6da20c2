// The container of glTF 2.0 in one file (Khronos, "GLB File Format"): a JSON document and one buffer.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace meniscus::files {

/// A buffer's parts and a container's chunks begin at multiples of this.
inline constexpr std::size_t glb_alignment = 4;

constexpr std::size_t glb_aligned(std::size_t bytes) {
    return (bytes + glb_alignment - 1) / glb_alignment * glb_alignment;
}

/// Throws LimitExceeded if the file would have 2^32 bytes or more, which its header cannot say.
std::string glb_container(std::string_view json, std::string_view buffer);

}  // namespace meniscus::files
