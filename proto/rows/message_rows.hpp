// Described records (meniscus/described.hpp) and messages whose fields have the names of their rows: filled from each
// other by protobuf's reflection.
//
// An enumerator NAME of an enum is TYPE_NAME on the wire, an alternative of a variant the field of its name in a oneof,
// an array with named entries, and a record, a message, a duration a double of seconds. An optional without a value is
// a field that is not set.
#pragma once

#include <google/protobuf/message.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "meniscus/described.hpp"
#include "meniscus/names.hpp"
#include "meniscus/seconds.hpp"

namespace meniscus::rows {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// A field of a message, for reading and writing. The search for it by its name is what filling a message costs: some
/// 2 us for the figures of a frame.
class MessageField {
public:
    /// The message has a field of this name, or the program is wrong: std::logic_error.
    MessageField(const Message& message, std::string_view name);

    bool is_set(const Message& message) const;
    Message& submessage(Message& message) const;
    const Message& submessage(const Message& message) const;
    Message& added_submessage(Message& message) const;
    std::size_t size(const Message& message) const;
    const Message& submessage(const Message& message, std::size_t i) const;

    void set(Message& message, bool value) const;
    void set(Message& message, double value) const;
    void set(Message& message, std::uint64_t value) const;
    void set(Message& message, const std::string& value) const;
    void set(Message& message, std::span<const std::string> values) const;
    void get(const Message& message, bool& value) const;
    void get(const Message& message, double& value) const;
    void get(const Message& message, std::uint64_t& value) const;
    void get(const Message& message, std::string& value) const;
    void get(const Message& message, std::vector<std::string>& values) const;

    /// The number of the enumerator with that name, of a field that is an enum; none if there is no such enumerator.
    std::optional<int> number_of(std::string_view name) const;
    void set_number(Message& message, int number) const;
    int number(const Message& message) const;

private:
    const FieldDescriptor* field_;
};

/// Called for a number on the wire that is no enumerator here: with the row's name and the number. Where it returns,
/// the member stays as it is.
using UnknownChoice = void (*)(std::string_view name, int number);

template <class T>
concept Choice = requires(T value) {
    requires std::is_enum_v<T>;
    name_of(value);
};

template <Described Record>
void fill_message(const Record& record, Message& message);
template <Described Record>
void fill_record(const Message& message, Record& record, UnknownChoice refuse);

template <class Value>
void write(const Value& value, Message& message, const MessageField& field, const Facts& facts) {
    if constexpr (std::same_as<Value, bool> || std::same_as<Value, double> || std::same_as<Value, std::string>)
        field.set(message, value);
    else if constexpr (std::unsigned_integral<Value>)
        field.set(message, std::uint64_t{value});
    else if constexpr (std::same_as<Value, std::chrono::milliseconds>)
        field.set(message, seconds_of(value));
    else if constexpr (Choice<Value>)
        field.set_number(message, field.number_of(name_of(value)).value_or(0));
    else if constexpr (std::same_as<Value, std::vector<std::string>>)
        field.set(message, std::span<const std::string>(value));
    else if constexpr (Described<Value>)
        fill_message(value, field.submessage(message));
    else if constexpr (requires { value.has_value(); }) {
        if (value) write(*value, message, field, facts);
    } else if constexpr (requires { std::tuple_size<Value>::value; }) {
        Message& entries = field.submessage(message);
        for (std::size_t i = 0; i < value.size(); ++i)
            write(value[i], entries, MessageField(entries, facts.entries[i]), facts);
    } else {
        for (const auto& element : value) fill_message(element, field.added_submessage(message));
    }
}

template <class Value>
void read(const Message& message, const MessageField& field, const Facts& facts, std::string_view name, Value& value,
          UnknownChoice refuse) {
    if constexpr (std::same_as<Value, bool> || std::same_as<Value, double> || std::same_as<Value, std::string> ||
                  std::same_as<Value, std::vector<std::string>>) {
        field.get(message, value);
    } else if constexpr (std::unsigned_integral<Value>) {
        std::uint64_t number = 0;
        field.get(message, number);
        value = static_cast<Value>(number);
    } else if constexpr (Choice<Value>) {
        const int number = field.number(message);
        bool is_known = number == 0;
        for (const Value choice : choices<Value>)
            if (field.number_of(name_of(choice)) == number) {
                value = choice;
                is_known = true;
            }
        if (!is_known) refuse(name, number);
    } else if constexpr (Described<Value>) {
        fill_record(field.submessage(message), value, refuse);
    } else if constexpr (requires { value.has_value(); }) {
        read(message, field, facts, name, value.emplace(), refuse);
    } else if constexpr (requires { std::tuple_size<Value>::value; }) {
        const Message& entries = field.submessage(message);
        for (std::size_t i = 0; i < value.size(); ++i)
            read(entries, MessageField(entries, facts.entries[i]), facts, name, value[i], refuse);
    } else {
        // What is more than a receiver wants is not believed.
        const double most = facts.range.most;
        value.resize(std::isinf(most) ? field.size(message)
                                      : std::min(field.size(message), static_cast<std::size_t>(most)));
        for (std::size_t i = 0; i < value.size(); ++i) fill_record(field.submessage(message, i), value[i], refuse);
    }
}

/// Sets every field that has a row; those of other names stay as they are.
template <Described Record>
void fill_message(const Record& record, Message& message) {
    Record::rows([&]<class Value>(std::string_view name, Value Record::*member, const Facts& facts, const auto&...) {
        const Value& value = record.*member;
        if constexpr (is_variant<Value>)
            std::visit(
                [&](const auto& chosen) {
                    fill_message(chosen, MessageField(message, chosen.name).submessage(message));
                },
                value);
        else
            write(value, message, MessageField(message, name), facts);
    });
}

namespace detail {

template <class... Alternative>
void read_alternative(const Message& message, std::variant<Alternative...>& choice, UnknownChoice refuse) {
    const auto read_if_set = [&]<class A>(std::type_identity<A>) {
        const MessageField field(message, A::name);
        if (field.is_set(message)) fill_record(field.submessage(message), choice.template emplace<A>(), refuse);
    };
    (read_if_set(std::type_identity<Alternative>{}), ...);
}

}  // namespace detail

/// Members whose fields are not set stay as they are.
template <Described Record>
void fill_record(const Message& message, Record& record, UnknownChoice refuse) {
    Record::rows([&]<class Value>(std::string_view name, Value Record::*member, const Facts& facts, const auto&...) {
        if constexpr (is_variant<Value>) {
            detail::read_alternative(message, record.*member, refuse);
        } else {
            const MessageField field(message, name);
            if (field.is_set(message)) read(message, field, facts, name, record.*member, refuse);
        }
    });
}

}  // namespace meniscus::rows
