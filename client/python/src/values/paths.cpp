#include "values/paths.hpp"

#include <limits>
#include <string>
#include <system_error>

#include "formats/bytes/read_limits.hpp"
#include "meniscus/error.hpp"
#include "values/keywords.hpp"

namespace py = pybind11;

namespace meniscus::python {

std::filesystem::path path_of(const py::object& path) {
    const std::string bytes = py::bytes(py::module_::import("os").attr("fsencode")(path));
    if (bytes.find('\0') != std::string::npos)
        throw InvalidInput("the path '" + bytes.substr(0, bytes.find('\0')) + "...' has a zero byte, must have none");
    return bytes;
}

std::uint64_t size_limit(const py::object& max_bytes) {
    if (max_bytes.is_none()) return formats::usual_most_bytes();
    return whole_number(max_bytes, "max_bytes", std::numeric_limits<std::uint64_t>::max());
}

void check_size(const std::filesystem::path& path, std::uint64_t most_bytes) {
    std::error_code none_told;
    const std::uintmax_t bytes = std::filesystem::file_size(path, none_told);
    if (!none_told && bytes > most_bytes)
        throw LimitExceeded(path.string() + ": has " + std::to_string(bytes) + " bytes; at most " +
                            std::to_string(most_bytes) + " are read: give max_bytes to read more");
}

}  // namespace meniscus::python
