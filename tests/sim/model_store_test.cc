// Models that are compiled once.
#include "sidestep/sim/model_store.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"

namespace sidestep::sim::model_store_test {
namespace {

std::string Swing(const std::string& mass) {
  return "<mujoco><worldbody><body name='bob' pos='0 0 1'><joint name='pin' axis='0 1 0'/>"
         "<geom type='capsule' fromto='0 0 0 .3 0 .1' size='.03' mass='" +
         mass + "'/></body><geom type='plane' size='1 1 1'/></worldbody></mujoco>";
}

std::vector<mjtNum> After(const mjModel& model, int ticks) {
  const MujocoDataPtr data = MakeMujocoData(model);
  for (int i = 0; i < ticks; ++i) mj_step(&model, data.get());
  std::vector<mjtNum> state(data->qpos, data->qpos + model.nq);
  state.insert(state.end(), data->qvel, data->qvel + model.nv);
  return state;
}

TEST(ModelStore, GivesEveryoneTheSameModelToTheBitAndCompilesItOnce) {
  ModelStore store;
  const MujocoModelPtr compiled = LoadMujocoModel(Swing("1"), "swing");
  const MujocoModelPtr first = store.Load(Swing("1"), "swing");
  const MujocoModelPtr second = store.Load(Swing("1"), "swing");
  EXPECT_EQ(store.num_compiled(), 1);
  ASSERT_EQ(second->nbuffer, compiled->nbuffer);
  EXPECT_EQ(std::memcmp(&second->opt, &compiled->opt, sizeof compiled->opt), 0);
  EXPECT_EQ(After(*first, 700), After(*compiled, 700)) << "it has met the floor by then";
  EXPECT_EQ(After(*second, 700), After(*compiled, 700));
}

TEST(ModelStore, IsNotChangedByWhoChangesItsModel) {
  ModelStore store;
  store.Load(Swing("1"), "swing")->opt.gravity[2] = 0;
  EXPECT_NE(store.Load(Swing("1"), "swing")->opt.gravity[2], 0);
}

TEST(ModelStore, CompilesAnotherTextAndKeepsTheLastOnes) {
  ModelStore store;
  for (std::size_t i = 0; i <= ModelStore::kMostKept; ++i) {
    EXPECT_EQ(store.Load(Swing(std::to_string(i + 1)), "swing")->body_mass[1],
              static_cast<double>(i + 1));
    store.Load(Swing("1"), "swing");  // asked for again and again: it stays
  }
  EXPECT_EQ(store.num_compiled(), static_cast<int>(ModelStore::kMostKept) + 1);
  store.Load(Swing("2"), "swing");
  EXPECT_EQ(store.num_compiled(), static_cast<int>(ModelStore::kMostKept) + 2);
}

TEST(ModelStore, KeepsNothingOfWhatIsNoModel) {
  ModelStore store;
  for (int i = 0; i < 2; ++i) EXPECT_THROW(store.Load("<mujoco", "swing"), InputError);
  EXPECT_EQ(store.num_compiled(), 0);
}

}  // namespace
}  // namespace sidestep::sim::model_store_test
