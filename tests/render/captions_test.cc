#include "sidestep/render/captions.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/render/sample_recording.h"

namespace sidestep::render::captions_test {
namespace {

TEST(Captions, NameWhatThePlannerWasTold) {
  const struct {
    const char *knowledge, *name;
  } cases[] = {{"static", "Static"},
               {"execute_and_update", "Execute and update"},
               {"prediction", "Prediction"},
               {"full_knowledge", "Full knowledge"},
               {"telepathy", "telepathy"}};
  for (const auto& c : cases) {
    record::Recording recording;
    recording.header["knowledge"] = c.knowledge;
    EXPECT_EQ(TitleOf(recording, "trace.h5").name, c.name);
  }
  EXPECT_EQ(TitleOf(record::Recording(), "trace.h5").name, "trace.h5");
}

struct StatusCase {
  bool contact;
  double t_s;
  const char* text;
  Mood mood;
};

TEST(Captions, TellHowTheEpisodeStands) {
  const StatusCase cases[] = {
      {false, 0.0, "clearance 281 mm, least so far 281 mm", Mood::kNeutral},
      {false, 1.2, "clearance 41 mm, least so far 41 mm", Mood::kNear},
      {false, 1.5, "clearance 81 mm, least so far 31 mm", Mood::kNeutral},
      {false, 1.95, "goal reached at 1.90 s, least clearance 31 mm", Mood::kGood},
      {true, 0.99, "clearance 83 mm, least so far 83 mm", Mood::kNeutral},
      {true, 1.0, "CONTACT at 1.00 s with trolley", Mood::kBad},
      {true, 2.0, "CONTACT at 1.00 s with trolley", Mood::kBad},
  };
  for (const StatusCase& c : cases) {
    SampleEpisode episode;
    episode.contact = c.contact;
    const Status status = StatusAt(MakeSampleRecording(episode), EpisodeTime(c.t_s + 1e-9));
    EXPECT_EQ(status.text, c.text);
    EXPECT_EQ(status.mood, c.mood) << c.text;
  }
}

TEST(Captions, SayThatTheGoalWasNotReachedOnlyAtTheEnd) {
  record::Recording recording = MakeSampleRecording({});
  recording.metrics["time_to_goal_s"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(StatusAt(recording, EpisodeTime(1.99)).mood, Mood::kNeutral);
  EXPECT_EQ(StatusAt(recording, EpisodeTime(2.0)).text, "goal not reached, least clearance 31 mm");
  EXPECT_EQ(StatusAt(recording, EpisodeTime(2.0)).mood, Mood::kNear);
}

TEST(Captions, OfAnAbortedRunSaySoAtItsEnd) {
  record::Recording recording = MakeSampleRecording({});
  recording.header["outcome"] = "aborted";
  EXPECT_EQ(StatusAt(recording, EpisodeTime(1.5)).mood, Mood::kNeutral);
  EXPECT_EQ(StatusAt(recording, EpisodeTime(2.0)).text, "ABORTED at 2.00 s");
  EXPECT_EQ(StatusAt(recording, EpisodeTime(2.0)).mood, Mood::kBad);
  SampleEpisode with_contact;
  with_contact.contact = true;
  recording = MakeSampleRecording(with_contact);
  recording.header["outcome"] = "aborted";
  EXPECT_EQ(StatusAt(recording, EpisodeTime(1.5)).text, "CONTACT at 1.00 s with trolley");
  EXPECT_EQ(StatusAt(recording, EpisodeTime(2.0)).text,
            "CONTACT at 1.00 s with trolley, ABORTED at 2.00 s");
}

TEST(Captions, DoNotPraiseAGoalWhereNobodyJudgedContact) {
  record::Recording recording = MakeSampleRecording({});
  recording.truth.clear();
  recording.header["outcome"] = "unjudged";
  EXPECT_EQ(StatusAt(recording, EpisodeTime(1.0)).text, "contact unjudged");
  EXPECT_EQ(StatusAt(recording, EpisodeTime(1.95)).text,
            "goal reached at 1.90 s, contact unjudged");
  EXPECT_EQ(StatusAt(recording, EpisodeTime(1.95)).mood, Mood::kNeutral);
}

TEST(Captions, DoNotHideThatTimeRanOutWhereNobodyJudgedContact) {
  record::Recording recording = MakeSampleRecording({});
  recording.truth.clear();
  recording.metrics["time_to_goal_s"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(StatusAt(recording, EpisodeTime(2.0)).text, "goal not reached, contact unjudged");
  EXPECT_EQ(StatusAt(recording, EpisodeTime(2.0)).mood, Mood::kNear);
}

TEST(Captions, TellForASecondWhatTheSupervisorDid) {
  record::Recording recording = MakeSampleRecording({});
  recording.safety = {{EpisodeTime(0.2), "splice", "refuse", 0.1, 0.01},
                      {EpisodeTime(0.3), "stop_path", "hold", -0.01, 0},
                      {EpisodeTime(0.4), "clearance", "none", 0.02, 0.05}};
  const auto at = [&](double t_s) { return StatusAt(recording, EpisodeTime(t_s)); };
  const std::string none = StatusAt(MakeSampleRecording({}), EpisodeTime(0.1)).text;
  EXPECT_EQ(at(0.1).text, none);
  EXPECT_EQ(at(0.25).text.find("supervisor refuses a plan: splice; clearance "), 0u);
  EXPECT_EQ(at(0.25).mood, Mood::kNeutral);
  EXPECT_EQ(at(1.2).text.find("supervisor HOLDS: stop path; clearance "), 0u);
  EXPECT_EQ(at(1.2).mood, Mood::kNear);
  EXPECT_EQ(at(1.35).text.find("supervisor notes: clearance; clearance "), 0u);
  EXPECT_EQ(at(1.41).text.find("clearance "), 0u);
  recording.safety.push_back({EpisodeTime(1.9), "tracking", "brake", 0.03, 0.02});
  recording.header["outcome"] = "aborted";
  EXPECT_EQ(at(2.0).text, "supervisor BRAKES: tracking; ABORTED at 2.00 s");
  EXPECT_EQ(at(2.0).mood, Mood::kBad);
}

TEST(Captions, SayWhereTheRobotWasOnHardware) {
  record::Recording recording = MakeSampleRecording({});
  EXPECT_EQ(PlaceOf(recording), "");
  recording.header["robot_at"] = "172.16.0.2";
  EXPECT_EQ(PlaceOf(recording), "robot at 172.16.0.2, obstacles virtual");
  recording.header["camera"] = "RealSense 1234";
  EXPECT_EQ(PlaceOf(recording), "robot at 172.16.0.2, obstacles seen by a camera (RealSense 1234)");
  recording.obstacles.clear();
  EXPECT_EQ(PlaceOf(recording), "robot at 172.16.0.2");
}

TEST(Captions, AreSilentAboutWhatWasNotRecorded) {
  EXPECT_EQ(StatusAt(record::Recording(), EpisodeTime(0)).text, "");
}

}  // namespace
}  // namespace sidestep::render::captions_test
