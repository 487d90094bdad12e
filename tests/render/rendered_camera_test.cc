#include "sidestep/render/rendered_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sidestep/core/number_text.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/world_xml.h"

namespace sidestep::render::rendered_camera_test {
namespace {

// A world in which a dark box goes past a small camera, one metre away, at a speed to its right.
class Passing {
 public:
  Passing(double speed_m_s, double exposure_s, const std::string& sensor = "rate_hz: 10")
      : scenario_(scenarios::ParseScenario(
            "description: A box passes a camera\n"
            "workspace: {first_center_m: [0, 0, 0], cell_m: 0.1, cells: [2, 2, 2]}\n"
            "floor_m: -1\n"
            "moving_obstacles:\n"
            "  - {name: box, shape: {box: {size_m: [0.1, 0.3, 0.3]}}, motion: {linear: "
            "{start_m: [0, -0.1, 0], direction: [0, 1, 0], speed_m_s: " +
                ShortestText(speed_m_s) +
                "}}}\n"
                "knowledge: prediction\n"
                "sensor: {name: tag_images, " +
                sensor +
                ", tag_images: {position_m: [1.05, 0, 0], look_at_m: [0, 0, 0], width: 100, "
                "height: 60, field_of_view_rad: 0.9272952180016122, grey_noise: 0, exposure_s: " +
                ShortestText(exposure_s) + "}}\nseed: 1\n",
            "passing.yaml")),
        xml_(sim::BuildWorldXml(scenario_, {}, "")),
        world_(scenario_, xml_, sim::LoadMujocoModel(xml_, "passing"), {}, Eigen::VectorXd()),
        camera_(scenario_, world_) {}

  std::optional<robot::Frame> Next() {
    while (world_.time() < camera_.NextDue()) world_.Step(Eigen::VectorXd());
    return camera_.Read(world_.time());
  }
  EpisodeTime now() const { return world_.time(); }

 private:
  scenarios::Scenario scenario_;
  std::string xml_;
  sim::World world_;
  RenderedCamera camera_;
};

// The brightness of the middle row.
std::vector<double> Row(const robot::Frame& frame) {
  const int y = frame.image.height / 2;
  std::vector<double> row;
  for (int x = 0; x < frame.image.width; ++x) row.push_back(frame.image.At(x, y));
  return row;
}

double Range(const std::vector<double>& row) {
  return *std::max_element(row.begin(), row.end()) - *std::min_element(row.begin(), row.end());
}

// Pixels between a tenth and nine tenths of the way from the one brightness to the other.
int SoftPixels(const std::vector<double>& row) {
  const double least = *std::min_element(row.begin(), row.end()), range = Range(row);
  return static_cast<int>(std::count_if(row.begin(), row.end(), [&](double level) {
    return level > least + 0.1 * range && level < least + 0.9 * range;
  }));
}

// Where the middle of the dark part is.
double Middle(const std::vector<double>& row) {
  const double most = *std::max_element(row.begin(), row.end());
  double sum = 0, moment = 0;
  for (std::size_t x = 0; x < row.size(); ++x) {
    sum += most - row[x];
    moment += static_cast<double>(x) * (most - row[x]);
  }
  return moment / sum;
}

TEST(RenderedCamera, SmearsWhatMovesEvenlyAboutTheTimeOfCapture) {
  Passing sharp(1, 0), smeared(1, 0.1), still(0, 0.1);
  sharp.Next();
  smeared.Next();
  still.Next();
  const robot::Frame at = sharp.Next().value(), over = smeared.Next().value();
  EXPECT_NEAR(at.t.seconds(), 0.1, 1e-9);
  EXPECT_EQ(over.t, at.t);
  // 100 pixels a metre away are a metre wide: in a tenth of a second it moves by ten of them.
  EXPECT_NEAR(Middle(Row(over)), Middle(Row(at)), 0.3);
  EXPECT_GT(SoftPixels(Row(over)), SoftPixels(Row(at)) + 8);
  EXPECT_LE(SoftPixels(Row(still.Next().value())), SoftPixels(Row(at)) + 1);
}

TEST(RenderedCamera, LooksWhereItIsPointed) {
  Passing scene(1, 0);
  scene.Next();
  // Its middle is at y = 0 then; the camera looks along -x, so y is to its right.
  EXPECT_NEAR(Middle(Row(scene.Next().value())), 49.5, 0.3);
  EXPECT_NEAR(Middle(Row(scene.Next().value())), 59.5, 0.3);
}

TEST(RenderedCamera, HasARateALatencyAndLostFrames) {
  Passing scene(0, 0, "rate_hz: 50, latency_s: 0.03, jitter_s: 0.01, dropout: 0.25");
  int arrived = 0;
  std::int64_t last = -1;
  while (scene.now() < EpisodeTime(4)) {
    const auto frame = scene.Next();
    if (!frame) continue;
    ++arrived;
    const double delay_s = (scene.now() - frame->t).seconds();
    EXPECT_GE(delay_s, 0.03 - 1e-9);
    EXPECT_LT(delay_s, 0.041);
    EXPECT_NEAR(frame->t.seconds() * 50, static_cast<double>(frame->number), 1e-6);
    EXPECT_GT(frame->number, last) << "what is lost is left out of the count";
    last = frame->number;
  }
  EXPECT_NEAR(arrived, 0.75 * 198, 4 * std::sqrt(0.25 * 0.75 * 198));
}

}  // namespace
}  // namespace sidestep::render::rendered_camera_test
