#include "sidestep/core/time.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace sidestep::time_test {
namespace {

template <class A, class B>
concept CanAdd = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept CanSubtract = requires(A a, B b) {
  a - b;
};
template <class A, class B>
concept CanCompare = requires(A a, B b) {
  a < b;
};

// Two kinds of time that mixed would make every wrong prediction look right: held by the compiler.
static_assert(!std::is_convertible_v<HorizonOffset, EpisodeTime>);
static_assert(!std::is_convertible_v<EpisodeTime, HorizonOffset>);
static_assert(!std::is_constructible_v<EpisodeTime, HorizonOffset>);
static_assert(!std::is_constructible_v<HorizonOffset, EpisodeTime>);
static_assert(!std::is_convertible_v<double, EpisodeTime>);
static_assert(!std::is_convertible_v<double, HorizonOffset>);
static_assert(!std::is_convertible_v<EpisodeTime, double>);
static_assert(!std::is_convertible_v<HorizonOffset, double>);
static_assert(!std::is_assignable_v<EpisodeTime&, HorizonOffset>);
static_assert(!std::is_assignable_v<HorizonOffset&, EpisodeTime>);
static_assert(!CanCompare<EpisodeTime, HorizonOffset>);
static_assert(!CanAdd<EpisodeTime, EpisodeTime>);
static_assert(!CanAdd<EpisodeTime, double>);
static_assert(!CanSubtract<EpisodeTime, double>);
static_assert(!CanSubtract<HorizonOffset, EpisodeTime>);
// What is meant to work, so that the lines above do not pass because nothing does.
static_assert(CanAdd<EpisodeTime, HorizonOffset>);
static_assert(CanSubtract<EpisodeTime, EpisodeTime>);
static_assert(CanCompare<EpisodeTime, EpisodeTime>);
static_assert(CanCompare<HorizonOffset, HorizonOffset>);

TEST(Time, MomentsDifferByASpanAndMoveByIt) {
  const EpisodeTime start(1.5);
  const EpisodeTime end = start + HorizonOffset(0.25);
  EXPECT_EQ(end, EpisodeTime(1.75));
  EXPECT_EQ(end - start, HorizonOffset(0.25));
  EXPECT_EQ(start - end, HorizonOffset(-0.25));
  EXPECT_EQ(end - HorizonOffset(0.25), start);
}

TEST(Time, IsOrdered) {
  EXPECT_LT(EpisodeTime(0.1), EpisodeTime(0.2));
  EXPECT_LT(HorizonOffset(-1), HorizonOffset());
  EXPECT_EQ(EpisodeTime(), EpisodeTime(0));
}

}  // namespace
}  // namespace sidestep::time_test
