// An error with the result of the C interface that it stands for.
#pragma once

#include <stdexcept>
#include <string>

#include "meniscus/meniscus.h"

namespace meniscus::catalyst {

class Failure : public std::runtime_error {
public:
    Failure(meniscus_result result, const std::string& message) : std::runtime_error(message), result_(result) {}
    meniscus_result result() const noexcept { return result_; }

private:
    meniscus_result result_;
};

}  // namespace meniscus::catalyst
