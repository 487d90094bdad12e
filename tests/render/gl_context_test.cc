#include "sidestep/render/gl_context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "sidestep/core/input_error.h"

namespace sidestep::render::gl_context_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// Sets MUJOCO_GL for one test.
class GlEnvironment : public ::testing::Test {
 protected:
  void TearDown() override { unsetenv("MUJOCO_GL"); }
  static void Set(const std::string& value) { setenv("MUJOCO_GL", value.c_str(), 1); }
};

std::string Refusal() {
  try {
    const GlContext gl;
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST_F(GlEnvironment, DrawsWithoutADisplay) {
  unsetenv("DISPLAY");
  const GlContext gl;
  EXPECT_NE(gl.renderer(), "");
  EXPECT_NE(gl.version(), "");
}

TEST_F(GlEnvironment, MakesOneContextAfterTheOther) {
  for (int i = 0; i < 3; ++i) EXPECT_THAT(DescribeGl(), StartsWith("OSMesa: "));
}

TEST_F(GlEnvironment, AcceptsTheBackEndThatIsBuiltIn) {
  for (const char* const value : {"", "osmesa"}) {
    Set(value);
    EXPECT_EQ(Refusal(), "") << value;
  }
}

TEST_F(GlEnvironment, RefusesOthersInOneLineThatNamesThem) {
  for (const char* const value : {"egl", "glfw", "OSMESA", "nonsense"}) {
    Set(value);
    EXPECT_THAT(Refusal(),
                StartsWith("MUJOCO_GL: is '" + std::string(value) + "', which is not built in"));
    EXPECT_THAT(DescribeGl(), HasSubstr(value));
  }
}

TEST_F(GlEnvironment, DrawsNothingWhereItIsForbidden) {
  Set("disable");
  EXPECT_EQ(Refusal(), "MUJOCO_GL: is 'disable', which forbids drawing; unset it to draw");
}

}  // namespace
}  // namespace sidestep::render::gl_context_test
