// Publications: read from bytes that Python has fetched, and written to a folder.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "bindings.hpp"
#include "files/publication_format.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/client/publication.hpp"
#include "meniscus/client/publication_writer.hpp"
#include "meniscus/error.hpp"
#include "pages/publication_pages.hpp"
#include "settings.hpp"
#include "surfaces/frame.hpp"
#include "surfaces/mesh.hpp"
#include "text_options/settings_options.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "values/keywords.hpp"
#include "values/paths.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// A publication whose files Python fetches. Calls of several threads take turns.
class FetchedPublication {
public:
    FetchedPublication(const std::string& name, std::string manifest)
        : manifest_(std::move(manifest)), publication_(name, [this](const std::string& file, std::uint64_t) {
              return file == files::manifest_name ? manifest_ : *segment_;
          }) {}

    client::PublicationInfo info() {
        const std::lock_guard turn(turn_);
        return publication_.info();
    }
    void refresh(std::string manifest) {
        const std::lock_guard turn(turn_);
        manifest_ = std::move(manifest);
        publication_.refresh();
    }
    /// The name and the size of the file that has the frame of a place; none: the frame is not there.
    std::optional<std::pair<std::string, std::uint64_t>> segment_of(std::uint64_t place) {
        const std::lock_guard turn(turn_);
        std::uint64_t first = publication_.info().left_frames;
        for (const client::PublishedSegment& segment : publication_.info().segments) {
            if (place >= first && place - first < segment.frames) return std::pair(segment.file(), segment.bytes);
            first += segment.frames;
        }
        return std::nullopt;
    }
    /// segment: the bytes of its file.
    client::ReceivedFrame frame(std::uint64_t place, const std::string& segment) {
        const std::lock_guard turn(turn_);
        segment_ = &segment;
        return publication_.frame(place);
    }

private:
    std::mutex turn_;
    std::string manifest_;
    const std::string* segment_ = nullptr;
    client::Publication publication_;
};

using Handle = std::shared_ptr<FetchedPublication>;

Handle open(const std::string& name, const std::string& manifest) {
    require_own_process();
    Handle opened;
    without_lock([&] { opened = std::make_shared<FetchedPublication>(name, manifest); });
    return opened;
}

FrameHandle frame_at(const Handle& publication, std::uint64_t place, const std::string& segment) {
    require_own_process();
    FrameHandle frame;
    without_lock([&] { frame = handle_of(publication->frame(place, segment)); });
    return frame;
}

py::dict to_dict(const client::PublicationInfo& info) {
    py::dict out;
    out["name"] = info.description.name;
    out["length_unit"] = info.description.length_unit;
    out["up_axis"] = std::string(client::name_of(info.description.up_axis));
    out["settings"] = info.settings ? py::object(python::to_dict(*info.settings)) : py::none();
    out["live"] = info.live;
    out["left_frames"] = info.left_frames;
    out["frames"] = info.frames;
    out["bytes"] = info.bytes;
    py::list files;
    for (const client::PublishedSegment& segment : info.segments)
        files.append(py::make_tuple(segment.file(), segment.bytes));
    out["files"] = files;
    return out;
}

client::UpAxis axis_of(const std::string& name) {
    for (const client::UpAxis axis : {client::UpAxis::x, client::UpAxis::y, client::UpAxis::z})
        if (client::name_of(axis) == name) return axis;
    if (name.empty()) return client::UpAxis::unspecified;
    throw InvalidInput("up_axis is '" + name + "', must be x, y or z");
}

using Writer = std::shared_ptr<client::PublicationWriter>;

/// settings: as Reconstructor takes them; none: not known.
Writer make_writer(const py::object& given_folder, const std::optional<text_options::Options>& settings,
                   const std::string& name, const std::string& up_axis, const std::string& length_unit, bool live,
                   std::optional<double> keep) {
    require_own_process();
    const std::filesystem::path folder = path_of(given_folder);
    std::optional<Settings> known;
    if (settings) {
        auto reader = reader_of(*settings);
        known = text_options::read_settings(reader);
        reader.finish();
    }
    client::PublishOptions options{
        .description = {.name = name, .up_axis = axis_of(up_axis), .length_unit = length_unit},
        .live = live,
        .keep_seconds = keep};
    Writer writer;
    without_lock([&] { writer = std::make_shared<client::PublicationWriter>(folder, known, options); });
    return writer;
}

void add_frame(const Writer& writer, const FrameHandle& frame, double seconds) {
    require_own_process();
    without_lock([&] { writer->add(*frame.frame, seconds); });
}

/// A mesh that was reconstructed here, or one of a frame that travelled.
void add_mesh(const Writer& writer, const MeshHandle& mesh, std::uint64_t index, double time, double seconds) {
    require_own_process();
    without_lock([&] {
        CodingOptions options{.codec = Codec::lattice_entropy};
        const std::vector<AttributeWish> all{{.name = {}, .bits = default_attribute_bits}};
        options.attributes = coded_attributes(*mesh.mesh, attribute_ranges(*mesh.mesh), all);
        const auto* const statistics = std::get_if<Statistics>(&mesh.origin);
        writer->add(client::encode_frame(*mesh.mesh, statistics ? *statistics : Statistics{}, index, time, options),
                    seconds);
    });
}

}  // namespace

void bind_publication(py::module_& module) {
    module.def("open_publication", &open);
    py::class_<FetchedPublication, Handle>(module, "Publication", py::module_local())
        .def("info", [](const Handle& publication) { return to_dict(publication->info()); })
        .def("refresh", [](const Handle& publication,
                           const std::string& manifest) { without_lock([&] { publication->refresh(manifest); }); })
        .def("segment_of",
             [](const Handle& publication, std::uint64_t place) { return publication->segment_of(place); })
        .def("frame", &frame_at);
    module.def("make_publication_writer", &make_writer);
    py::class_<client::PublicationWriter, Writer>(module, "PublicationWriter", py::module_local())
        .def("has",
             [](const Writer& writer, std::uint64_t run_id, std::uint64_t index) { return writer->has(run_id, index); })
        .def("add_frame", &add_frame)
        .def("add_mesh", &add_mesh)
        .def("flush", [](const Writer& writer) { without_lock([&] { writer->flush(); }); })
        .def("finish", [](const Writer& writer) { without_lock([&] { writer->finish(); }); });
    module.def("write_site", [](const py::object& folder) {
        const std::filesystem::path path = path_of(folder);
        without_lock([&] { pages::write_site(path); });
    });
    module.def("single_page", [] {
        const pages::SinglePage page = pages::single_page();
        return py::make_tuple(page.before, page.behind);
    });
}

}  // namespace meniscus::python
