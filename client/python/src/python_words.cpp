#include "python_words.hpp"

#include <algorithm>
#include <map>
#include <type_traits>
#include <vector>

#include "meniscus/backend_options.hpp"
#include "meniscus/client/connection_options.hpp"
#include "meniscus/described.hpp"
#include "meniscus/names.hpp"
#include "meniscus/settings.hpp"
#include "values/keywords.hpp"

namespace meniscus::python {
namespace {

/// By flag, without the dashes, what it chooses from: nothing but for a choice.
using Flags = std::map<std::string, std::vector<std::string_view>, std::less<>>;

template <Described Record>
void add_rows(Flags& flags) {
    for_each_row<Record>([&flags]<class Row>(const Row& row) {
        using Value = Held<typename Row::Type>;
        auto& choices = flags[option_name(row)];
        if constexpr (std::is_enum_v<Value> || is_variant<Value>)
            choices.assign(names<Value>.begin(), names<Value>.end());
    });
}

const Flags& flags() {
    static const Flags all = [] {
        Flags made{{"max-file-bytes", {}}};
        add_rows<Settings>(made);
        add_rows<BackendOptions>(made);
        add_rows<client::ConnectionOptions>(made);
        return made;
    }();
    return all;
}

std::string keyword_of_flag(std::string_view flag) {
    return flag == "max-file-bytes" ? "max_bytes" : keyword_of(flag);
}

/// The text up to the first character that no name of a flag or of a choice has.
std::string_view first_word(std::string_view text) {
    return text.substr(0, text.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"));
}

/// What a server calls by its name on the wire.
std::string without_wire_names(std::string message) {
    constexpr std::string_view id = "x-session-id", recordings = "; ListRecordings tells";
    if (message.starts_with(id)) message.replace(0, id.size(), "the session's id");
    if (const std::size_t place = message.find(recordings); place != std::string::npos)
        message.replace(place, recordings.size(), "; recordings() tells");
    return message;
}

}  // namespace

std::string in_python_words(std::string_view text) {
    const std::string whole = without_wire_names(std::string(text));
    std::string_view message = whole;
    std::string out;
    for (std::size_t dashes = message.find("--"); dashes != std::string_view::npos; dashes = message.find("--")) {
        out += message.substr(0, dashes);
        message.remove_prefix(dashes + 2);
        const std::string_view flag = first_word(message);
        const auto known = flags().find(flag);
        // Within a word, such as a path, dashes are what they are.
        const bool begins = out.empty() || out.back() == ' ' || out.back() == '(';
        if (!begins || known == flags().end()) {
            out += "--";
            continue;
        }
        out += keyword_of_flag(flag);
        message.remove_prefix(flag.size());
        const std::string_view choice = message.starts_with(' ') ? first_word(message.substr(1)) : std::string_view();
        if (!std::ranges::count(known->second, choice)) continue;
        out += "=\"" + std::string(choice) + '"';
        message.remove_prefix(1 + choice.size());
    }
    return out += message;
}

}  // namespace meniscus::python
