// The rows of described records (core/include/meniscus/described.hpp), a line each, of cells between tabs: what
// deploy/document-rows writes the documents from.
#include <array>
#include <chrono>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>

#include "meniscus/backend_options.hpp"
#include "meniscus/client/frame_statistics.hpp"
#include "meniscus/client/particle_watcher.hpp"
#include "meniscus/client/publisher.hpp"
#include "meniscus/client/session.hpp"
#include "meniscus/client/stream.hpp"
#include "meniscus/client/watcher.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus {
namespace {

/// The choice that is no setting, but a name for several.
struct NamedSettings {
    Preset preset = Preset::smooth;

    template <class Visit>
    static void rows(const Visit& visit) {
        visit("preset", &NamedSettings::preset, {.help = "settings by name"});
    }
};

/// In Python's words.
template <class Value>
std::string_view kind_of(const Facts& facts) {
    using T = Held<Value>;
    if constexpr (std::is_same_v<T, bool>) return "bool";
    if constexpr (std::is_floating_point_v<T>) return "float";
    if constexpr (std::is_integral_v<T>) return "int";
    if constexpr (is_list<T>) return "list";
    if constexpr (std::is_same_v<T, std::chrono::milliseconds>) return "float";  // seconds
    if constexpr (std::is_same_v<T, Box>) return "box";
    if constexpr (std::is_same_v<T, std::array<double, 3>>) return "point";
    if (facts.entries.empty()) return "str";
    if constexpr (requires(T value) { value[0] + 0.5; })
        return std::is_floating_point_v<std::remove_cvref_t<decltype(T{}[0])>> ? "float by name" : "int by name";
    return "str";
}

template <class Value>
std::string text_of(const Value& value) {
    std::ostringstream out;
    out << std::boolalpha;
    if constexpr (std::is_enum_v<Value> || is_variant<Value>)
        out << name_of(value);
    else if constexpr (std::is_same_v<Value, std::chrono::milliseconds>)
        out << std::chrono::duration<double>(value).count();
    else if constexpr (requires { out << value; })
        out << value;
    return out.str();
}

/// Empty where there is none.
template <class Row, class Record>
std::string default_of(const Row& row, const Record& record) {
    using Type = typename Row::Type;
    if (!row.facts.standard.empty()) return std::string(row.facts.standard);
    if (row.in_force != nullptr) return text_of(row.in_force(record));
    if constexpr (!std::is_same_v<Type, Held<Type>>)
        return {};
    else if constexpr (requires { row.choice; })
        return text_of(row.standard());
    else
        return text_of(*row.find(record));
}

/// Those of a choice, with spaces between them.
template <class Value>
std::string choices_of() {
    using T = Held<Value>;
    std::string out;
    if constexpr (std::is_enum_v<T> || is_variant<T>)
        for (const std::string_view name : names<T>) out += (out.empty() ? "" : " ") + std::string(name);
    return out;
}

template <class Record>
void print_rows(std::string_view record_name) {
    const Record record;
    for_each_row<Record>([&]<class Row>(const Row& row) {
        if constexpr (Described<typename Row::Type>) return print_rows<typename Row::Type>(record_name);
        const Facts& facts = row.facts;
        std::cout << record_name << '\t' << row.name << '\t' << option_name(row) << '\t'
                  << (facts.letter == '\0' ? "" : std::string(1, facts.letter)) << '\t' << facts.argument << '\t'
                  << facts.when << '\t' << facts.help << '\t' << default_of(row, record) << '\t'
                  << kind_of<typename Row::Type>(facts) << '\t' << facts.unit << '\t'
                  << choices_of<typename Row::Type>() << '\n';
    });
}

}  // namespace
}  // namespace meniscus

int main() {
    meniscus::print_rows<meniscus::Settings>("settings");
    meniscus::print_rows<meniscus::NamedSettings>("preset");
    meniscus::print_rows<meniscus::Statistics>("statistics");
    meniscus::print_rows<meniscus::client::FrameStatistics>("frame statistics");
    meniscus::print_rows<meniscus::BackendOptions>("backend options");
    meniscus::print_rows<meniscus::client::OpenOptions>("open options");
    meniscus::print_rows<meniscus::client::StreamOptions>("stream options");
    meniscus::print_rows<meniscus::client::PublisherOptions>("publisher options");
    meniscus::print_rows<meniscus::client::WatchOptions>("watch options");
    meniscus::print_rows<meniscus::client::ParticleWatchOptions>("particle watch options");
    meniscus::print_rows<meniscus::client::SnapshotOptions>("snapshot options");
}
