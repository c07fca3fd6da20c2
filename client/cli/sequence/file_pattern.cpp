#include "cli/sequence/file_pattern.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

#include "meniscus/error.hpp"

namespace meniscus::cli {

FilePattern::FilePattern(const std::string& text) : text_(text), before_(text) {
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

std::map<std::uint64_t, std::filesystem::path> FilePattern::match_existing() {
    // The number may stand in the name of a folder: what follows that name is behind it.
    const std::size_t name_begin = before_.rfind('/') + 1;
    const std::filesystem::path folder = name_begin == 0 ? "." : before_.substr(0, name_begin);
    const std::string prefix = before_.substr(name_begin);
    const std::size_t name_end = std::min(after_.find('/'), after_.size());
    const std::string suffix = after_.substr(0, name_end);
    std::map<std::uint64_t, std::filesystem::path> found;
    std::error_code error;  // a folder that is not there, or cannot be read, has none
    auto entry = std::filesystem::directory_iterator(folder, error);
    for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) || !name.ends_with(suffix))
            continue;
        const std::string digits = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
        std::uint64_t number = 0;
        const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        if (failed != std::errc() || end != digits.data() + digits.size()) continue;
        const std::filesystem::path path = before_ + digits + after_;
        if ((fixed_width_ && path != at(number)) || !std::filesystem::exists(path)) continue;
        const auto [other, is_new] = found.emplace(number, path);
        if (!is_new)
            throw InvalidInput(text_ + ": " + other->second.string() + " and " + path.string() + " are both frame " +
                               std::to_string(number) + "; write {:0W} for numbers of W digits");
    }
    if (!fixed_width_ && !found.empty()) {
        const std::string path = found.begin()->second.string();
        width_ = path[before_.size()] == '0' ? path.size() - before_.size() - after_.size() : 0;
    }
    return found;
}

void FilePattern::require_no_other_notation() const {
    std::error_code none;
    if (has_number_ || std::filesystem::exists(text_, none)) return;
    std::string here;
    if (const std::size_t star = text_.find('*'); star != std::string::npos) {
        here = text_.substr(0, star) + "{}" + text_.substr(star + 1);
    } else if (const std::size_t percent = text_.find('%'); percent != std::string::npos) {
        const std::size_t end = text_.find_first_not_of("0123456789", percent + 1);
        if (end == std::string::npos || text_[end] != 'd') return;
        const std::string width = text_.substr(percent + 1, end - percent - 1);
        here = text_.substr(0, percent) + (width.size() == 2 && width[0] == '0' ? "{:" + width + "}" : "{}") +
               text_.substr(end + 1);
    } else {
        return;
    }
    throw InvalidInput(text_ + ": no such file; a sequence has {} for the numbers, as '" + here + "'");
}

void FilePattern::pad_like(const FilePattern& other) {
    if (!fixed_width_) width_ = other.width_;
}

}  // namespace meniscus::cli
