// A node of Conduit, read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol.h"

namespace meniscus::catalyst {

/// The types of a leaf's elements; `other` is none of them, or of another byte order.
enum class NumberType { int8, int16, int32, int64, uint8, uint16, uint32, uint64, float32, float64, other };
constexpr const char* name_of(NumberType type) {
    constexpr const char* names[]{"int8",   "int16",  "int32",   "int64",   "uint8",          "uint16",
                                  "uint32", "uint64", "float32", "float64", "of another type"};
    return names[static_cast<int>(type)];
}

/// Numbers where they lie; borrowed.
struct Numbers {
    const std::byte* first = nullptr;  ///< null where there are none, or of another type
    std::size_t count = 0;
    std::ptrdiff_t stride = 0;  ///< bytes from one to the next
    NumberType type = NumberType::other;
};

/// Borrowed. One that is not there has no children, no text and no numbers.
class Node {
public:
    explicit Node(const conduit_node* node) : node_(const_cast<conduit_node*>(node)) {}

    explicit operator bool() const { return node_ != nullptr; }
    /// What lies at a path, as "coordsets/coords"; a node that is not there.
    Node at(const std::string& path) const;
    std::vector<Node> children() const;
    std::string name() const;
    /// None of a node that is no text.
    std::optional<std::string> text() const;
    /// Of a leaf; those of any other node are of another type.
    Numbers numbers() const;
    /// The first of a leaf's numbers; none where there is none, or one that is not whole or too large.
    std::optional<std::int64_t> integer() const;
    /// Likewise, whole or not.
    std::optional<double> number() const;

private:
    conduit_node* node_;  ///< Conduit's functions take no const
};

}  // namespace meniscus::catalyst
