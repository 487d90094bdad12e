#include "sidestep/render/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"
#include "tests/render/sample_recording.h"

namespace sidestep::render::comparison_test {
namespace {

using ::testing::HasSubstr;

bool IsRobot(Color c) { return c.g > 40 && c.g > 2 * c.r && c.g > 2 * c.b; }
bool IsTrolley(Color c) { return c.b > 60 && c.b > 2 * c.r && 10 * c.b > 22 * c.g; }
bool IsText(Color c) { return c.r > 200 && c.g > 200 && c.b > 200; }
bool IsContactFrame(Color c) { return c == ColorOf(Mood::kBad); }
std::function<bool(Color)> Is(Color color) {
  return [color](Color c) {
    return std::abs(c.r - color.r) + std::abs(c.g - color.g) + std::abs(c.b - color.b) < 40;
  };
}

struct Spot {
  int count = 0;
  double x = 0;  // of the middle
};

Spot Find(const Image& image, const PixelRect& rect, const std::function<bool(Color)>& accept) {
  Spot spot;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      if (!accept(image.At(x, y))) continue;
      ++spot.count;
      spot.x += x;
    }
  }
  if (spot.count > 0) spot.x /= spot.count;
  return spot;
}

constexpr PixelRect kQuarters[] = {
    {0, 40, 638, 321}, {642, 40, 638, 321}, {0, 365, 638, 321}, {642, 365, 638, 321}};
constexpr int kBar = 30;

PixelRect SceneOf(const PixelRect& panel) {
  return {panel.x, panel.y + kBar, panel.width, panel.height - 2 * kBar};
}
PixelRect TitleOf(const PixelRect& panel) { return {panel.x, panel.y, panel.width, kBar}; }
PixelRect StatusOf(const PixelRect& panel) {
  return {panel.x, panel.y + panel.height - kBar, panel.width, kBar};
}

std::vector<NamedRecording> FourTraces() {
  std::vector<NamedRecording> traces;
  for (const char* const knowledge :
       {"static", "execute_and_update", "prediction", "full_knowledge"}) {
    SampleEpisode episode;
    episode.knowledge = knowledge;
    episode.contact = traces.empty();
    traces.push_back({knowledge, MakeSampleRecording(episode)});
  }
  return traces;
}

std::vector<NamedRecording> OneTrace(const SampleEpisode& episode = {}) {
  return {{"sample", MakeSampleRecording(episode)}};
}

// Without the predicted obstacle, whose glass tints what is behind it.
std::vector<NamedRecording> OneBlindTrace(const SampleEpisode& episode = {}) {
  std::vector<NamedRecording> traces = OneTrace(episode);
  for (CycleRecord& cycle : traces[0].recording.cycles) cycle.objects.clear();
  return traces;
}

PictureOptions Small() {
  PictureOptions options;
  options.width = 640;
  options.height = 360;
  return options;
}

TEST(Comparison, ShowsRobotObstacleAndCaptionsInEveryPanel) {
  const GlContext gl;
  const std::vector<NamedRecording> traces = FourTraces();
  Comparison comparison(gl, traces, {});
  const Image image = comparison.Draw(EpisodeTime(0.9));
  for (const PixelRect& panel : kQuarters) {
    const PixelRect scene = SceneOf(panel);
    EXPECT_GT(Find(image, scene, IsRobot).count, 1000);
    EXPECT_GT(Find(image, scene, IsTrolley).count, 1000);
    EXPECT_LT(Find(image, scene, IsRobot).count, 40000);
    EXPECT_GT(Find(image, scene, Is(kPlanColor)).count, 30);
    EXPECT_GT(Find(image, scene, Is(kTrailColor)).count, 30);
    EXPECT_GT(Find(image, TitleOf(panel), IsText).count, 80);
    EXPECT_GT(Find(image, StatusOf(panel), IsText).count, 150);
    EXPECT_EQ(Find(image, panel, IsContactFrame).count, 0);
  }
  EXPECT_GT(Find(image, {0, 0, 300, 40}, IsText).count, 100) << "the scenario's name";
  EXPECT_GT(Find(image, {1080, 0, 200, 40}, IsText).count, 100) << "the clock";
  for (const Color color : {kTrailColor, kPlanColor, kPredictionColor, kContactColor}) {
    EXPECT_GT(Find(image, {0, 690, 1280, 30}, Is(color)).count, 150) << "the legend";
  }
}

TEST(Comparison, FramesAPanelInRedFromItsFirstContactOn) {
  const GlContext gl;
  const std::vector<NamedRecording> traces = FourTraces();
  Comparison comparison(gl, traces, {});
  for (const double t_s : {1.02, 1.8}) {
    const Image image = comparison.Draw(EpisodeTime(t_s));
    const PixelRect& touched = kQuarters[0];
    const PixelRect left_rim = {touched.x, touched.y, 3, touched.height};
    EXPECT_EQ(Find(image, left_rim, IsContactFrame).count, 3 * touched.height);
    EXPECT_GT(Find(image, StatusOf(touched), IsContactFrame).count, 10000);
    for (int i = 1; i < 4; ++i) EXPECT_EQ(Find(image, kQuarters[i], IsContactFrame).count, 0);
  }
}

TEST(Comparison, TintsWhatIsTouchedAndMarksTheSpotWhileItLasts) {
  const GlContext gl;
  SampleEpisode episode;
  episode.contact = true;  // from 1.00 s to 1.09 s
  const std::vector<NamedRecording> traces = OneBlindTrace(episode);
  Comparison comparison(gl, traces, Small());
  const PixelRect scene = {10, 40, 620, 280};
  const auto trolley = [&](double t_s) {
    return Find(comparison.Draw(EpisodeTime(t_s)), scene, IsTrolley).count;
  };
  const auto spot = [&](double t_s) {
    return Find(comparison.Draw(EpisodeTime(t_s)), scene, Is(kContactColor)).count;
  };
  EXPECT_GT(trolley(0.95), 500);
  EXPECT_LT(trolley(1.05), 50);
  EXPECT_GT(trolley(1.5), 500);
  EXPECT_EQ(spot(0.95), 0);
  EXPECT_GT(spot(1.05), 20);
  EXPECT_EQ(spot(1.5), 0);
}

TEST(Comparison, MovesTheObstacleAndTheArm) {
  const GlContext gl;
  const std::vector<NamedRecording> traces = OneBlindTrace();
  PictureOptions options = Small();
  options.camera = "from_above";  // the picture's right is the world's y
  Comparison comparison(gl, traces, options);
  const PixelRect scene = {0, 36, 640, 290};
  const Image early = comparison.Draw(EpisodeTime(0.7)), late = comparison.Draw(EpisodeTime(1.7));
  const Spot trolley_early = Find(early, scene, IsTrolley),
             trolley_late = Find(late, scene, IsTrolley);
  ASSERT_GT(trolley_early.count, 300);
  ASSERT_GT(trolley_late.count, 300);
  // It travels 1.2 m towards -y. The camera sees 45 degrees on the scene's 293 lines, so the top,
  // 4 m below it, moves by 106 pixels; what is seen of the sides moves a little less.
  EXPECT_NEAR(trolley_early.x - trolley_late.x, 106, 15);
  EXPECT_GT(std::abs(Find(early, scene, IsRobot).x - Find(late, scene, IsRobot).x), 10);
}

TEST(Comparison, DrawsThePredictedObstacle) {
  const GlContext gl;
  const std::vector<NamedRecording> traces = OneTrace();
  Comparison with(gl, traces, Small());
  const Image predicted = with.Draw(EpisodeTime(0.5));
  const std::vector<NamedRecording> blind = OneBlindTrace();
  Comparison without(gl, blind, Small());
  const Image plain = without.Draw(EpisodeTime(0.5));
  int differing = 0;
  for (int y = 40; y < 320; ++y) {
    for (int x = 0; x < 640; ++x) differing += predicted.At(x, y) != plain.At(x, y);
  }
  EXPECT_GT(differing, 2000);
}

TEST(Comparison, KeepsTheLastPictureOfAnEpisodeThatIsOver) {
  const GlContext gl;
  std::vector<NamedRecording> traces = FourTraces();
  SampleEpisode brief;
  brief.duration_s = 1.2;
  traces[1].recording = MakeSampleRecording(brief);
  Comparison comparison(gl, traces, {});
  EXPECT_EQ(comparison.end(), EpisodeTime(2));
  const Image at_end = comparison.Draw(EpisodeTime(1.2));
  const Image later = comparison.Draw(EpisodeTime(1.7));
  const auto same_scene = [&](const PixelRect& panel) {
    const PixelRect scene = SceneOf(panel);
    for (int y = scene.y; y < scene.y + scene.height; ++y) {
      for (int x = scene.x; x < scene.x + scene.width; ++x) {
        if (at_end.At(x, y) != later.At(x, y)) return false;
      }
    }
    return true;
  };
  EXPECT_TRUE(same_scene(kQuarters[1]));
  EXPECT_FALSE(same_scene(kQuarters[2]));
}

TEST(Comparison, DrawsTheSamePictureEachTime) {
  const GlContext gl;
  const std::vector<NamedRecording> traces = OneTrace();
  Comparison first(gl, traces, Small()), second(gl, traces, Small());
  const Image image = first.Draw(EpisodeTime(1));
  first.Draw(EpisodeTime(0.3));
  EXPECT_EQ(image, first.Draw(EpisodeTime(1)));
  EXPECT_EQ(image, second.Draw(EpisodeTime(1)));
}

TEST(Comparison, FitsAnyNumberOfPanels) {
  const GlContext gl;
  for (const int count : {2, 3, 5}) {
    const std::vector<NamedRecording> traces(static_cast<std::size_t>(count), OneTrace()[0]);
    Comparison comparison(gl, traces, Small());
    const Image image = comparison.Draw(EpisodeTime(0.9));
    const int robot_pixels = Find(image, {0, 0, 640, 360}, IsRobot).count;
    EXPECT_GT(robot_pixels, 100 * count) << count;
  }
}

TEST(Comparison, TellsMostAtTheFirstContactElseAtTheLeastClearance) {
  const GlContext gl;
  const std::vector<NamedRecording> traces = FourTraces();
  EXPECT_NEAR(Comparison(gl, traces, Small()).telling_moment().seconds(), 1.0, 1e-12);
  const std::vector<NamedRecording> clear = OneTrace();
  EXPECT_NEAR(Comparison(gl, clear, Small()).telling_moment().seconds(), 1.25, 1e-12);
}

TEST(Comparison, RefusesWhatCannotBeDrawn) {
  const GlContext gl;
  const auto refusal = [&](const std::vector<NamedRecording>& traces,
                           const PictureOptions& options) -> std::string {
    try {
      Comparison(gl, traces, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  PictureOptions tiny;
  tiny.width = tiny.height = 64;
  PictureOptions camera;
  camera.camera = "left";
  PictureOptions titles;
  titles.titles = {"one", "two"};
  EXPECT_EQ(refusal({}, {}), "TRACE: give at least one");
  EXPECT_EQ(refusal(std::vector<NamedRecording>(17, OneTrace()[0]), {}),
            "TRACE: at most 16 fit side by side");
  EXPECT_EQ(refusal(FourTraces(), tiny), "--size: 64x64 is too small for 4 traces");
  EXPECT_EQ(refusal(OneTrace(), camera), "--camera: 'left' is not in sample; it has from_above");
  EXPECT_EQ(refusal(OneTrace(), titles), "--title: give one for each of the 1 traces, not 2");
}

}  // namespace
}  // namespace sidestep::render::comparison_test
