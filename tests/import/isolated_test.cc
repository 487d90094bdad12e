#include "sidestep/import/isolated.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <new>
#include <stdexcept>
#include <string>

#include "sidestep/core/input_error.h"

namespace sidestep::imports::isolated_test {
namespace {

std::string MessageOf(const std::function<std::string()>& work) {
  try {
    RunIsolated(work);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "was done";
}

TEST(Isolated, ReturnsWhatIsReturnedThere) {
  EXPECT_EQ(RunIsolated([] { return std::string("a\0b", 3); }), std::string("a\0b", 3));
  EXPECT_EQ(RunIsolated([] { return std::string(); }), "");
  const std::string large(10'000'000, 'x');
  EXPECT_EQ(RunIsolated([&] { return large; }), large);
}

TEST(Isolated, ThrowsTheMessageOfWhatIsThrownThere) {
  EXPECT_EQ(MessageOf([]() -> std::string { throw InputError("a.stl", "is no mesh"); }),
            "a.stl: is no mesh");
  EXPECT_THAT(MessageOf([]() -> std::string { throw std::bad_alloc(); }),
              testing::HasSubstr("memory"));
}

TEST(Isolated, OutlivesACrash) {
  EXPECT_THAT(MessageOf([]() -> std::string {
                std::signal(SIGSEGV, SIG_DFL);
                std::raise(SIGSEGV);
                return "";
              }),
              testing::HasSubstr("crashes"));
  EXPECT_THAT(MessageOf([]() -> std::string { std::abort(); }), testing::HasSubstr("crashes"));
}

}  // namespace
}  // namespace sidestep::imports::isolated_test
