#include "meniscus/client/publication.hpp"

#include <system_error>
#include <utility>

#include "files/publication_format.hpp"
#include "meniscus/error.hpp"
#include "publications/durable_file.hpp"
#include "publications/manifest.hpp"
#include "publications/segment.hpp"

namespace meniscus::client {
namespace {

std::filesystem::path folder_of(const std::filesystem::path& path) {
    return path.filename() == files::manifest_name ? path.parent_path() : path;
}

}  // namespace

std::string PublishedSegment::file() const {
    return sha256 + std::string(files::segment_extension);
}

class Publication::Impl {
public:
    Impl(std::string name, FetchFile fetch) : name_(std::move(name)), fetch_(std::move(fetch)) { refresh(); }

    const std::string& name() const noexcept { return name_; }
    const PublicationInfo& info() const noexcept { return info_; }

    void refresh() {
        const std::string manifest(files::manifest_name);
        info_ = read_manifest(name_, fetch_(manifest, files::max_manifest_bytes));
    }

    ReceivedFrame frame(std::uint64_t place) {
        if (place < info_.left_frames || place - info_.left_frames >= info_.frames)
            throw InvalidInput(name_ + ": no frame at place " + std::to_string(place) + "; it has " +
                               std::to_string(info_.frames) + ", from place " + std::to_string(info_.left_frames));
        std::uint64_t left = place - info_.left_frames;
        auto segment = info_.segments.begin();
        for (; left >= segment->frames; ++segment) left -= segment->frames;
        if (!reader_ || open_ != *segment || reader_->given() > left) {
            reader_.reset();
            open_ = *segment;
            reader_ = std::make_unique<SegmentReader>(name_ + ": " + segment->file(), *segment,
                                                      fetch_(segment->file(), segment->bytes));
        }
        try {
            while (reader_->given() < left) (void)reader_->next();
            ReceivedFrame frame = reader_->next();
            frame.normals_by = info_.normals_by;
            return frame;
        } catch (...) {
            reader_.reset();  // a frame that failed has left it half done
            throw;
        }
    }

private:
    std::string name_;
    FetchFile fetch_;
    PublicationInfo info_;
    PublishedSegment open_;                  ///< that `reader_` reads
    std::unique_ptr<SegmentReader> reader_;  ///< none: there is none
};

Publication::Publication(const std::filesystem::path& folder)
    : Publication(folder_of(folder).string(),
                  [folder = folder_of(folder)](const std::string& name, std::uint64_t most) {
                      return read_whole(folder / name, most);
                  }) {}
Publication::Publication(std::string name, FetchFile fetch)
    : impl_(std::make_unique<Impl>(std::move(name), std::move(fetch))) {}
Publication::Publication(Publication&&) noexcept = default;
Publication& Publication::operator=(Publication&&) noexcept = default;
Publication::~Publication() = default;

const std::string& Publication::name() const noexcept {
    return impl_->name();
}

const PublicationInfo& Publication::info() const noexcept {
    return impl_->info();
}

void Publication::refresh() {
    impl_->refresh();
}

ReceivedFrame Publication::frame(std::uint64_t place) {
    return impl_->frame(place);
}

bool is_publication(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(folder_of(path) / files::manifest_name, error);
}

}  // namespace meniscus::client
