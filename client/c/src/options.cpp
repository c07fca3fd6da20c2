#include "options.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/near_name.hpp"
#include "meniscus/quoted.hpp"
#include "ranks/parts_options.hpp"
#include "result.hpp"
#include "text_options/attribute_options.hpp"
#include "text_options/backend_options.hpp"
#include "text_options/client_options.hpp"
#include "text_options/settings_options.hpp"

using namespace meniscus::c;
namespace text_options = meniscus::text_options;

namespace {

/// The names that some function of the interface knows.
const std::vector<std::string>& known_names() {
    static const std::vector<std::string> names = [] {
        const text_options::Options given{{"particle-radius", "1"}};
        text_options::OptionReader reader(&given);
        text_options::read_settings(reader);
        text_options::read_backend(reader);
        text_options::read_connection(reader);
        text_options::read_open(reader);
        text_options::read_stream(reader);
        text_options::read_publisher(reader);
        text_options::read_watch(reader);
        meniscus::ranks::PartsArguments parts;
        meniscus::ranks::read_parts_options(reader, parts);
        return reader.known();
    }();
    return names;
}

void require_known(const std::string& name) {
    const std::vector<std::string>& names = known_names();
    if (std::find(names.begin(), names.end(), name) == names.end())
        throw meniscus::InvalidInput("option " + meniscus::quoted(name) + " is not known" +
                                     meniscus::suggestion(meniscus::near_name(name, names), "meniscus.h"));
}

}  // namespace

meniscus_result meniscus_options_create(meniscus_options** options) {
    return guarded([&] {
        required(options, "options") = nullptr;
        *options = new meniscus_options;
        return MENISCUS_OK;
    });
}

void meniscus_options_destroy(meniscus_options* options) {
    delete options;
}

meniscus_result meniscus_options_set(meniscus_options* options, const char* name, const char* value) {
    return guarded([&] {
        auto& values = required(options, "options").values;
        std::string key = &required(name, "name");
        require_known(key);
        if (value == nullptr)
            values.erase(key);
        else
            values.insert_or_assign(std::move(key), value);
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_options_set_number(meniscus_options* options, const char* name, double value) {
    return guarded([&] {
        auto& values = required(options, "options").values;
        std::string key = &required(name, "name");
        require_known(key);
        values.insert_or_assign(std::move(key), meniscus::text_options::number_text(value));
        return MENISCUS_OK;
    });
}
