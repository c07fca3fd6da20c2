// An error of another rank.
#pragma once

#include <stdexcept>
#include <string>

#include "meniscus/meniscus.h"

namespace meniscus::c {

class Failure : public std::runtime_error {
public:
    Failure(meniscus_result result, const std::string& message) : std::runtime_error(message), result_(result) {}
    meniscus_result result() const noexcept { return result_; }

private:
    meniscus_result result_;
};

}  // namespace meniscus::c
