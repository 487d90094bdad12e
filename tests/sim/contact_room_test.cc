#include "sidestep/sim/contact_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sidestep/sim/world.h"
#include "sidestep/sim/world_xml.h"
#include "tests/sim/small_model.h"
#include "tests/sim/two_link.h"

namespace sidestep::sim::contact_room_test {
namespace {

// An arm across which three posts sweep at once.
scenarios::Scenario Sweep() {
  scenarios::Scenario scenario = TwoLinkScenario();
  for (const double x : {0.3, 0.35, 0.6}) {
    scenario.moving_obstacles.push_back(
        Passing("post at " + std::to_string(x), Cylinder{0.05, 1}, {x, 0.3, 0.3}, {0, -1, 0}, 0.6));
  }
  return scenario;
}

std::string Replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(ContactRoom, ThatIsMadeOnTheWayChangesNothing) {
  const scenarios::Scenario scenario = Sweep();
  const std::string xml = BuildWorldXml(scenario, {}, kTestModels);
  const std::string small =
      Replaced(Replaced(xml, "nconmax=\"50\"", "nconmax=\"1\""), "njmax=\"250\"", "njmax=\"4\"");
  World roomy(scenario, xml, LoadMujocoModel(xml, "roomy"), {"turn", "lift"}, scenario.q_start);
  World tight(scenario, small, LoadMujocoModel(small, "tight"), {"turn", "lift"}, scenario.q_start);
  const Eigen::Vector2d torque(3, -1);
  int most_contacts = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    roomy.Step(torque);
    tight.Step(torque);
    most_contacts = std::max(most_contacts, roomy.data().ncon);
    ASSERT_EQ(roomy.data().ncon, tight.data().ncon) << tick;
    ASSERT_EQ(roomy.q(), tight.q()) << tick;
    ASSERT_EQ(roomy.v(), tight.v()) << tick;
    ASSERT_EQ(roomy.motor_torque(), tight.motor_torque()) << tick;
    ASSERT_EQ(roomy.bias_torque(), tight.bias_torque()) << tick;
    ASSERT_EQ(roomy.time(), tight.time());
  }
  EXPECT_GE(most_contacts, 3);
  EXPECT_GE(tight.model().nconmax, most_contacts);
  EXPECT_EQ(roomy.model().nconmax, 50);
}

TEST(ContactRoom, HasAnEnd) {
  SmallModel m("<geom size='1'/>", "<size nconmax='10' njmax='6000'/>");
  EXPECT_FALSE(DoubleContactRoom(m.model.get(), &m.data));
  EXPECT_EQ(m.model->nconmax, 10);
  EXPECT_EQ(m.model->njmax, 6000);
}

TEST(ContactRoom, IsMissedOnlyWhereContactsWereDropped) {
  // Balls that all lie in one another.
  std::string bodies;
  for (int i = 0; i < 5; ++i)
    bodies += "<body pos='0 0 0.01'><freejoint/><geom size='0.1'/></body>";
  SmallModel m(bodies, "<size nconmax='3' njmax='100'/>");
  EXPECT_FALSE(LacksContactRoom(*m.data));
  mj_forward(m.model.get(), m.data.get());
  EXPECT_TRUE(LacksContactRoom(*m.data));
  while (LacksContactRoom(*m.data)) {
    ASSERT_TRUE(DoubleContactRoom(m.model.get(), &m.data));
    mj_forward(m.model.get(), m.data.get());
  }
  EXPECT_EQ(m.data->ncon, 10);
}

}  // namespace
}  // namespace sidestep::sim::contact_room_test
