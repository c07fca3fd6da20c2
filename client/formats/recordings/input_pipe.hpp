// Bytes from front to back, as they come: a pipe, standard input, or a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace meniscus::formats {

class InputPipe {
public:
    /// path: "-" is standard input. A named pipe waits for its writer. Throws InvalidInput if it cannot be read.
    explicit InputPipe(const std::filesystem::path& path);
    ~InputPipe();
    InputPipe(const InputPipe&) = delete;
    InputPipe& operator=(const InputPipe&) = delete;

    /// Waits for bytes, and gives as many as there are, at most as many as there is room for; 0 at the end, and after
    /// stop().
    std::size_t read(std::span<char> room);
    /// Ends a read() that waits, and those to come. Any thread may call it.
    void stop() noexcept;

    /// Throws InvalidInput: "NAME: message".
    [[noreturn]] void fail(const std::string& message) const;

private:
    std::string name_;
    int descriptor_ = -1;
    bool is_own_ = false;  ///< is closed here
    int stopped_ = -1;     ///< an event
};

}  // namespace meniscus::formats
