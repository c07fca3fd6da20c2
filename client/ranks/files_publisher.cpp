#include "ranks/files_publisher.hpp"

#include <system_error>
#include <utility>

#include "formats/meshes/mesh_writers.hpp"
#include "formats/meshes/triangle_mesh.hpp"
#include "meniscus/error.hpp"

namespace meniscus::ranks {

std::string FilesPublisher::open(const MakerPlace& place) {
    if (place.number == 0)
        list_.emplace(folder_, place.run);
    else if (!SurfaceList::is_in(folder_, place.run))
        throw InvalidInput(
            "option 'output' is '" + folder_.string() +
            "', but that folder has not the list here that the first rank that reconstructs has just made "
            "in its own: name a folder that all machines share");
    return {};
}

void FilesPublisher::show(const LivePart& part) {
    const std::size_t parts = part.report.own_vertices.size();
    if (list_) {
        list_->write_in_time();
        list_->add({part.index, part.simulation_time, parts});
    }
    if (part.mesh == nullptr) return;
    std::filesystem::path file = folder_ / surface_name(part.index, part.number, parts);
    formats::TriangleMesh mesh = formats::to_triangles(*part.mesh);
    // A border's vertices are the same in all parts.
    mesh.wide = formats::needs_double(part.report.farthest);
    formats::write_mesh_vtp(file, mesh);
    shown_ = std::move(file);
}

void FilesPublisher::confirm() noexcept {
    if (list_) list_->confirm();
    shown_.clear();
}

void FilesPublisher::leave() noexcept {
    std::error_code ignored;
    if (!shown_.empty()) std::filesystem::remove(shown_, ignored);
    shown_.clear();
    if (list_) list_->withdraw();
}

void FilesPublisher::finish() {
    if (list_) list_->write();
}

}  // namespace meniscus::ranks
