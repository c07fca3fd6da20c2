// Stands in for libcatalyst and the Conduit in it: the functions that an implementation may call, by their names there,
// and trees of nodes for tests to fill. The program that has it exports them, as libcatalyst does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "../../../client/catalyst/src/protocol.h"

/// As Conduit has types, by number.
struct conduit_datatype_impl {
    enum Id { none, object, list, int8, int16, int32, int64, uint8, uint16, uint32, uint64, float32, float64, text };
    Id id = none;
    conduit_index_t count = 0;
    conduit_index_t offset = 0;
    conduit_index_t stride = 0;
    bool is_swapped = false;
};

struct conduit_node_impl {
    std::string name;
    conduit_datatype_impl type;
    std::byte* data = nullptr;  ///< borrowed, or own
    std::vector<std::byte> own;
    std::vector<std::unique_ptr<conduit_node_impl>> children;

    /// The node at a path, made where it is not there.
    conduit_node_impl& operator[](const std::string& path);
    conduit_node_impl* find(const std::string& path);
    conduit_node_impl& append();

    void set(const std::string& text);
    template <class Number>
    requires std::is_arithmetic_v<Number>
    void set(Number number) {
        own.resize(sizeof number);
        *reinterpret_cast<Number*>(own.data()) = number;
        point(reinterpret_cast<Number*>(own.data()), 1);
        data = own.data();
    }
    /// Borrows. offset and stride: bytes; stride 0: without gaps.
    template <class Number>
    void point(const Number* numbers, std::size_t count, std::size_t offset = 0, std::size_t stride = 0) {
        type = {.id = id_of<Number>(),
                .count = static_cast<conduit_index_t>(count),
                .offset = static_cast<conduit_index_t>(offset),
                .stride = static_cast<conduit_index_t>(stride == 0 ? sizeof(Number) : stride)};
        data = const_cast<std::byte*>(reinterpret_cast<const std::byte*>(numbers));
    }

private:
    template <class Number>
    static constexpr conduit_datatype_impl::Id id_of() {
        using T = conduit_datatype_impl;
        if constexpr (std::is_floating_point_v<Number>) return sizeof(Number) == 4 ? T::float32 : T::float64;
        constexpr int size = sizeof(Number) == 1 ? 0 : sizeof(Number) == 2 ? 1 : sizeof(Number) == 4 ? 2 : 3;
        return static_cast<T::Id>((std::is_signed_v<Number> ? T::int8 : T::uint8) + size);
    }
};

namespace meniscus::test {

/// The five calls of Catalyst, by the implementation that CATALYST_IMPLEMENTATION_NAME and _PATHS name, as libcatalyst
/// loads it. Throws std::runtime_error where it would return an error of its own.
class CatalystStandIn {
public:
    CatalystStandIn();
    const catalyst_impl& operator*() const { return *implementation_; }
    const catalyst_impl* operator->() const { return implementation_; }

private:
    const catalyst_impl* implementation_;
};

}  // namespace meniscus::test
