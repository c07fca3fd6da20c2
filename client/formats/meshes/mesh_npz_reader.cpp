#include "formats/containers/face_index.hpp"
#include "formats/containers/npz.hpp"
#include "formats/containers/point_numbers.hpp"
#include "formats/meshes/mesh_readers.hpp"
#include "formats/vtk/vtk_dataset.hpp"

namespace meniscus::formats {

TriangleMesh read_mesh_npz(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    NpzReader file(name, bytes, limits);
    for (const char* needed : {"positions", "triangles"})
        if (!file.has(needed))
            file.at().fail("no array " + std::string(needed) + ": a mesh has positions and triangles");
    TriangleMesh mesh;
    const auto rows_of_three = [&](const NpyArray& array, const ByteCursor& at) {
        if (!array.unread.empty()) at.fail("holds " + array.unread + ", not numbers");
        if (array.shape.size() != 2 || array.shape[1] != 3)
            at.fail("has the shape " + shape_text(array.shape) + "; it has (N, 3)");
        file.budget().take(3 * sizeof(double) * array.shape[0], at, "what it holds");
        return array.shape[0];
    };
    file.with("positions", [&](const NpyArray& array, const ByteCursor& at) {
        expect_addressable(rows_of_three(array, at), at);
        mesh.wide = array.type == ScalarType::float64;
        mesh.positions.resize(array.shape[0]);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) mesh.positions[i][axis] = array.at(i, axis);
    });
    const std::size_t count = mesh.positions.size();
    file.with("triangles", [&](const NpyArray& array, const ByteCursor& at) {
        mesh.triangles.resize(rows_of_three(array, at));
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
            for (std::size_t corner = 0; corner < 3; ++corner)
                mesh.triangles[i][corner] = to_index(array.at(i, corner), count, at);
    });
    if (file.has("normals"))
        file.with("normals", [&](const NpyArray& array, const ByteCursor& at) {
            if (rows_of_three(array, at) != count)
                at.fail("has " + std::to_string(array.shape[0]) + " rows, positions have " + std::to_string(count));
            mesh.normals.resize(count);
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    mesh.normals[i][axis] = to_coordinate(array.at(i, axis), i, at);
        });
    if (file.has("levels"))
        file.with("levels", [&](const NpyArray& array, const ByteCursor&) {
            if (!array.has_rows(mesh.triangles.size()) || array.columns() != 1 || !is_integer(array.type)) return;
            for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
                mesh.levels.push_back(to_cell_level(array.at(i, 0)));
        });
    ArrayCollector collector(file.at());
    file.collect(collector, count, {"positions", "triangles", "normals", "levels"});
    std::vector<std::string> left_out;
    collector.finish(mesh.attributes, left_out);
    return mesh;
}

}  // namespace meniscus::formats
