// What a file of a mesh holds.
#pragma once

#include <filesystem>
#include <optional>

#include "formats/mesh_file.hpp"
#include "formats/mesh_format.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::formats {

/// A mesh as it is written: in its canonical order, so that a file tells nothing of the way of its mesh. Of all formats
/// but bricks.
class MeshContent {
public:
    /// ordered: in its canonical order. Does all that takes time but the writing.
    MeshContent(Mesh ordered, MeshFormat format);
    /// To be changed: what is written from then on.
    TriangleMesh& triangles();
    /// time: the time code of a USD file of a sequence. compress: as write_mesh(). Throws as write_mesh() does.
    void write(const std::filesystem::path& path, std::optional<double> time = std::nullopt,
               bool compress = false) const;
    /// What the mesh has beside positions and triangles, without values: for the stage of a sequence of USD files.
    TriangleMesh form() const;

private:
    MeshFormat format_;
    Mesh ordered_;
    std::optional<TriangleMesh> triangles_;  ///< in place of it
};

}  // namespace meniscus::formats
