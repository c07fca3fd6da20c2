#include "options.hpp"

#include "result.hpp"

using namespace meniscus::c;

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
        values.insert_or_assign(&required(name, "name"), meniscus::text_options::number_text(value));
        return MENISCUS_OK;
    });
}
