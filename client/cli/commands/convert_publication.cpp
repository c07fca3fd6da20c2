#include "cli/commands/convert_publication.hpp"

#include <iostream>
#include <set>

#include "cli/surfaces/mesh_output.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::cli {

void convert_publication(const PublicationConversion& conversion) {
    const bool to_stream = formats::is_standard_stream(conversion.out);
    if (!to_stream) formats::make_directory(conversion.out);
    std::set<std::uint64_t> written;
    for_each_frame(
        conversion.publication, conversion.range, [&](const std::string& name, const client::ReceivedFrame& frame) {
            if (to_stream && !written.empty())
                throw InvalidInput("standard output takes one frame: choose one by --from and --to");
            if (!written.insert(frame.index).second)
                throw InvalidInput(name +
                                   " comes twice, of several runs: choose others by --from and --to, or "
                                   "read them by their places, as the libraries do");
            const auto path = to_stream
                                  ? conversion.out
                                  : frame_path(conversion.out, frame.index, formats::row_of(conversion.format).name);
            Surface surface(frame);
            try {
                MeshOutput(surface, conversion.format, conversion.edits).write(path);
            } catch (const InvalidInput& error) {
                throw InvalidInput(name + ": " + error.what());
            }
            if (!conversion.quiet) std::cerr << formats::output_name(path) << '\n';
        });
}

}  // namespace meniscus::cli
