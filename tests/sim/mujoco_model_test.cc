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

TEST(MujocoModel, SaysAtItsLineWhatIsWrongWithAText) {
  const struct {
    const char* text;
    const char* message;
  } cases[] = {
      {"<mujoco>\n<worldbody>\n<geom type='blob'/></worldbody></mujoco>",
       "thing.xml:3: geom: invalid keyword: 'blob'"},
      {"<mujoco>\n<worldbody>\n<body>\n<joint foo='1'/></body></worldbody></mujoco>",
       "thing.xml:4: joint: Schema violation: unrecognized attribute: 'foo'"},
      {"<mujoco>\n<worldbody>\n<body/>\n<body name='a'/><body name='a'/></worldbody></mujoco>",
       "thing.xml:4: a: repeated name in body array, position 3"},
      {"<mujoco>\n<worldbody>\n<body>\n<joint/></body></worldbody></mujoco>",
       "thing.xml:3: mass and inertia of moving bodies must be larger than mjMINVAL"},
      {"", "thing.xml: is empty"},
      {"", "thing.xml: is empty"},
      {"<mujoco>\n<worldbody></mujoco>", "thing.xml:2: is no well-formed XML: mismatched element"},
  };
  for (const auto& c : cases) {
    EXPECT_THAT([&] { LoadMujocoModel(c.text, "thing.xml"); },
                testing::ThrowsMessage<InputError>(testing::StrEq(c.message)));
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
