// What processes of one frame send each other: values and arrays, as they lie in memory. They run the same program on
// machines of the same kind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"

namespace meniscus {

class MessageWriter {
public:
    /// memory: of a message before, to be used again.
    explicit MessageWriter(std::vector<std::byte> memory = {}) : bytes_(std::move(memory)) {}

    template <class T>
    void add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        add_bytes(&value, sizeof value);
    }
    template <class T>
    void add_all(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(static_cast<std::uint64_t>(values.size()));
        add_bytes(values.data(), values.size_bytes());
    }
    /// Of values that have `count` numbers each, some, by their places.
    template <class Number>
    void add_some(std::span<const Number> values, std::size_t count, std::span<const std::uint32_t> chosen) {
        add(static_cast<std::uint64_t>(chosen.size() * count));
        const std::size_t size = count * sizeof(Number);
        std::byte* to = room_for(chosen.size() * size);
        const auto copy = [&](auto known_size) {
            const auto* const from = reinterpret_cast<const std::byte*>(values.data());
            for (const std::uint32_t i : chosen) {
                std::memcpy(to, from + i * known_size(), known_size());
                to += known_size();
            }
        };
        // A copy of a size that the compiler knows is an instruction or two.
        if (size == 12)
            copy([] { return std::size_t{12}; });
        else if (size == 4)
            copy([] { return std::size_t{4}; });
        else
            copy([size] { return size; });
    }
    /// Without a count.
    void add_bytes(std::span<const std::byte> bytes) { add_bytes(bytes.data(), bytes.size()); }
    void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
    void add_text(std::string_view text) { add_all(std::span<const char>(text)); }
    std::vector<std::byte> take() {
        bytes_.resize(size_);
        return std::move(bytes_);
    }

private:
    void add_bytes(const void* from, std::size_t size) {
        if (size != 0) std::memcpy(room_for(size), from, size);
    }
    /// Until the next call.
    std::byte* room_for(std::size_t size) {
        size_ += size;
        // Bytes of a message before are not set to zero first.
        if (size_ > bytes_.size()) bytes_.resize(size_);
        return bytes_.data() + (size_ - size);
    }

    std::vector<std::byte> bytes_;
    std::size_t size_ = 0;  ///< of this message
};

/// Throws InvalidInput where a message ends too early: then the processes do not run the same program.
class MessageReader {
public:
    explicit MessageReader(std::span<const std::byte> bytes) : left_(bytes) {}
    [[noreturn]] static void refuse() {
        throw InvalidInput(
            "a process has sent a message that ends too early: all processes of a frame must run the same version");
    }
    bool is_at_end() const { return left_.empty(); }
    std::size_t bytes_left() const { return left_.size(); }

    /// They live as long as the message.
    std::span<const std::byte> get_bytes(std::size_t count) {
        if (count > left_.size()) refuse();
        const std::span<const std::byte> bytes = left_.first(count);
        left_ = left_.subspan(count);
        return bytes;
    }
    template <class T>
    T get() {
        static_assert(std::is_trivially_copyable_v<T>);
        T value{};
        copy(&value, 1);
        return value;
    }
    /// Behind what is there.
    template <class T>
    void append_to(std::vector<T>& values) {
        const auto count = get<std::uint64_t>();
        if (count > left_.size() / sizeof(T)) refuse();
        const std::size_t before = values.size();
        values.resize(before + count);
        copy(values.data() + before, count);
    }
    std::string get_text() {
        std::vector<char> characters;
        append_to(characters);
        return {characters.begin(), characters.end()};
    }

private:
    template <class T>
    void copy(T* to, std::size_t count) {
        if (count > left_.size() / sizeof(T)) refuse();
        if (count != 0) std::memcpy(static_cast<void*>(to), left_.data(), count * sizeof(T));
        left_ = left_.subspan(count * sizeof(T));
    }

    std::span<const std::byte> left_;
};

}  // namespace meniscus
