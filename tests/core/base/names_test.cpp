// Names of choices.
#include "meniscus/names.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "meniscus/error.hpp"
#include "meniscus/meniscus.hpp"

namespace meniscus {
namespace {

template <class T>
class Names : public testing::Test {};
using Choices = testing::Types<Field, Spray, Preset, Mode, Criterion, EdgePoints, Backend, TriangleLevel, Stage>;
TYPED_TEST_SUITE(Names, Choices);

TYPED_TEST(Names, AreThereForEveryChoiceAndDiffer) {
    EXPECT_FALSE(names<TypeParam>.empty());
    for (const std::string_view name : names<TypeParam>) {
        EXPECT_FALSE(name.empty());
        EXPECT_EQ(std::ranges::count(names<TypeParam>, name), 1) << name;
    }
}

TYPED_TEST(Names, LeadBackToTheirChoice) {
    for (const TypeParam& choice : choices<TypeParam>)
        EXPECT_EQ(by_name<TypeParam>(name_of(choice), "choice"), choice) << name_of(choice);
}

TYPED_TEST(Names, RefuseOthersNamingThemAndAllThatAreAllowed) {
    for (const std::string name : {"", "none such"}) {
        EXPECT_EQ(find_by_name<TypeParam>(name), std::nullopt);
        try {
            by_name<TypeParam>(name, "the choice");
            ADD_FAILURE() << "'" << name << "' is a choice";
        } catch (const InvalidInput& e) {
            EXPECT_EQ(e.what(), "the choice is '" + name + "', must be " + listed(names<TypeParam>));
        }
    }
}

TEST(NamesOfABackend, AreListedInASentence) {
    EXPECT_EQ(listed(names<Backend>), "auto, cpu or cuda");
    EXPECT_EQ(listed(names<Mode>), "adaptive or uniform");
    EXPECT_EQ(listed({}), "");
}

TEST(NamesOfAVariant, GiveTheParametersTheirDefaults) {
    EXPECT_EQ(by_name<Criterion>("count", "criterion"), Criterion(CountCriterion{}));
    EXPECT_EQ(value_or_default<CountCriterion>(Criterion(CountCriterion{7})).threshold, 7U);
    EXPECT_EQ(value_or_default<CountCriterion>(Criterion(CurvatureCriterion{})).threshold, CountCriterion{}.threshold);
}

}  // namespace
}  // namespace meniscus
