// The steps of a first run on a GPU, the most telling first.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace meniscus::benchmarks {

/// Stands for this program in a step's words; the others below for the files of their names.
inline constexpr const char* this_program = "meniscus-bench";

struct Step {
    std::string name;
    double seconds;                  ///< that it may take
    std::vector<std::string> words;  ///< its command: a program by its name alone, see find_program()
    bool is_tried_again = false;     ///< whether it runs again, in other ways, where it hangs or fails
};

/// million: particles of the large frames. folder: for the steps' own results.
std::vector<Step> check_steps(std::size_t million, const std::filesystem::path& folder);

/// The path of a program: beside this one, in PATH, or of CUDA's toolkit. Empty where it is not.
std::string find_program(const std::string& name);
/// The words with paths in place of programs' names. Empty where a program is missing, whose name goes to `missing`.
std::vector<std::string> with_paths(const std::vector<std::string>& words, std::string& missing);

}  // namespace meniscus::benchmarks
