#include "sessions/sending/finished_bricks.hpp"

#include "meniscus/brick_recoding.hpp"
#include "sessions/sending/brick_messages.hpp"

namespace meniscus::server {

RecodedBricks::RecodedBricks(const FinishedBricks& finished, const CodingOptions& options)
    : finished_(finished),
      options_(options),
      forms_(finished.attributes),
      is_as_it_came_(options.codec == finished.codec && options.normal_bits == finished.normal_bits &&
                     (options.position_bits == 0 || options.position_bits == static_cast<int>(finished.offset_bits)) &&
                     options.attributes == finished.attributes) {
    forms_.insert(forms_.end(), options.attributes.begin(), options.attributes.end());
}

SharedBrick RecodedBricks::brick(std::size_t number, const std::vector<SharedBrick>& before,
                                 BrickScratch& scratch) const {
    const SharedBrick& came = finished_.bricks[number];
    if (is_as_it_came_) return came;
    const EncodedBrick encoded = encoded_brick(*came);
    const ContentHash hash = content_hash(encoded, forms_);
    SharedBrick earlier = find_brick(before, came->place);
    if (earlier && earlier->content_hash == hash) return earlier;
    return brick_messages(recode_brick(encoded, finished_.offset_bits, finished_.attributes, options_, scratch), hash);
}

}  // namespace meniscus::server
