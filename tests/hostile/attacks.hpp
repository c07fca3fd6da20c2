// Every attack by its name.
#pragma once

#include <span>

#include "attack.hpp"

namespace meniscus::hostile {

std::span<const Attack> attacks();

/// One function for each file of the folder attacks.
std::vector<Figure> gzip_bomb(const std::string& program);

}  // namespace meniscus::hostile
