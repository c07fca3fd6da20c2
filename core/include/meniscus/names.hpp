// The names of choices, as flags, files, JSON and messages have them: of an enumeration, or of a variant.
//
// An enumeration is named by one function beside it, `constexpr std::string_view name_of(E)`: a switch without default,
// so that an enumerator without a name does not compile, which returns nothing for a value that is no enumerator. Its
// enumerators count from 0, or detail::Choices is specialized for it. A variant's alternatives have a static member
// `name` each.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace meniscus {

template <class... T>
constexpr std::string_view name_of(const std::variant<T...>& choice) {
    return std::visit([](const auto& alternative) { return std::string_view(alternative.name); }, choice);
}

/// "auto, cpu or cuda"
std::string listed(std::span<const std::string_view> names);

namespace detail {

template <class E>
struct Choices {
    static constexpr std::size_t count = [] {
        std::size_t n = 0;
        while (!name_of(static_cast<E>(n)).empty()) ++n;
        return n;
    }();
    static constexpr std::array<E, count> all = []<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<E, count>{static_cast<E>(I)...};
    }
    (std::make_index_sequence<count>());
};

template <class... T>
struct Choices<std::variant<T...>> {
    static constexpr std::array<std::variant<T...>, sizeof...(T)> all{T{}...};
};

[[noreturn]] void refuse_name(std::string_view name, std::string_view what, std::span<const std::string_view> allowed);

}  // namespace detail

/// Every enumerator; or every alternative of a variant, with its default parameters.
template <class T>
inline constexpr auto choices = detail::Choices<T>::all;

/// The names of `choices`, in their order.
template <class T>
inline constexpr auto names = [] {
    std::array<std::string_view, choices<T>.size()> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = name_of(choices<T>[i]);
    return all;
}();

/// The choice of this name; none for other names.
template <class T>
constexpr std::optional<T> find_by_name(std::string_view name) {
    for (const T& choice : choices<T>)
        if (name_of(choice) == name) return choice;
    return std::nullopt;
}

/// The same, but throws InvalidInput for other names, with the name and those that are allowed. what: the thing that is
/// chosen, for the message.
template <class T>
T by_name(std::string_view name, std::string_view what) {
    if (const auto choice = find_by_name<T>(name)) return *choice;
    detail::refuse_name(name, what, names<T>);
}

}  // namespace meniscus
