// Described records: a row for each member of a record, over which every face of the program is one loop: messages,
// flags, texts by name, JSON, Python's dict, and the tables of the documents.
//
// A record has a static function template `rows(visit)`, which calls visit(name, member, facts) for each member, in the
// order of the documents; an optional member may have, as a fourth argument, the function that tells what is in force
// where there is no value. The alternatives of a variant are records with rows of their own. See Settings. (The options
// of the server lie in nested records, in an order of their own: their rows are over values, see Limits.)
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace meniscus {

/// The least of a range of real numbers greater than 0.
inline constexpr double above_zero = std::numeric_limits<double>::denorm_min();

/// The numbers that a member may have, both ends among them. Others are refused as `advice` says.
struct Range {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    std::string_view advice{};
};

/// The facts about a member beside its name and type.
struct Facts {
    std::string_view help{};      ///< one sentence, as in --help: without `when`, and without the full stop
    std::string_view unit{};      ///< "s", "bytes", "radii"
    Range range{};                ///< of a number; of a list that is received: its length
    std::string_view when{};      ///< the choice with which it applies, as flags have it: "--field smooth"
    std::string_view subject{};   ///< of a refusal, "iso value is": if it is not the name in words
    std::string_view option{};    ///< name of the flag and of the option by text, if it is not `name`
    char letter = '\0';           ///< of the short flag
    std::string_view argument{};  ///< the value's name in --help, where its type says too little: "FILE"
    std::string_view standard{};  ///< the default in words, where the member's own says too little
    std::string_view group{};     ///< heading of the flag in --help
    std::span<const std::string_view> entries{};  ///< names of an array's elements
    bool by_hand = false;                         ///< whether flags and texts show it by hand, as they do lists
    std::string_view gauge{};                     ///< of a limit: its name in the server's metrics
};

namespace detail {

template <class Value>
struct Held {
    using Type = Value;
};
template <class Value>
struct Held<std::optional<Value>> {
    using Type = Value;
};

}  // namespace detail

/// The type of a value, whether or not it may be missing.
template <class Value>
using Held = typename detail::Held<Value>::Type;

/// What is in force in a record where an optional member has no value.
template <class Record, class Value>
using InForce = Held<Value> (*)(const Record&);

/// By this name, since nvcc writes parentheses around others, of which gcc warns.
template <class Record, class Value>
using MemberPointer = std::type_identity_t<Value Record::*>;

/// A member of a record. Value: its type, or that of a parameter of the alternative that a choice has.
template <class Record, class Value>
struct Row {
    using Type = Value;
    std::string_view name;
    MemberPointer<Record, Value> member;
    Facts facts;
    InForce<Record, Value> in_force = nullptr;

    const Value* find(const Record& record) const { return &(record.*member); }
    Value* find(Record& record) const { return &(record.*member); }
};

/// A parameter of an alternative of a choice: there only while the alternative is chosen.
template <class Record, class Choice, class Alternative, class Value>
struct ParameterRow {
    using Type = Value;
    std::string_view name;
    MemberPointer<Alternative, Value> member;
    Facts facts;
    InForce<Record, Value> in_force;
    std::string_view choice_name;
    MemberPointer<Record, Choice> choice;

    const Value* find(const Record& record) const {
        const auto* const chosen = std::get_if<Alternative>(&(record.*choice));
        return chosen == nullptr ? nullptr : &(chosen->*member);
    }
    Value* find(Record& record) const {
        auto* const chosen = std::get_if<Alternative>(&(record.*choice));
        return chosen == nullptr ? nullptr : &(chosen->*member);
    }
    static constexpr std::string_view alternative = Alternative::name;
    Value standard() const { return Alternative{}.*member; }
};

/// A record that has rows.
template <class T>
concept Described = requires {
    T::rows([](const auto&...) {});
};

template <class T>
inline constexpr bool is_list = false;
template <class T>
inline constexpr bool is_list<std::vector<T>> = true;

template <class T>
inline constexpr bool is_variant = false;
template <class... T>
inline constexpr bool is_variant<std::variant<T...>> = true;

namespace detail {

template <class Record, class Alternative, class Choice, class Visit>
void visit_parameters(std::string_view choice_name, Choice Record::*choice, const Visit& visit) {
    Alternative::rows([&]<class Value>(std::string_view name, Value Alternative::*member, const Facts& facts,
                                       InForce<Record, Value> in_force = nullptr) {
        visit(ParameterRow<Record, Choice, Alternative, Value>{name, member, facts, in_force, choice_name, choice});
    });
}

template <class Record, class... Alternative, class Visit>
void visit_alternatives(std::string_view name, std::variant<Alternative...> Record::*choice, const Visit& visit) {
    (visit_parameters<Record, Alternative>(name, choice, visit), ...);
}

}  // namespace detail

/// Calls visit(row) for each row of a record, and after a choice for those of its alternatives' parameters.
template <Described Record, class Visit>
void for_each_row(const Visit& visit) {
    Record::rows([&]<class Value>(std::string_view name, Value Record::*member, const Facts& facts,
                                  InForce<Record, Value> in_force = nullptr) {
        visit(Row<Record, Value>{name, member, facts, in_force});
        if constexpr (is_variant<Value>) detail::visit_alternatives(name, member, visit);
    });
}

namespace detail {

inline std::string with(std::string_view name, char from, char to) {
    std::string out(name);
    for (char& c : out)
        if (c == from) c = to;
    return out;
}

}  // namespace detail

/// "cell size"
inline std::string words_of(std::string_view name) {
    return detail::with(name, '_', ' ');
}

/// The name of a flag, or of an option by text: "cell-size".
inline std::string option_name_of(std::string_view name) {
    return detail::with(name, '_', '-');
}
/// The name of a row's flag: "count-threshold".
inline std::string option_name(std::string_view name, const Facts& facts) {
    return option_name_of(facts.option.empty() ? name : facts.option);
}
template <class Row>
std::string option_name(const Row& row) {
    return option_name(row.name, row.facts);
}

/// A row's name in flat lists of a whole record: "count_threshold".
template <class Row>
std::string flat_name(const Row& row) {
    return detail::with(option_name(row), '-', '_');
}

}  // namespace meniscus
