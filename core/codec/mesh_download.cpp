#include "meniscus/mesh_download.hpp"

#include "codec/attribute_values.hpp"
#include "codec/coded_bits.hpp"

namespace meniscus {

std::shared_ptr<PackedBricks> MeshDownload::pack(const Mesh& mesh, const CodingOptions& options) const {
    if (!source_ || !needs_lattice(options.codec)) return nullptr;
    check_normal_bits(options.normal_bits);
    static_cast<void>(encoded_offset_bits(mesh, options));
    for (const CodedAttribute& form : options.attributes) static_cast<void>(attribute_of(mesh, form));
    return source_->pack(options);
}

}  // namespace meniscus
