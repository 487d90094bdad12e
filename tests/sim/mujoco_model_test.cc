#include "sidestep/sim/mujoco_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>
#include <vector>

#include "sidestep/core/input_error.h"
#include "tests/sim/small_model.h"

namespace sidestep::sim {
namespace {

constexpr const char* kBall = "<body><freejoint/><geom size='0.1'/></body>";

TEST(MujocoModel, SaysInOneLineWhatIsWrongWithAText) {
  try {
    LoadMujocoModel("<mujoco>\n<worldbody>\n<geom type='blob'/></worldbody></mujoco>", "thing.xml");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_THAT(what, testing::StartsWith("thing.xml: "));
    EXPECT_THAT(what, testing::HasSubstr("line 3"));
    EXPECT_EQ(what.find('\n'), std::string::npos);
  }
}

TEST(MujocoModel, MakesAnEngineErrorAnException) {
  const SmallModel ball(kBall);
  EXPECT_THROW(mj_stackAlloc(ball.data.get(), 1 << 30), SimulationError);
}

TEST(MujocoModel, NoticesADivergedStateAndWritesNoLogFile) {
  const SmallModel ball(kBall);
  mj_step(ball.model.get(), ball.data.get());
  EXPECT_FALSE(MujocoWarning(*ball.data).has_value());
  ball.data->qpos[0] = std::numeric_limits<double>::quiet_NaN();
  mj_step(ball.model.get(), ball.data.get());
  ASSERT_TRUE(MujocoWarning(*ball.data).has_value());
  EXPECT_THAT(*MujocoWarning(*ball.data), testing::HasSubstr("QPOS"));
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

TEST(MujocoModel, LoadsInManyThreadsAtOnce) {
  std::vector<std::thread> threads;
  std::vector<int> num_geoms(4, 0);
  for (int& count : num_geoms) {
    threads.emplace_back([&count] {
      for (int i = 0; i < 20; ++i) count += SmallModel(kBall).model->ngeom;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(num_geoms, testing::Each(20));
}

}  // namespace
}  // namespace sidestep::sim
