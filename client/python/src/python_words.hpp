// What the libraries say, in the words of Python's side.
#pragma once

#include <string>
#include <string_view>

namespace meniscus::python {

/// A message in which the flags of the command line are keywords: smoothness for --smoothness, field="color" for
/// --field color; calls of the wire are methods.
std::string in_python_words(std::string_view text);

}  // namespace meniscus::python
