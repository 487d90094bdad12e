// A sweep through a real Slurm, where this machine has one (tests/support/local_slurm.sh).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kScript = SIDESTEP_SOURCE_DIR "/tests/support/local_slurm.sh";
constexpr int kNotHere = 77;

class SlurmTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Finished started = RunProgram({kScript, "start", slurm_.path().string()});
    if (started.exit_code == kNotHere) GTEST_SKIP() << started.out;
    ASSERT_EQ(started.exit_code, 0) << started.err;
    std::ofstream(file_) << "scenarios: [walkway_behaviours]\n"
                            "set: {planner.name: straight_line, horizon.duration_s: 1}\n"
                            "axes: {behaviour: [stop, turn], knowledge: [static, prediction]}\n"
                            "seeds: 3\n";
  }
  ~SlurmTest() override { RunProgram({kScript, "stop", slurm_.path().string()}); }

  std::string OutOf(const std::string& out) const { return (folder_.path() / out).string(); }
  Finished Sweep(const std::string& what, const std::string& out,
                 std::vector<std::string> further = {}) const {
    std::vector<std::string> words = {SIDESTEP_PROGRAM, "sweep", what, file_, "--out", OutOf(out)};
    words.insert(words.end(), further.begin(), further.end());
    return RunProgram(words, {"SLURM_CONF=" + (slurm_.path() / "slurm.conf").string()});
  }
  std::string Digest(const std::string& out) const {
    return RunProgram({SIDESTEP_PROGRAM, "verify", OutOf(out) + "/results.db", "--digest"}).out;
  }
  // Until nothing is in the queue; two minutes at most.
  std::string WaitForTheQueue(const std::string& out) const {
    std::string status;
    for (int i = 0; i < 240; ++i) {
      status = Sweep("status", out).out;
      if (status.find("in Slurm's queue") == std::string::npos) break;
      usleep(500'000);
    }
    return status;
  }

  const TemporaryFolder slurm_, folder_;
  const std::string file_ = (folder_.path() / "quick.yaml").string();
};

TEST_F(SlurmTest, ComesToTheSameResultsAsOneProcess) {
  // Its arrays hold indices up to 4, so 6 shards are two of them.
  const Finished submitted = Sweep("submit", "slurm", {"--slurm", "--shards", "6", "--time", "5"});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  EXPECT_THAT(submitted.out, HasSubstr("submitted 6 of 6 shards as jobs "));
  const Finished twice = Sweep("submit", "slurm", {"--slurm"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("jobs of it are in the queue"));
  EXPECT_THAT(WaitForTheQueue("slurm"), HasSubstr("12 of 12 runs are finished, 0 are missing"));
  ASSERT_EQ(Sweep("run", "one").exit_code, 0);
  EXPECT_EQ(Digest("slurm"), Digest("one"));

  // Only what is missing is submitted again.
  fs::remove(OutOf("slurm") + "/shards/2-of-6.rows");
  const Finished rest = Sweep("submit", "slurm", {"--slurm"});
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_THAT(rest.out, HasSubstr("submitted 1 of 6 shards"));
  EXPECT_THAT(WaitForTheQueue("slurm"), HasSubstr("12 of 12 runs are finished"));
  EXPECT_EQ(Digest("slurm"), Digest("one"));
  EXPECT_THAT(Sweep("submit", "slurm", {"--slurm"}).out, HasSubstr("nothing is missing"));
}

TEST_F(SlurmTest, SaysWhatSlurmComplainsOf) {
  const Finished wrong = Sweep("submit", "out", {"--slurm", "--partition", "nowhere"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("sbatch: "));
  EXPECT_THAT(wrong.err, HasSubstr("invalid partition"));
}

}  // namespace
}  // namespace sidestep
