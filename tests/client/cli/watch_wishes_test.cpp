// The flags of a watcher's attributes.
#include "cli/options/watch_wishes.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

/// Of a session that has velocity and age.
std::vector<AttributeWish> wishes_of(const std::string& flags) {
    CLI::App app;
    WatchWishes wishes;
    wishes.add_to(app);
    app.parse(flags);
    Settings settings;
    settings.attributes = {"velocity", "age"};
    return wishes.build(settings).attributes;
}

TEST(WatchWishes, AreForAllAttributesForSomeOrForNone) {
    using Wishes = std::vector<AttributeWish>;
    EXPECT_EQ(wishes_of(""), (Wishes{{"", 8}}));
    EXPECT_EQ(wishes_of("--attribute all --attribute-bits 0"), (Wishes{{"", 0}}));
    EXPECT_EQ(wishes_of("--attribute none"), Wishes{});
    EXPECT_EQ(wishes_of("--attribute age --attribute velocity --attribute-bits 12"),
              (Wishes{{"age", 12}, {"velocity", 12}}));
}

TEST(WatchWishes, RefuseAnAttributeThatTheSessionDoesNotHaveAndSayWhichItHas) {
    const auto refusal = [](const std::string& flags) -> std::string {
        try {
            wishes_of(flags);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_EQ(refusal("--attribute velocty"), "--attribute velocty: the session's attributes are velocity, age");
    EXPECT_EQ(refusal("--attribute age --attribute none"), "--attribute none stands alone: leave the other names out");
    EXPECT_THROW(wishes_of("--attribute-bits 17"), CLI::ParseError);
}

}  // namespace
}  // namespace meniscus::cli
