#include "cli/surfaces/array_forms.hpp"

#include <algorithm>

#include "meniscus/array_form.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {

void ArrayForms::require(std::span<const ParticleArray> arrays) {
    for (const ParticleArray& array : arrays) {
        const auto form =
            std::find_if(forms_.begin(), forms_.end(), [&](const Form& known) { return known.name == array.name; });
        if (form == forms_.end())
            forms_.push_back({std::string(array.name), array.type, array.components});
        else if (form->type != array.type || form->components != array.components)
            throw InvalidInput("array '" + form->name + "' is " + form_of(array.type, array.components) +
                               ", must be as in the frames before: " + form_of(form->type, form->components));
    }
}

}  // namespace meniscus::cli
