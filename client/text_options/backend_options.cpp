#include "text_options/backend_options.hpp"

#include "text_options/row_options.hpp"

namespace meniscus::text_options {

BackendOptions read_backend(OptionReader& options) {
    return record_of<BackendOptions>(options);
}

}  // namespace meniscus::text_options
