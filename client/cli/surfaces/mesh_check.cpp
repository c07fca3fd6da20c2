#include "cli/surfaces/mesh_check.hpp"

#include <iostream>

namespace meniscus::cli {

compare::Defects defects_of(const formats::TriangleMesh& mesh) {
    return compare::find_defects({mesh.positions, mesh.triangles});
}

void MeshCheck::say(const std::string& where, const compare::Defects& defects) {
    any_ = any_ || !defects.closed();
    for (const std::string& line : defects.lines()) std::cerr << "meniscus: check: " << where << ": " << line << '\n';
}

void MeshCheck::finish() const {
    if (any_) throw Defective();
}

}  // namespace meniscus::cli
