#include "ranks/files_publisher.hpp"

#include <system_error>
#include <utility>

#include "formats/meshes/mesh_writers.hpp"
#include "formats/meshes/triangle_mesh.hpp"
#include "meniscus/error.hpp"

namespace meniscus::ranks {

std::string FilesPublisher::open(const MakerPlace& place) {
    std::error_code ignored;
    if (place.number == 0)
        list_.emplace(folder_);
    else if (!std::filesystem::is_directory(folder_, ignored))
        throw InvalidInput("option 'output' is '" + folder_.string() +
                           "', which the first rank that reconstructs has made, and which is not there for this one: "
                           "name a folder that the machines share");
    return {};
}

void FilesPublisher::show(const LivePart& part) {
    list_shown();
    if (list_) list_->write_in_time();
    Shown shown{{part.index, part.simulation_time, part.report.own_vertices.size()}, {}};
    if (part.mesh != nullptr) {
        shown.file = surface_file(folder_, part.index, part.number, shown.frame.parts);
        formats::write_mesh_vtp(shown.file, formats::to_triangles(*part.mesh));
    }
    shown_ = std::move(shown);
}

void FilesPublisher::list_shown() {
    if (shown_ && list_) list_->add(shown_->frame);
    shown_.reset();
}

void FilesPublisher::leave() noexcept {
    std::error_code ignored;
    if (shown_ && !shown_->file.empty()) std::filesystem::remove(shown_->file, ignored);
    shown_.reset();
}

void FilesPublisher::finish() {
    list_shown();
    if (list_) list_->write();
}

}  // namespace meniscus::ranks
