#include "cli/file_pattern.hpp"

#include <string_view>

namespace meniscus::cli {

FilePattern::FilePattern(const std::string& text) : before_(text) {
    for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', open + 1)) {
        const std::string_view rest = std::string_view(text).substr(open);
        const bool padded =
            rest.size() > 4 && rest.starts_with("{:0") && rest[3] >= '1' && rest[3] <= '9' && rest[4] == '}';
        if (!padded && !rest.starts_with("{}")) continue;
        has_number_ = true;
        fixed_width_ = padded;
        if (padded) width_ = static_cast<std::size_t>(rest[3] - '0');
        before_ = text.substr(0, open);
        after_ = rest.substr(padded ? 5 : 2);
        return;
    }
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
