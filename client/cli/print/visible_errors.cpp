#include "cli/print/visible_errors.hpp"

#include <iostream>
#include <string>
#include <string_view>

#include "meniscus/quoted.hpp"

namespace meniscus::cli {

VisibleErrors::VisibleErrors() : terminal_(std::cerr.rdbuf(this)) {}

VisibleErrors::~VisibleErrors() {
    std::cerr.rdbuf(terminal_);
}

VisibleErrors::int_type VisibleErrors::overflow(int_type c) {
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    const char byte = traits_type::to_char_type(c);
    return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
}

std::streamsize VisibleErrors::xsputn(const char* text, std::streamsize size) {
    const std::string shown = visible({text, static_cast<std::size_t>(size)});
    const auto length = static_cast<std::streamsize>(shown.size());
    return terminal_->sputn(shown.data(), length) == length ? size : 0;
}

int VisibleErrors::sync() {
    return terminal_->pubsync();
}

}  // namespace meniscus::cli
