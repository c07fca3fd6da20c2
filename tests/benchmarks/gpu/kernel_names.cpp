#include "gpu/kernel_names.hpp"

#include <cxxabi.h>

#include <cstdlib>
#include <memory>
#include <regex>

#include "engine/cuda/errors.hpp"

namespace meniscus::benchmarks {
namespace {

/// Where the parameters begin, which stand in the last parentheses.
std::size_t end_of_name(const std::string& function) {
    int depth = 0;
    for (std::size_t at = function.size(); at-- > 0;) {
        depth += function[at] == ')' ? 1 : function[at] == '(' ? -1 : 0;
        if (depth == 0) return function[at] == '(' ? at : function.size();
    }
    return function.size();
}

}  // namespace

std::string plain_kernel_name(const char* mangled) {
    int status = 0;
    const std::unique_ptr<char, void (*)(void*)> plain(abi::__cxa_demangle(mangled, nullptr, nullptr, &status),
                                                       &std::free);
    std::string name = status == 0 ? plain.get() : mangled;
    name.resize(end_of_name(name));
    static const std::regex namespaces(R"(\(anonymous namespace\)::|meniscus::|cuda::|emulated::|benchmarks::|^void )");
    name = std::regex_replace(name, namespaces, "");
    static const std::regex commas(", ?");
    name = std::regex_replace(name, commas, " ");
    static const std::regex closing("> >");
    return std::regex_replace(name, closing, ">>");
}

std::string kernel_name(const void* kernel) {
    const char* mangled = nullptr;
    cuda::check(cudaFuncGetName(&mangled, kernel), "cudaFuncGetName");
    return plain_kernel_name(mangled);
}

}  // namespace meniscus::benchmarks
