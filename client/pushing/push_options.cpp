#include "pushing/push_options.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "meniscus/error.hpp"
#include "text_options/attribute_options.hpp"
#include "text_options/client_options.hpp"
#include "text_options/settings_options.hpp"

namespace meniscus::pushing {
namespace {

/// Of meshes, which do not come back through `meniscus push` and whose bricks are encoded here, and of what waits for
/// them here.
constexpr std::array<std::string_view, 6> of_meshes{"meshes",         "normal-bits", "normals-by",
                                                    "attribute-bits", "codec",       "waiting-limit"};
/// Of several words, which are arguments of their own.
constexpr std::string_view box_option = "domain";
constexpr std::string_view attribute_option = "attribute";

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t first = text.find_first_not_of(' '); first != std::string_view::npos;) {
        const std::size_t end = std::min(text.find(' ', first), text.size());
        words.emplace_back(text.substr(first, end - first));
        first = text.find_first_not_of(' ', end);
    }
    return words;
}

void append(const std::string& name, const std::string& value, std::vector<std::string>& words) {
    if (name == attribute_option) {
        for (const std::string& array : words_of(value))
            words.push_back(std::string("--").append(name).append("=").append(array));
    } else if (name == box_option) {
        words.push_back("--" + name);
        for (const std::string& number : words_of(value)) words.push_back(number);
    } else {
        words.push_back("--" + name + "=" + value);
    }
}

/// Throws for options that the command lacks. upload: options of a stream or of a publisher.
template <class Upload>
void require_possible(const client::ConnectionOptions& connection, const client::OpenOptions& open,
                      const Upload& upload) {
    const auto refuse = [](const std::string& option) {
        throw NotBuilt("option '" + option + "' of a session through meniscus push",
                       "the service: leave the option out, or build it without -DMENISCUS_SERVICE=OFF, where gRPC is "
                       "installed");
    };
    if (connection.timeout != client::ConnectionOptions().timeout) refuse("timeout");
    if (!open.ephemeral) refuse("ephemeral");
    if (upload.route_check != Upload().route_check) refuse("route-check");
}

/// read_upload: reads the options of the upload from a reader, and returns them.
template <class ReadUpload>
PushArguments arguments_of(const std::string& address, const text_options::Options& connection,
                           const text_options::Options& session, const ReadUpload& read_upload) {
    text_options::OptionReader connecting(&connection);
    const client::ConnectionOptions connected = text_options::read_connection(connecting);
    text_options::OptionReader reader(&session);
    PushArguments out;
    out.settings = text_options::read_settings(reader);
    const client::OpenOptions open = text_options::read_open(reader);
    const auto upload = read_upload(reader);
    reader.finish();
    require_possible(connected, open, upload);

    out.token = connected.token;
    out.words = {"push", "-", "--answers=-", "--quiet", "--server=" + address};
    for (const auto& [name, value] : connection)
        if (name != "token" && name != "timeout") append(name, value, out.words);
    for (const auto& [name, value] : session)
        if (std::find(of_meshes.begin(), of_meshes.end(), name) == of_meshes.end() && name != "ephemeral" &&
            name != "route-check")
            append(name, value, out.words);
    // The command's own default is another one.
    if (session.find("reconnect") == session.end()) append("reconnect", "0", out.words);
    return out;
}

}  // namespace

void check_connection(const text_options::Options& connection) {
    text_options::OptionReader reader(&connection);
    text_options::read_connection(reader);
    reader.finish();
}

PushArguments push_arguments(const std::string& address, const text_options::Options& connection,
                             const text_options::Options& session) {
    return arguments_of(address, connection, session, [](text_options::OptionReader& reader) {
        text_options::read_every_attribute(reader);
        return text_options::read_stream(reader);
    });
}

PublishArguments publish_arguments(const std::string& address, const text_options::Options& connection,
                                   const text_options::Options& session) {
    PublishArguments out;
    out.push = arguments_of(address, connection, session, [&out](text_options::OptionReader& reader) {
        client::PublisherOptions publisher = text_options::read_publisher(reader);
        out.form.coding.normal_bits = publisher.normal_bits;
        out.form.coding.codec = publisher.codec;
        out.form.wishes = {{{}, publisher.attribute_bits}};
        return publisher;
    });
    return out;
}

}  // namespace meniscus::pushing
