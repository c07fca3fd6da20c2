// Parts that the targets share.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "meniscus/brick_coding.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh.hpp"
#include "targets.hpp"

namespace meniscus::fuzz {

/// Ends the program unless a property of accepted input holds.
inline void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "broken: %s\n", what);
    std::abort();
}

/// Runs what may refuse its input, and may do so in no other way.
template <class Function>
void may_refuse(Function&& function) {
    try {
        function();
    } catch (const InvalidInput&) {
    } catch (const LimitExceeded&) {
    } catch (const client::ServerError&) {
    }
}

/// Takes little-endian numbers and pieces off the front; what is missing reads as zero.
class Front {
public:
    explicit Front(Bytes bytes) : rest_(bytes) {}

    bool empty() const { return rest_.empty(); }
    Bytes piece(std::size_t size) {
        const Bytes taken = rest_.substr(0, size);
        rest_.remove_prefix(taken.size());
        return taken;
    }
    std::uint32_t number(std::size_t bytes) {
        std::uint32_t value = 0;
        unsigned shift = 0;
        for (const char c : piece(bytes)) {
            value |= std::uint32_t{static_cast<unsigned char>(c)} << shift;
            shift += 8;
        }
        return value;
    }
    Bytes rest() const { return rest_; }

private:
    Bytes rest_;
};

inline std::string number_bytes(std::uint32_t value, std::size_t bytes) {
    std::string out;
    for (std::size_t i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xFFU);
    return out;
}

/// A list of messages, each after its length in two bytes.
template <class Message>
std::string join(const std::vector<Message>& messages) {
    std::string out;
    for (const Message& message : messages) {
        const std::string bytes = message.SerializeAsString();
        out += number_bytes(static_cast<std::uint32_t>(bytes.size()), 2) + bytes;
    }
    return out;
}

/// A small mesh with all that bricks can have: normals, three levels, crack filling, two bricks. attributes: also a
/// `velocity` (float32 x 3), a `color` (uint8 x 4) and an `id` (uint32).
Mesh sample_mesh(bool attributes = false);

}  // namespace meniscus::fuzz
