#include "formats/recordings/input_pipe.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "formats/bytes/standard_streams.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

InputPipe::InputPipe(const std::filesystem::path& path) : name_(input_name(path)) {
    stopped_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (stopped_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
    if (is_standard_stream(path)) {
        descriptor_ = STDIN_FILENO;
        return;
    }
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0) {
        const int error = errno;
        ::close(stopped_);
        fail("cannot be opened for reading: " + std::generic_category().message(error));
    }
    is_own_ = true;
}

InputPipe::~InputPipe() {
    if (is_own_) ::close(descriptor_);
    ::close(stopped_);
}

std::size_t InputPipe::read(std::span<char> room) {
    while (true) {
        std::array<pollfd, 2> waited{pollfd{.fd = stopped_, .events = POLLIN, .revents = 0},
                                     pollfd{.fd = descriptor_, .events = POLLIN, .revents = 0}};
        if (::poll(waited.data(), waited.size(), -1) < 0) {
            if (errno == EINTR) continue;
            fail("cannot be waited for: " + std::generic_category().message(errno));
        }
        if (waited[0].revents != 0) return 0;
        const ssize_t count = ::read(descriptor_, room.data(), room.size());
        if (count >= 0) return static_cast<std::size_t>(count);
        if (errno != EINTR && errno != EAGAIN) fail("cannot be read: " + std::generic_category().message(errno));
    }
}

void InputPipe::stop() noexcept {
    constexpr std::uint64_t once = 1;
    [[maybe_unused]] const ssize_t written = ::write(stopped_, &once, sizeof once);
}

void InputPipe::fail(const std::string& message) const {
    throw InvalidInput(name_ + ": " + message);
}

}  // namespace meniscus::formats
