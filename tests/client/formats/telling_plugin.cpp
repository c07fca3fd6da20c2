// A library that tells that it was loaded.
#include <cstdlib>

namespace {

[[gnu::constructor]] void tell() {
    setenv("MENISCUS_PLUGIN_WAS_LOADED", "1", 1);
}

}  // namespace
