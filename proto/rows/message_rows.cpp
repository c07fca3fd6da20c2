#include "rows/message_rows.hpp"

#include <google/protobuf/descriptor.h>

#include <cctype>
#include <stdexcept>

namespace meniscus::rows {
namespace {

char to_upper(char c) {
    return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
}

/// "WARNING_CODE_" of WarningCode.
std::string prefix_of(const google::protobuf::EnumDescriptor& type) {
    std::string prefix;
    for (const char c : type.name()) {
        if (std::isupper(static_cast<unsigned char>(c)) != 0 && !prefix.empty()) prefix += '_';
        prefix += to_upper(c);
    }
    return prefix + '_';
}

bool is_unsigned_32(const FieldDescriptor& field) {
    return field.cpp_type() == FieldDescriptor::CPPTYPE_UINT32;
}

}  // namespace

MessageField::MessageField(const Message& message, std::string_view name)
    : field_(message.GetDescriptor()->FindFieldByName(std::string(name))) {
    if (field_ == nullptr)
        throw std::logic_error("message " + message.GetTypeName() + " has no field " + std::string(name));
}

bool MessageField::is_set(const Message& message) const {
    return !field_->has_presence() || message.GetReflection()->HasField(message, field_);
}
Message& MessageField::submessage(Message& message) const {
    return *message.GetReflection()->MutableMessage(&message, field_);
}
const Message& MessageField::submessage(const Message& message) const {
    return message.GetReflection()->GetMessage(message, field_);
}
Message& MessageField::added_submessage(Message& message) const {
    return *message.GetReflection()->AddMessage(&message, field_);
}
std::size_t MessageField::size(const Message& message) const {
    return static_cast<std::size_t>(message.GetReflection()->FieldSize(message, field_));
}
const Message& MessageField::submessage(const Message& message, std::size_t i) const {
    return message.GetReflection()->GetRepeatedMessage(message, field_, static_cast<int>(i));
}

void MessageField::set(Message& message, bool value) const {
    message.GetReflection()->SetBool(&message, field_, value);
}
void MessageField::set(Message& message, double value) const {
    message.GetReflection()->SetDouble(&message, field_, value);
}
void MessageField::set(Message& message, std::uint64_t value) const {
    if (is_unsigned_32(*field_))
        message.GetReflection()->SetUInt32(&message, field_, static_cast<std::uint32_t>(value));
    else
        message.GetReflection()->SetUInt64(&message, field_, value);
}
void MessageField::set(Message& message, const std::string& value) const {
    message.GetReflection()->SetString(&message, field_, value);
}
void MessageField::set(Message& message, std::span<const std::string> values) const {
    for (const std::string& value : values) message.GetReflection()->AddString(&message, field_, value);
}

void MessageField::get(const Message& message, bool& value) const {
    value = message.GetReflection()->GetBool(message, field_);
}
void MessageField::get(const Message& message, double& value) const {
    value = message.GetReflection()->GetDouble(message, field_);
}
void MessageField::get(const Message& message, std::uint64_t& value) const {
    const auto& reflection = *message.GetReflection();
    value = is_unsigned_32(*field_) ? reflection.GetUInt32(message, field_) : reflection.GetUInt64(message, field_);
}
void MessageField::get(const Message& message, std::string& value) const {
    value = message.GetReflection()->GetString(message, field_);
}
void MessageField::get(const Message& message, std::vector<std::string>& values) const {
    values.clear();
    for (std::size_t i = 0; i < size(message); ++i)
        values.push_back(message.GetReflection()->GetRepeatedString(message, field_, static_cast<int>(i)));
}

std::optional<int> MessageField::number_of(std::string_view name) const {
    std::string on_the_wire = prefix_of(*field_->enum_type());
    for (const char c : name) on_the_wire += c == '-' ? '_' : to_upper(c);
    const auto* const value = field_->enum_type()->FindValueByName(on_the_wire);
    if (value == nullptr) return std::nullopt;
    return value->number();
}
void MessageField::set_number(Message& message, int number) const {
    message.GetReflection()->SetEnumValue(&message, field_, number);
}
int MessageField::number(const Message& message) const {
    return message.GetReflection()->GetEnumValue(message, field_);
}

}  // namespace meniscus::rows
