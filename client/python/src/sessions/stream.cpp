#include "sessions/stream.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "meniscus/error.hpp"
#include "text_options/attribute_options.hpp"
#include "text_options/client_options.hpp"
#include "values/arrays_in.hpp"
#include "values/keywords.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

template <client::ArrayNumber Number>
void copy_array(const ParticleArray& array, const client::ParticleBuffer& buffer) {
    std::ranges::copy(array.data, std::as_writable_bytes(buffer.array<Number>(array.name)).begin());
}

void copy_array(const ParticleArray& array, const client::ParticleBuffer& buffer) {
    switch (array.type) {
        case ElementType::float32:
            return copy_array<float>(array, buffer);
        case ElementType::uint8:
            return copy_array<std::uint8_t>(array, buffer);
        case ElementType::int32:
            return copy_array<std::int32_t>(array, buffer);
        case ElementType::uint32:
            return copy_array<std::uint32_t>(array, buffer);
    }
}

/// In memory of the stream's. Throws InvalidInput for a position that is not finite.
client::ParticleBuffer copy_of(const GivenFrame& given, client::Stream& stream) {
    std::vector<client::ArrayForm> forms;
    for (const ParticleArray& array : given.arrays)
        forms.push_back({std::string(array.name), array.type, array.components});
    client::ParticleBuffer buffer = stream.next_buffer(given.positions.count(), !given.levels.empty(), forms);
    given.positions.copy_to(buffer.positions());
    std::ranges::copy(given.levels, buffer.levels().begin());
    for (const ParticleArray& array : given.arrays) copy_array(array, buffer);
    return buffer;
}

}  // namespace

client::StreamOptions stream_options(const text_options::Options& options, const py::object& on_reconnect) {
    return request_of(options, on_reconnect, [](text_options::OptionReader& reader) {
        client::StreamOptions request = text_options::read_stream(reader);
        reader.read("spray", request.spray);
        request.attributes = text_options::read_attribute_wishes(reader);
        return request;
    });
}

std::uint64_t PushedStream::push(const py::object& positions, const py::object& levels, const py::sequence& arrays,
                                 const py::object& index, double time) {
    require_own_process();
    const std::optional<std::uint64_t> given = index_of(index);
    client::ParticleBuffer buffer = copy_of(given_frame(positions, levels, arrays), source_);
    return send_in_turn(given,
                        [this, &buffer, time](std::uint64_t sent) { source_.push(std::move(buffer), sent, time); });
}

bool PushedStream::try_push(const py::object& positions, const py::object& levels, const py::sequence& arrays,
                            const py::object& index, double time) {
    require_own_process();
    const std::optional<std::uint64_t> given = index_of(index);
    const GivenFrame frame = given_frame(positions, levels, arrays);
    const std::unique_lock turn(push_turn_, std::try_to_lock);
    if (!turn) return false;
    const std::uint64_t number = index_.next(given);
    // With the interpreter's lock: it copies, where there is room, and waits for nothing.
    if (!source_.try_push(frame.positions, number, time, frame.levels, frame.arrays)) return false;
    index_.note(number);
    return true;
}

void bind_stream(py::module_& module) {
    bind_source<PushedStream>(module, "Stream")
        .def("push", &PushedStream::push)
        .def("try_push", &PushedStream::try_push)
        .def("finish", &PushedStream::finish)
        .def("dropped", &PushedStream::dropped);
}

}  // namespace meniscus::python
