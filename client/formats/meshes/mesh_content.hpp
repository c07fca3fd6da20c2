// The content of a file of a mesh.
#pragma once

#include <filesystem>
#include <optional>

#include "formats/meshes/mesh_file.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::formats {

/// A mesh as it is written: in its canonical order, so that a file shows nothing of the way of its mesh. Of all formats
/// but bricks.
class MeshContent {
public:
    /// ordered: in its canonical order. Does all that takes time but the writing.
    MeshContent(Mesh ordered, MeshFormat format);
    /// The triangles, to be changed: they are written from then on.
    TriangleMesh& triangles();
    /// Throws as write_mesh() does.
    void write(const std::filesystem::path& path, const MeshWriting& writing = {}) const;
    /// The mesh's form, normals and attributes without values: for the stage of a sequence of USD files.
    TriangleMesh form() const;

private:
    MeshFormat format_;
    Mesh ordered_;
    std::optional<TriangleMesh> triangles_;  ///< in place of it
};

}  // namespace meniscus::formats
