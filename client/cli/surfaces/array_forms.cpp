#include "cli/surfaces/array_forms.hpp"

#include <algorithm>

#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

std::string text_of(ElementType type, std::size_t components) {
    return std::string(name_of(type)) + " of " + std::to_string(components) +
           (components == 1 ? " component" : " components");
}

}  // namespace

void ArrayForms::require(std::span<const ParticleArray> arrays) {
    for (const ParticleArray& array : arrays) {
        const auto form =
            std::find_if(forms_.begin(), forms_.end(), [&](const Form& known) { return known.name == array.name; });
        if (form == forms_.end())
            forms_.push_back({std::string(array.name), array.type, array.components});
        else if (form->type != array.type || form->components != array.components)
            throw InvalidInput("array '" + form->name + "' is " + text_of(array.type, array.components) +
                               ", must be as in the frames before: " + text_of(form->type, form->components));
    }
}

}  // namespace meniscus::cli
