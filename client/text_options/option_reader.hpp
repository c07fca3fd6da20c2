// Options as texts by name, as the C interface and Python have them: one reader of each set of options serves both.
#pragma once

#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meniscus/names.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::text_options {

/// By name, as the command line's without "--"; durations are in seconds.
using Options = std::map<std::string, std::string, std::less<>>;

/// How a caller's language writes the name of an option, for messages.
using OptionNaming = std::string (*)(std::string_view name);
/// As it stands.
std::string plain_naming(std::string_view name);

/// The shortest text that is read as this number.
std::string number_text(double value);

/// Reads the options of one call. Whatever the call knows is asked for, whether it is set or not; then finish() refuses
/// what is set and was not asked for. What is not set leaves its target as it is. All throw InvalidInput with the
/// option's name and value.
class OptionReader {
public:
    /// options: may be null, for none. They outlive the reader.
    explicit OptionReader(const Options* options, OptionNaming named = plain_naming)
        : options_(options), naming_(named) {}

    void read(std::string_view name, std::string& value);
    void read(std::string_view name, bool& value);
    void read(std::string_view name, double& value);
    void read(std::string_view name, std::optional<Box>& value);
    void read(std::string_view name, std::optional<std::array<double, 3>>& value);
    /// Seconds.
    void read(std::string_view name, std::chrono::milliseconds& value);
    template <std::integral Number>
    void read(std::string_view name, Number& value) {
        if (const std::string* text = find(name)) value = whole_number<Number>(name, *text);
    }
    template <class T>
    void read(std::string_view name, std::optional<T>& value) {
        T given{};
        if (find(name) == nullptr) return;
        read(name, given);
        value = given;
    }
    /// One of the names of a choice.
    template <class Choice>
    void read_choice(std::string_view name, Choice& value) {
        if (const std::string* text = find(name)) value = by_name<Choice>(*text, quoted(name));
    }

    /// What was set, if it was; counts as asked for.
    const std::string* find(std::string_view name);

    void finish() const;
    /// What was asked for, in that order.
    const std::vector<std::string>& known() const noexcept { return known_; }

    /// An option's name as messages have it: option 'NAME'.
    std::string quoted(std::string_view name) const;
    OptionNaming naming() const noexcept { return naming_; }

private:
    template <class Number>
    Number whole_number(std::string_view name, const std::string& text) const;

    const Options* options_;
    OptionNaming naming_;
    std::vector<std::string> known_;
};

}  // namespace meniscus::text_options
