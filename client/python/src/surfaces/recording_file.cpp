// Surfaces on this disk: files of bricks, and the recordings of a meniscusd.
#include <pybind11/pybind11.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "bindings.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/recordings/brick_file.hpp"
#include "formats/recordings/recording.hpp"
#include "meniscus/error.hpp"
#include "settings.hpp"
#include "surfaces/frame.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "values/paths.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

FrameHandle read_bricks(const py::object& given_path, const py::object& max_bytes) {
    require_own_process();
    const std::filesystem::path path = path_of(given_path);
    const std::uint64_t most_bytes = size_limit(max_bytes);
    check_size(path, most_bytes);
    FrameHandle frame;
    without_lock([&] { frame = handle_of(formats::read_bricks(path, formats::read_file(path, most_bytes))); });
    return frame;
}

/// A recording, and those of its frames that have a mesh.
class RecordingFile {
public:
    explicit RecordingFile(const std::filesystem::path& path) : recording_(path) {
        for (const formats::RecordedFrame& frame : recording_.frames())
            if (frame.mesh) frames_.push_back(&frame);
    }

    const formats::Recording& recording() const { return recording_; }
    const std::vector<const formats::RecordedFrame*>& frames() const { return frames_; }
    client::ReceivedFrame read(std::uint64_t place) const {
        if (place >= frames_.size())
            throw InvalidInput(recording_.path().string() + ": there is no frame at the place " +
                               std::to_string(place) + " of " + std::to_string(frames_.size()));
        return recording_.mesh(*frames_[place]);
    }

private:
    formats::Recording recording_;
    std::vector<const formats::RecordedFrame*> frames_;
};

std::unique_ptr<RecordingFile> open(const py::object& given_path) {
    require_own_process();
    const std::filesystem::path path = path_of(given_path);
    std::unique_ptr<RecordingFile> file;
    without_lock([&] { file = std::make_unique<RecordingFile>(path); });
    return file;
}

FrameHandle frame_at(const RecordingFile& file, std::uint64_t place) {
    require_own_process();
    FrameHandle frame;
    without_lock([&] { frame = handle_of(file.read(place)); });
    return frame;
}

/// (index, time) of each frame.
py::list frames(const RecordingFile& file) {
    py::list out;
    for (const formats::RecordedFrame* frame : file.frames())
        out.append(py::make_tuple(frame->index, frame->simulation_time));
    return out;
}

}  // namespace

void bind_recording_file(py::module_& module) {
    module.def("read_bricks", &read_bricks);
    module.def("open_recording_file", &open);
    py::class_<RecordingFile>(module, "RecordingFile", py::module_local())
        .def_property_readonly("session_id", [](const RecordingFile& file) { return file.recording().session_id(); })
        .def_property_readonly("name", [](const RecordingFile& file) { return file.recording().description().name; })
        .def_property_readonly("cut_bytes", [](const RecordingFile& file) { return file.recording().cut_bytes(); })
        .def("settings", [](const RecordingFile& file) { return to_dict(file.recording().settings()); })
        .def("frames", &frames)
        .def("frame", &frame_at);
}

}  // namespace meniscus::python
