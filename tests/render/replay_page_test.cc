#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/record/questions.h"
#include "sidestep/render/replay/page.h"
#include "sidestep/render/replay/replay.h"
#include "sidestep/render/replay/web_files.h"
#include "sidestep/render/timeline.h"
#include "tests/render/sample_recording.h"

namespace sidestep::render::replay_page_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Bytes = std::vector<std::uint8_t>;

// What the page does with changes, in its own language.
Bytes Apply(const Bytes& changes, Bytes values) {
  std::size_t at = 0, to = 0;
  const auto count = [&] {
    std::size_t number = 0;
    for (int shift = 0;; shift += 7) {
      const std::uint8_t byte = changes.at(at++);
      number += static_cast<std::size_t>(byte & 127) << shift;
      if (byte < 128) return number;
    }
  };
  while (at < changes.size()) {
    to += count();
    for (std::size_t end = to + count(); to < end; ++to) values.at(to) = changes.at(at++);
  }
  return values;
}

TEST(PackChanges, TurnsOneListIntoTheOther) {
  RandomStream random(1, "changes");
  for (const double share : {0.0, 0.01, 0.3, 0.6, 1.0}) {
    Bytes before(3000), now;
    for (std::uint8_t& byte : before) byte = static_cast<std::uint8_t>(255 * random.Uniform());
    now = before;
    for (std::uint8_t& byte : now) {
      if (random.Uniform() < share) byte = static_cast<std::uint8_t>(255 * random.Uniform());
    }
    EXPECT_EQ(Apply(PackChanges(before, now), before), now) << share;
  }
}

TEST(PackChanges, NeedsNothingForWhatStays) {
  EXPECT_TRUE(PackChanges(Bytes(100000, 7), Bytes(100000, 7)).empty());
  Bytes now(100000, 7);
  now[77777] = 8;
  EXPECT_LE(PackChanges(Bytes(100000, 7), now).size(), 5u);
}

TEST(PackChanges, RefusesTwoLengths) {
  EXPECT_THROW(PackChanges(Bytes(3), Bytes(4)), std::invalid_argument);
}

class SampleReplay : public ::testing::Test {
 protected:
  Replay Make(const SampleEpisode& episode = {}) {
    recording_ = MakeSampleRecording(episode);
    model_.emplace(recording_, "sample");
    return MakeReplay(*model_, {});
  }

  record::Recording recording_;
  std::optional<TraceModel> model_;
};

TEST_F(SampleReplay, PutsEveryGeomWhereMujocoDoesInEveryFrame) {
  const Replay replay = Make();
  const mjModel& model = model_->model();
  ASSERT_EQ(replay.geoms.size(), static_cast<std::size_t>(model.ngeom));
  for (std::size_t k = 0; k < replay.X_WB.size(); ++k) {
    model_->MoveTo(EpisodeTime(replay.step_s * static_cast<double>(k)));
    for (std::size_t g = 0; g < replay.geoms.size(); ++g) {
      const ReplayGeom& geom = replay.geoms[g];
      const Pose X_WG = geom.body < 0
                            ? geom.X_BG
                            : replay.X_WB[k][static_cast<std::size_t>(geom.body)] * geom.X_BG;
      const Eigen::Map<const Eigen::Vector3d> p_WG(model_->data().geom_xpos + 3 * g);
      ASSERT_LT((X_WG.translation() - p_WG).norm(), 1e-9) << "frame " << k << ", geom " << g;
    }
  }
}

TEST_F(SampleReplay, HasTheCornersOfMeshesWhereTheModelGivesThem) {
  recording_ = MakeSampleRecording({});
  const auto put = [&](const std::string& before, const std::string& what) {
    recording_.model_xml.insert(recording_.model_xml.find(before), what);
  };
  put("</asset>", R"(<mesh name="wedge" vertex="0 0 0 0.4 0 0 0 0.3 0 0 0 0.2"/>)");
  put("<body name=\"near_table\"",
      R"(<body name="rock" pos="1 2 0.5" euler="0 0 90"><geom type="mesh" mesh="wedge"/></body>)");
  model_.emplace(recording_, "sample");
  const Replay replay = MakeReplay(*model_, {});
  ASSERT_EQ(replay.meshes.size(), 1u);
  const auto geom = std::find_if(replay.geoms.begin(), replay.geoms.end(),
                                 [](const ReplayGeom& g) { return g.shape == ReplayShape::kMesh; });
  ASSERT_NE(geom, replay.geoms.end());
  // Turned by a quarter about z, at (1, 2, 0.5).
  const ReplayMesh& mesh = replay.meshes.front();
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(1, 2, 0.5), Eigen::Vector3d(1, 2.4, 0.5),
                                        Eigen::Vector3d(0.7, 2, 0.5), Eigen::Vector3d(1, 2, 0.7)}) {
    double nearest_m = 1;
    for (Eigen::Index v = 0; v < mesh.vertices_m.cols(); ++v) {
      const Eigen::Vector3d p_W = geom->X_BG * mesh.vertices_m.col(v).cast<double>().eval();
      nearest_m = std::min(nearest_m, (p_W - corner).norm());
    }
    EXPECT_LT(nearest_m, 1e-6) << corner.transpose();
  }
  EXPECT_EQ(mesh.triangles.cols(), 4);
  EXPECT_LT(mesh.triangles.maxCoeff(), mesh.vertices_m.cols());
}

TEST_F(SampleReplay, EndsWithTheTraceAndSaysWhatTheVideoSays) {
  const Replay replay = Make({.contact = true});
  const double frames = static_cast<double>(replay.X_WB.size() - 1);
  EXPECT_NEAR(replay.step_s * frames, record::EndOf(recording_).seconds(), 1e-12);
  EXPECT_EQ(replay.statuses.back().status.text,
            StatusAt(recording_, record::EndOf(recording_)).text);
  ASSERT_FALSE(replay.touches.empty());
  EXPECT_NEAR(replay.touches.front().first, record::FirstTouch(recording_)->t.seconds(), 1e-12);
}

TEST_F(SampleReplay, KeepsTheLeastClearanceOfALongTrace) {
  Make();
  TruthSample sample = recording_.truth.front();
  recording_.truth.clear();
  for (int i = 0; i < 20000; ++i) {
    sample.t = EpisodeTime(0.01 * i);
    sample.clearance_m = i == 11234 ? -0.0321 : 0.5;
    recording_.truth.push_back(sample);
  }
  const Replay replay = MakeReplay(*model_, {});
  EXPECT_LE(replay.clearance_m.size(), 6000u);
  EXPECT_EQ(*std::min_element(replay.clearance_m.begin(), replay.clearance_m.end()), -0.0321);
  EXPECT_LE(replay.X_WB.size(), 3001u);
}

TEST_F(SampleReplay, HoldsNoTextThatCouldBreakOutOfThePage) {
  const std::string evil = "</script><script>alert(1)</script>\"'&\xE9";
  Replay replay = Make();
  replay.name = replay.title.name = replay.title.explanation = replay.place = evil;
  replay.facts.push_back({"scenario", evil});
  replay.marks.push_back({0, evil, "plan"});
  const std::string json = ReplayJson({{replay}, {}});
  EXPECT_THAT(json, Not(HasSubstr("<")));
  EXPECT_EQ(nlohmann::json::parse(json)["traces"][0]["name"],
            "</script><script>alert(1)</script>\"'&\\xE9");
  const std::string page = ReplayPage(evil, {{replay}, {}});
  EXPECT_THAT(page, Not(HasSubstr("<script>alert(1)")));
  EXPECT_THAT(page, HasSubstr("<title>&lt;/script&gt;"));
}

TEST(ReplayScripts, CannotEndTheirElements) {
  for (const std::string_view script :
       {kThreeJs, kOrbitControlsJs, kReplayDataJs, kReplaySceneJs, kReplayChartJs, kReplayJs}) {
    EXPECT_GT(script.size(), 1000u);
    EXPECT_EQ(script.find("</script"), std::string_view::npos);
  }
  EXPECT_EQ(kReplayCss.find("</style"), std::string_view::npos);
}

}  // namespace
}  // namespace sidestep::render::replay_page_test
