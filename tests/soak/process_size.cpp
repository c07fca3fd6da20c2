#include "process_size.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace meniscus::soak {

ProcessSize process_size(pid_t process) {
    const std::filesystem::path folder = "/proc/" + std::to_string(process);
    ProcessSize size;
    std::ifstream status(folder / "status");
    std::string word;
    while (status >> word && word != "RssAnon:") {
    }
    if (!(status >> size.memory_bytes)) throw std::runtime_error((folder / "status").string() + " cannot be read");
    size.memory_bytes *= 1024;  // given in kB
    const std::filesystem::directory_iterator descriptors(folder / "fd");
    size.descriptors = static_cast<std::size_t>(std::distance(begin(descriptors), end(descriptors)));
    return size;
}

}  // namespace meniscus::soak
