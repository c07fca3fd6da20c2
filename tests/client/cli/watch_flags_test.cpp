// The flags of a watcher's attributes.
#include "cli/options/watch_flags.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

/// The attributes that flags ask for, of a session that has velocity and age.
std::vector<AttributeWish> requests_of(const std::string& flags) {
    CLI::App app;
    WatchFlags parsed;
    parsed.add_to(app);
    app.parse(flags);
    Settings settings;
    settings.attributes = {"velocity", "age"};
    return parsed.build(settings).attributes;
}

TEST(WatchFlags, AreForAllAttributesForSomeOrForNone) {
    using Requests = std::vector<AttributeWish>;
    EXPECT_EQ(requests_of(""), (Requests{{"", 8}}));
    EXPECT_EQ(requests_of("--attribute all --attribute-bits 0"), (Requests{{"", 0}}));
    EXPECT_EQ(requests_of("--attribute none"), Requests{});
    EXPECT_EQ(requests_of("--attribute age --attribute velocity --attribute-bits 12"),
              (Requests{{"age", 12}, {"velocity", 12}}));
}

TEST(WatchFlags, RefuseAnAttributeThatTheSessionDoesNotHaveAndSayWhichItHas) {
    const auto refusal = [](const std::string& flags) -> std::string {
        try {
            requests_of(flags);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_EQ(refusal("--attribute velocty"), "--attribute velocty: the session's attributes are velocity, age");
    EXPECT_EQ(refusal("--attribute age --attribute none"), "--attribute none stands alone: leave the other names out");
    EXPECT_THROW(requests_of("--attribute-bits 17"), CLI::ParseError);
}

}  // namespace
}  // namespace meniscus::cli
