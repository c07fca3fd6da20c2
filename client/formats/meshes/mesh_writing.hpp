// How a mesh is written, in formats that leave a choice.
#pragma once

#include <optional>

namespace meniscus::formats {

struct MeshWriting {
    bool compress = false;            ///< smaller, where is_compressible()
    std::optional<double> time = {};  ///< the time code of a USD file; without it its values hold always
};

}  // namespace meniscus::formats
