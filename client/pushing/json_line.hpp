// A line of JSON, read without a library: what `meniscus push --answers -` writes.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace meniscus::pushing {

/// Its numbers, texts, trues, falses and nulls by their names, those in an object or an array within by "outer.inner",
/// of an array by "outer.0". Texts are as they mean, all others as they are written.
using JsonLine = std::map<std::string, std::string, std::less<>>;

/// Throws client::ServerError (data_loss) for what is no object of JSON.
JsonLine read_json_line(std::string_view line);

}  // namespace meniscus::pushing
