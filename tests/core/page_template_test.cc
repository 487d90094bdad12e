#include "sidestep/core/page_template.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace sidestep::page_template_test {
namespace {

TEST(FillTemplate, PutsEachPartWhereItIsNamed) {
  EXPECT_EQ(FillTemplate("<b>{{a}}</b>{{b}}{{a}}.", {{"a", "1"}, {"b", ""}}), "<b>1</b>1.");
}

TEST(FillTemplate, DoesNotLookIntoTheParts) {
  EXPECT_EQ(FillTemplate("{{a}}{{b}}", {{"a", "{{b}}"}, {"b", "}}{{"}}), "{{b}}}}{{");
}

TEST(FillTemplate, RefusesNamesWithoutAPartAndPartsWithoutAName) {
  EXPECT_THROW(FillTemplate("{{a}}", {}), std::invalid_argument);
  EXPECT_THROW(FillTemplate("{{a", {{"a", ""}}), std::invalid_argument);
  EXPECT_THROW(FillTemplate("a", {{"a", ""}}), std::invalid_argument);
}

TEST(ScriptJson, LeavesNothingThatCouldEndTheElement) {
  EXPECT_EQ(ScriptJson(R"({"a":"</script><!--<script>"})"),
            R"({"a":"\u003c/script>\u003c!--\u003cscript>"})");
}

}  // namespace
}  // namespace sidestep::page_template_test
