#include "sidestep/record/questions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sidestep::record {
namespace {

// Two seconds of truth, 100 Hz: 31 mm + 0.2 m/s |t - 1.25 s|.
Recording Passing() {
  Recording recording;
  for (int i = 0; i <= 200; ++i) {
    TruthSample sample;
    sample.t = EpisodeTime(0.01 * i);
    sample.clearance_m = 0.031 + 0.2 * std::abs(0.01 * i - 1.25);
    recording.truth.push_back(sample);
  }
  return recording;
}

// The same, with something touched from 1.00 s to 1.09 s.
Recording Touching() {
  Recording recording = Passing();
  for (TruthSample& sample : recording.truth) {
    if (sample.t < EpisodeTime(0.995) || sample.t > EpisodeTime(1.095)) continue;
    sample.in_contact = true;
    sample.contact_s = sample.t.seconds();
    sample.contact_object = "trolley";
  }
  return recording;
}

TEST(Questions, TheEndIsWhereTheLastSampleIs) {
  Recording recording = Passing();
  EXPECT_EQ(EndOf(recording), EpisodeTime(2));
  recording.control.emplace_back().t = EpisodeTime(4);
  EXPECT_EQ(EndOf(recording), EpisodeTime(4));
  EXPECT_EQ(EndOf(Recording()), EpisodeTime(0));
}

TEST(Questions, WhatWasAbortedSaysWhy) {
  Recording recording;
  EXPECT_EQ(WhyAborted(recording), std::nullopt);
  recording.header["outcome"] = "planner_failed";
  recording.header["reason"] = "none of 3 plans was free";
  EXPECT_EQ(WhyAborted(recording), std::nullopt);
  recording.header["outcome"] = "aborted";
  recording.header["reason"] = "the robot sends no state";
  EXPECT_EQ(WhyAborted(recording), "the robot sends no state");
  recording.header.erase("reason");
  EXPECT_EQ(WhyAborted(recording), "the trace does not say why");
}

TEST(Questions, TheTickOfAMomentIsTheLatestUntilThen) {
  Recording recording;
  EXPECT_EQ(TickAt(recording, EpisodeTime(1)), nullptr);
  for (const double t_s : {0.5, 0.501, 0.502})
    recording.control.emplace_back().t = EpisodeTime(t_s);
  EXPECT_EQ(TickAt(recording, EpisodeTime(0.501)), &recording.control[1]);
  EXPECT_EQ(TickAt(recording, EpisodeTime(0.5019)), &recording.control[1]);
  EXPECT_EQ(TickAt(recording, EpisodeTime(2)), &recording.control[2]);
  EXPECT_EQ(TickAt(recording, EpisodeTime(0)), &recording.control[0]);
}

TEST(Questions, TheLeastClearanceIsThatUpToAMoment) {
  const Recording recording = Passing();
  EXPECT_NEAR(LeastClearance(recording, EpisodeTime(0.5))->clearance_m, 0.031 + 0.15, 1e-12);
  EXPECT_NEAR(LeastClearance(recording, EpisodeTime(2))->clearance_m, 0.031, 1e-12);
  EXPECT_NEAR(LeastClearance(recording)->t.seconds(), 1.25, 1e-12);
  EXPECT_NEAR(ClearanceAt(recording, EpisodeTime(2))->clearance_m, 0.031 + 0.15, 1e-12);
  EXPECT_NEAR(ClearanceAt(recording, EpisodeTime(1.259))->clearance_m, 0.031, 1e-12);
  EXPECT_FALSE(LeastClearance(Recording()));
  EXPECT_FALSE(ClearanceAt(Recording(), EpisodeTime(2)));
}

TEST(Questions, ATouchIsKnownFromWhenItHappenedOn) {
  EXPECT_FALSE(FirstTouch(Passing()));
  const Recording recording = Touching();
  ASSERT_TRUE(FirstTouch(recording));
  EXPECT_NEAR(FirstTouch(recording)->t.seconds(), 1.0, 1e-12);
  EXPECT_EQ(FirstTouch(recording)->object, "trolley");
  EXPECT_FALSE(FirstTouch(recording, EpisodeTime(0.999)));
  EXPECT_NEAR(FirstTouch(recording, EpisodeTime(1.5))->t.seconds(), 1.0, 1e-12);
}

TEST(Questions, ATouchIsRecentForAsLongAsTheWindowIs) {
  const Recording recording = Touching();
  const HorizonOffset window(0.25);
  EXPECT_FALSE(TouchWithin(recording, EpisodeTime(0.99), window));
  EXPECT_NEAR(TouchWithin(recording, EpisodeTime(1.052), window)->t.seconds(), 1.05, 1e-12);
  EXPECT_NEAR(TouchWithin(recording, EpisodeTime(1.30), window)->t.seconds(), 1.09, 1e-12);
  EXPECT_FALSE(TouchWithin(recording, EpisodeTime(1.36), window));
}

TEST(Questions, OfWhatTheSupervisorFoundTheGravestCounts) {
  Recording recording;
  recording.safety = {{EpisodeTime(1.0), "splice", "refuse", 1, 0},
                      {EpisodeTime(1.1), "stop_path", "hold", 1, 0},
                      {EpisodeTime(1.2), "clearance", "hold", 1, 0},
                      {EpisodeTime(1.3), "link", "none", 1, 0}};
  const HorizonOffset window(0.25);
  EXPECT_FALSE(FindingWithin(recording, EpisodeTime(0.99), window));
  EXPECT_EQ(FindingWithin(recording, EpisodeTime(1.05), window)->check, "splice");
  EXPECT_EQ(FindingWithin(recording, EpisodeTime(1.32), window)->check, "clearance");
  EXPECT_EQ(FindingWithin(recording, EpisodeTime(1.5), window)->check, "link");
  EXPECT_FALSE(FindingWithin(recording, EpisodeTime(1.6), window));
  EXPECT_EQ(*FirstStop(recording), EpisodeTime(1.1));
  EXPECT_FALSE(FirstStop(Recording()));
}

TEST(Questions, ATouchWithoutATimeHappenedAtItsSample) {
  Recording recording;
  TruthSample sample;
  sample.t = EpisodeTime(0.42);
  sample.in_contact = true;
  recording.truth = {sample};
  EXPECT_EQ(FirstTouch(recording)->t, EpisodeTime(0.42));
}

}  // namespace
}  // namespace sidestep::record
