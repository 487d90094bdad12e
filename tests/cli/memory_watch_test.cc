#include "sidestep/cli/memory_watch.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace sidestep::cli {
namespace {

TEST(MemoryWatch, SeesWhatStaysThroughWhatComesAndGoes) {
  MemoryWatch steady(200), leaking(200);
  for (int i = 0; i < 200; ++i) {
    const double in_use = i % 3 == 0 ? 10e6 : 60e6 + 1e5 * i;  // some pieces are larger than others
    EXPECT_FALSE(steady.Growth());
    steady.Count(in_use);
    leaking.Count(in_use + 7000.0 * i);
  }
  EXPECT_EQ(steady.Growth(), 0);
  EXPECT_NEAR(leaking.Growth().value(), 7000 * 160, 7000 * 6);
}

TEST(MemoryWatch, LeavesOutWhatIsMadeForGoodAtFirst) {
  MemoryWatch watch(50);
  for (int i = 0; i < 50; ++i) watch.Count(i < 4 ? 1e6 * i : 4e6);
  EXPECT_EQ(watch.Growth(), 0);
}

TEST(MemoryWatch, KnowsNothingOfOnePieceOfWork) {
  MemoryWatch one(1);
  one.Count(5);
  EXPECT_FALSE(one.Growth());
  EXPECT_FALSE(MemoryWatch(0).Growth());
}

TEST(HeldBytes, CountSmallAndLargeBlocksWhileTheyLive) {
  const double before = HeldBytes();
  if (before == 0) GTEST_SKIP() << "another allocator is at work, as under a sanitizer";
  std::vector<std::unique_ptr<char[]>> blocks;
  for (const std::size_t size : {1000u, 100'000u, 5'000'000u}) {
    blocks.push_back(std::make_unique<char[]>(size));
  }
  EXPECT_NEAR(HeldBytes() - before, 5'101'000, 10'000);
  blocks.clear();
  EXPECT_NEAR(HeldBytes(), before, 10'000);
}

}  // namespace
}  // namespace sidestep::cli
