#include "values/device_arrays.hpp"

#include <cstdint>
#include <optional>

#include "meniscus/error.hpp"
#include "values/keywords.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// The parts of an interface, versions 2 and 3.
struct DeviceArray {
    std::string what;  ///< for messages
    std::string type;
    std::vector<std::size_t> shape;
    const void* data = nullptr;
    std::optional<std::uintptr_t> stream;  ///< none: nothing has to be waited for, or the stream is not given

    std::string form() const {
        std::string text = type + " of the shape (";
        for (std::size_t i = 0; i < shape.size(); ++i) text += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
        return text + (shape.size() == 1 ? ",)" : ")");
    }
};

py::object entry(const py::dict& interface, const char* name) {
    return interface.contains(name) ? py::object(interface[name]) : py::none();
}

[[noreturn]] void refuse(const std::string& what, const char* part, const py::handle& value,
                         const std::string& wanted) {
    throw InvalidInput(what + ": '" + part + "' of its __cuda_array_interface__ is " +
                       std::string(py::str(py::repr(value))) + ", must be " + wanted);
}

std::uintptr_t address_of(const py::handle& value, const std::string& what, const char* part) {
    constexpr auto largest = static_cast<std::uint64_t>(UINTPTR_MAX);
    return whole_number(py::reinterpret_borrow<py::object>(value), what + ": '" + part + "'", largest);
}

std::vector<std::size_t> shape_of(const std::string& what, const py::object& shape) {
    if (!py::isinstance<py::tuple>(shape)) refuse(what, "shape", shape, "a tuple of whole numbers");
    std::vector<std::size_t> lengths;
    for (const py::handle length : shape) lengths.push_back(address_of(length, what, "shape"));
    return lengths;
}

/// Without strides the array is in C order.
void check_order(const DeviceArray& array, const py::object& strides, std::size_t element_bytes) {
    if (strides.is_none()) return;
    std::size_t wanted = element_bytes;
    std::vector<std::size_t> c_order(array.shape.size());
    for (std::size_t i = array.shape.size(); i-- > 0;) {
        c_order[i] = wanted;
        wanted *= array.shape[i];
    }
    bool is_c_order = py::isinstance<py::tuple>(strides) && py::len(strides) == c_order.size();
    for (std::size_t i = 0; is_c_order && i < c_order.size(); ++i) {
        // numpy's strides say nothing for one element.
        const py::object stride = py::cast<py::tuple>(strides)[i];
        is_c_order = array.shape[i] < 2 || stride.equal(py::int_(c_order[i]));
    }
    if (!is_c_order && wanted != 0) refuse(array.what, "strides", strides, "None, which is C order: copy the array");
}

std::optional<std::uintptr_t> stream_of(const std::string& what, const py::object& stream) {
    if (stream.is_none()) return std::nullopt;
    const std::uintptr_t handle = address_of(stream, what, "stream");
    if (handle == 0) refuse(what, "stream", stream, "1 for the default stream");
    return handle;
}

std::size_t element_bytes_of(const std::string& what, const py::object& type) {
    for (const char* const known : {"<f4", "<i4", "<u4"})
        if (type.equal(py::str(known))) return 4;
    if (type.equal(py::str("|u1"))) return 1;
    refuse(what, "typestr", type, "'<f4', '|u1', '<i4' or '<u4': convert the array");
}

DeviceArray device_array(const std::string& what, const py::dict& interface) {
    DeviceArray array;
    array.what = what;
    const py::object type = entry(interface, "typestr");
    const std::size_t element_bytes = element_bytes_of(what, type);
    array.type = py::cast<std::string>(type);
    array.shape = shape_of(what, entry(interface, "shape"));
    const py::object data = entry(interface, "data");
    if (!py::isinstance<py::tuple>(data) || py::len(data) != 2)
        refuse(what, "data", data, "an address and whether it is read-only");
    // NOLINTNEXTLINE(performance-no-int-to-ptr): so Python tells addresses
    array.data = reinterpret_cast<const void*>(address_of(py::cast<py::tuple>(data)[0], what, "data"));
    if (!entry(interface, "mask").is_none()) refuse(what, "mask", entry(interface, "mask"), "None");
    check_order(array, entry(interface, "strides"), element_bytes);
    array.stream = stream_of(what, entry(interface, "stream"));
    return array;
}

void check_form(const DeviceArray& array, bool is_right, const std::string& wanted) {
    if (!is_right) throw InvalidInput(array.what + " is " + array.form() + ", must be " + wanted);
}

void check_length(const DeviceArray& array, std::size_t particles) {
    if (array.shape[0] != particles)
        throw InvalidInput(array.what + " has " + std::to_string(array.shape[0]) +
                           " entries, must have one for each of the " + std::to_string(particles) + " particles");
}

ElementType element_type_of(const std::string& type) {
    if (type == "<f4") return ElementType::float32;
    if (type == "<i4") return ElementType::int32;
    return type == "<u4" ? ElementType::uint32 : ElementType::uint8;
}

/// The reconstruction waits for one stream.
void add_stream(DeviceParticleFrame& frame, const DeviceArray& array) {
    if (!array.stream) return;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): likewise
    void* const stream = reinterpret_cast<void*>(*array.stream);
    if (frame.stream != nullptr && frame.stream != stream)
        throw InvalidInput(array.what + " is on another stream than the arrays before it: synchronize one of them");
    frame.stream = stream;
}

}  // namespace

DeviceArrays::DeviceArrays(const py::dict& positions, const py::object& levels, const py::sequence& arrays) {
    const DeviceArray places = device_array("positions", positions);
    check_form(places, places.type == "<f4" && places.shape.size() == 2 && places.shape[1] == 3,
               "(N, 3) of '<f4', which is float32");
    frame_.positions = static_cast<const float*>(places.data);
    frame_.count = places.shape[0];
    add_stream(frame_, places);
    if (!levels.is_none()) {
        const DeviceArray given = device_array("levels", py::cast<py::dict>(levels));
        check_form(given, given.type == "|u1" && given.shape.size() == 1, "(N,) of '|u1', which is uint8");
        check_length(given, frame_.count);
        frame_.levels = static_cast<const std::uint8_t*>(given.data);
        add_stream(frame_, given);
    }
    for (const py::handle pair : arrays) {
        const auto [name, interface] = py::cast<std::pair<std::string, py::dict>>(pair);
        const DeviceArray given = device_array("the attribute '" + name + "'", interface);
        const bool has_columns = given.shape.size() == 2;
        check_form(given, given.shape.size() == 1 || (has_columns && given.shape[1] > 0 && given.shape[1] <= 16),
                   "(N,) or (N, components)");
        check_length(given, frame_.count);
        ParticleArray array;
        array.name = names_.emplace_back(name);
        array.type = element_type_of(given.type);
        array.components = has_columns ? given.shape[1] : 1;
        array.data = {static_cast<const std::byte*>(given.data), frame_.count * array.element_bytes()};
        arrays_.push_back(array);
        add_stream(frame_, given);
    }
    frame_.arrays = arrays_;
}

}  // namespace meniscus::python
