// Python's pickles as a tree of values: nothing in them is called or looked up, so that any bytes are safe to read.
//
// For users of PySPH, whose .npz hold their particles as a pickle; numpy.load() would run what is in it.
#pragma once

#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"

namespace meniscus::formats {

/// The values of one pickle (Python's pickletools: protocols 2 to 5). Text and bytes are borrowed from it.
class Pickle {
public:
    /// Index of a value.
    using Id = std::uint32_t;

    enum class Kind : std::uint8_t {
        none,
        boolean,  ///< number: 0 or 1
        integer,  ///< number
        real,     ///< read over
        text,     ///< text
        bytes,    ///< text
        list,     ///< items; also tuples and sets
        mapping,  ///< items: key, value, key, value
        global,   ///< text: the last part of a name, such as "dtype"
        object,   ///< items: what would be called, its arguments, and the state given to the result, if there is one
    };

    struct Value {
        Kind kind = Kind::none;
        std::int64_t number = 0;
        std::string_view text{};
        std::vector<Id> items{};
    };

    /// budget: the values are taken from it. Throws by `at` for bytes that are no pickle, of an operation that is not
    /// read, or of too many values.
    Pickle(const ByteCursor& at, std::string_view bytes, ReadBudget& budget);

    Id root() const { return root_; }
    const Value& operator[](Id id) const { return values_[id]; }
    /// The value of a mapping by a key of text; null without one.
    const Value* find(const Value& mapping, std::string_view key) const;
    /// The i-th item; null without one.
    const Value* item(const Value& value, std::size_t i) const {
        return i < value.items.size() ? &values_[value.items[i]] : nullptr;
    }

private:
    void run();
    void step(unsigned char operation);
    void push(Value value);
    void pay(std::size_t bytes) { budget_.take(bytes, in_, "its pickle"); }
    /// Keeps the value on top of the stack.
    void remember(std::uint64_t place);
    Id pop();
    /// The values since the last mark.
    std::vector<Id> pop_to_mark();
    void gather(std::size_t count);
    void get(std::uint64_t place);
    std::uint64_t little_endian(std::size_t size);
    std::int64_t signed_integer(std::size_t size);
    void text_of(std::uint64_t size, Kind kind);
    Value& top();
    void append(Value& to, std::vector<Id> items);

    ByteCursor in_;
    ReadBudget& budget_;
    std::vector<Value> values_;
    std::vector<Id> stack_;
    std::vector<std::size_t> marks_;
    std::unordered_map<std::uint64_t, Id> memo_;
    std::size_t items_ = 0;  ///< of all lists and mappings
    Id root_ = 0;
};

}  // namespace meniscus::formats
