#include "sidestep/core/markup.h"

#include <gtest/gtest.h>

namespace sidestep::markup_test {
namespace {

TEST(Markup, IsEscapedBetweenTagsAndInAttributes) {
  EXPECT_EQ(EscapeMarkup("<a b=\"c\"> & 'd'"), "&lt;a b=&quot;c&quot;&gt; &amp; 'd'");
}

TEST(Markup, ThatIsNoneIsToldInWords) {
  EXPECT_STREQ(XmlFault("a.xml", 3, "XML_ERROR_MISMATCHED_ELEMENT").what(),
               "a.xml:3: is no well-formed XML: mismatched element");
  EXPECT_STREQ(XmlFault("a.xml", 0, "XML_ERROR_EMPTY_DOCUMENT").what(), "a.xml: is empty");
}

}  // namespace
}  // namespace sidestep::markup_test
