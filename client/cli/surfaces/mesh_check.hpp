// Whether meshes are closed, oriented 2-manifolds, and the exit code for those that are not.
#pragma once

#include <exception>
#include <string>

#include "compare/closedness.hpp"
#include "formats/meshes/triangle_mesh.hpp"

namespace meniscus::cli {

/// Thrown when all is done and written: a mesh has defects, and it was to be checked.
class Defective : public std::exception {
public:
    const char* what() const noexcept override { return "a mesh has defects"; }
};

/// The defects of the mesh's triangles, before any became quadrilaterals.
compare::Defects defects_of(const formats::TriangleMesh& mesh);

class MeshCheck {
public:
    /// One line on stderr for each kind of defect. where: the mesh's file.
    void say(const std::string& where, const compare::Defects& defects);
    /// To be called once all is written. Throws Defective.
    void finish() const;

private:
    bool any_ = false;
};

}  // namespace meniscus::cli
