#include "conduit_stand_in.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>

conduit_node_impl* conduit_node_impl::find(const std::string& path) {
    const std::size_t slash = path.find('/');
    for (const auto& child : children)
        if (child->name == path.substr(0, slash))
            return slash == std::string::npos ? child.get() : child->find(path.substr(slash + 1));
    return nullptr;
}

conduit_node_impl& conduit_node_impl::operator[](const std::string& path) {
    const std::size_t slash = path.find('/');
    const std::string first = path.substr(0, slash);
    conduit_node_impl* child = find(first);
    if (child == nullptr) {
        type.id = conduit_datatype_impl::object;
        child = children.emplace_back(std::make_unique<conduit_node_impl>()).get();
        child->name = first;
    }
    return slash == std::string::npos ? *child : (*child)[path.substr(slash + 1)];
}

conduit_node_impl& conduit_node_impl::append() {
    type.id = conduit_datatype_impl::list;
    return *children.emplace_back(std::make_unique<conduit_node_impl>());
}

void conduit_node_impl::set(const std::string& text) {
    own.resize(text.size() + 1);
    std::memcpy(own.data(), text.c_str(), own.size());
    type = {.id = conduit_datatype_impl::text, .count = static_cast<conduit_index_t>(own.size()), .stride = 1};
    data = own.data();
}

extern "C" {

int catalyst_conduit_node_has_path(const conduit_node* node, const char* path) {
    return node->type.id == conduit_datatype_impl::object && const_cast<conduit_node*>(node)->find(path) != nullptr;
}
conduit_node* catalyst_conduit_node_fetch_existing(conduit_node* node, const char* path) {
    conduit_node* const found = node->find(path);
    if (found == nullptr) std::abort();
    return found;
}
conduit_index_t catalyst_conduit_node_number_of_children(conduit_node* node) {
    return static_cast<conduit_index_t>(node->children.size());
}
conduit_node* catalyst_conduit_node_child(conduit_node* node, conduit_index_t index) {
    return node->children.at(static_cast<std::size_t>(index)).get();
}
char* catalyst_conduit_node_name(const conduit_node* node) {
    return ::strdup(node->name.c_str());
}
char* catalyst_conduit_node_as_char8_str(conduit_node* node) {
    return reinterpret_cast<char*>(node->data);
}
void* catalyst_conduit_node_element_ptr(conduit_node* node, conduit_index_t index) {
    return node->data + node->type.offset + index * node->type.stride;
}
void catalyst_conduit_node_set_path_char8_str(conduit_node* node, const char* path, const char* value) {
    (*node)[path].set(std::string(value));
}
void catalyst_conduit_node_set_path_int64(conduit_node* node, const char* path, std::int64_t value) {
    (*node)[path].set(value);
}
const conduit_datatype* catalyst_conduit_node_dtype(const conduit_node* node) {
    return &node->type;
}
conduit_index_t catalyst_conduit_datatype_number_of_elements(const conduit_datatype* type) {
    return type->count;
}
conduit_index_t catalyst_conduit_datatype_stride(const conduit_datatype* type) {
    return type->stride;
}
int catalyst_conduit_datatype_endianness_matches_machine(const conduit_datatype* type) {
    return type->is_swapped ? 0 : 1;
}
int catalyst_conduit_datatype_is_char8_str(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::text;
}
int catalyst_conduit_datatype_is_int8(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::int8;
}
int catalyst_conduit_datatype_is_int16(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::int16;
}
int catalyst_conduit_datatype_is_int32(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::int32;
}
int catalyst_conduit_datatype_is_int64(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::int64;
}
int catalyst_conduit_datatype_is_uint8(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::uint8;
}
int catalyst_conduit_datatype_is_uint16(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::uint16;
}
int catalyst_conduit_datatype_is_uint32(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::uint32;
}
int catalyst_conduit_datatype_is_uint64(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::uint64;
}
int catalyst_conduit_datatype_is_float32(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::float32;
}
int catalyst_conduit_datatype_is_float64(const conduit_datatype* type) {
    return type->id == conduit_datatype_impl::float64;
}

}  // extern "C"

namespace meniscus::test {
namespace {

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::string() : value;
}

}  // namespace

CatalystStandIn::CatalystStandIn() {
    const std::string library =
        variable("CATALYST_IMPLEMENTATION_PATHS") + "/libcatalyst-" + variable("CATALYST_IMPLEMENTATION_NAME") + ".so";
    void* const handle = ::dlopen(library.c_str(), RTLD_LAZY | RTLD_GLOBAL);
    if (handle == nullptr) throw std::runtime_error(::dlerror());
    implementation_ = static_cast<const catalyst_impl*>(::dlsym(handle, "catalyst_api_impl"));
    if (implementation_ == nullptr || implementation_->version != 1)
        throw std::runtime_error(library + " has no catalyst_api_impl of version 1");
}

}  // namespace meniscus::test
