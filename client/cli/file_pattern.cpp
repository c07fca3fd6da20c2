#include "cli/file_pattern.hpp"

#include <regex>

namespace meniscus::cli {

FilePattern::FilePattern(const std::string& text) : before_(text) {
    static const std::regex number(R"(\{(?::0([1-9]))?\})");
    std::smatch match;
    if (!std::regex_search(text, match, number)) return;
    has_number_ = true;
    before_ = match.prefix();
    after_ = match.suffix();
    fixed_width_ = match[1].matched;
    if (fixed_width_) width_ = std::stoul(match[1]);
}

std::filesystem::path FilePattern::at(std::uint64_t number) const {
    if (!has_number_) return before_;
    const std::string digits = std::to_string(number);
    return before_ + std::string(width_ > digits.size() ? width_ - digits.size() : 0, '0') + digits + after_;
}

void FilePattern::match_existing(std::uint64_t number) {
    if (fixed_width_) return;
    for (width_ = 0; width_ <= 9; ++width_)
        if (std::filesystem::exists(at(number))) return;
    width_ = 0;
}

void FilePattern::pad_like(const FilePattern& other) {
    if (!fixed_width_) width_ = other.width_;
}

}  // namespace meniscus::cli
