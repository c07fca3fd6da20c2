// What is said on the standard error output.
#pragma once

#include <iostream>
#include <set>
#include <string>

#include "meniscus/quoted.hpp"

namespace meniscus::catalyst {

/// Lines of one rank; the others' would be the same, and are left to it.
class Notices {
public:
    /// Only what each rank says of itself comes from ranks above 0.
    void speak_for(int rank) { rank_ = rank; }

    /// Errors and news of the run.
    void say(const std::string& what) const { std::cerr << "meniscus: " + of_rank() + visible(what) + "\n"; }
    /// What is passed over: once each, by rank 0.
    void say_once(const std::string& what) {
        if (rank_ == 0 && said_.insert(what).second) say(what);
    }

private:
    std::string of_rank() const { return rank_ == 0 ? std::string() : "rank " + std::to_string(rank_) + ": "; }

    int rank_ = 0;
    std::set<std::string> said_;
};

}  // namespace meniscus::catalyst
