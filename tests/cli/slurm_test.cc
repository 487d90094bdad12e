#include "sidestep/cli/slurm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"

namespace sidestep::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(DivideIntoArrays, KeepsIndicesBelowTheSitesLimit) {
  std::vector<int> shards;
  for (int shard = 1; shard <= 25; ++shard) {
    if (shard != 7) shards.push_back(shard);
  }
  const std::vector<SlurmArray> arrays = DivideIntoArrays(shards, 11);
  ASSERT_EQ(arrays.size(), 3u);
  EXPECT_EQ(ArrayText(arrays[0].indices), "1-6,8-10");
  EXPECT_EQ(ArrayText(arrays[1].indices), "1-10");
  EXPECT_EQ(ArrayText(arrays[2].indices), "1-5");
  std::vector<int> all;
  for (const SlurmArray& array : arrays) {
    for (const int index : array.indices) {
      EXPECT_LT(index, 11);
      all.push_back(array.offset + index);
    }
  }
  EXPECT_EQ(all, shards);
}

TEST(ArrayText, JoinsNeighbours) {
  EXPECT_EQ(ArrayText({3}), "3");
  EXPECT_EQ(ArrayText({1, 2, 4, 6, 7, 8}), "1-2,4,6-8");
}

TEST(SbatchCommand, PassesOnWhatIsAsked) {
  const SlurmRequest request{"01:00:00", "short", "lab", {"--mem=4G"}, 8};
  const std::string shards = Joined(
      SbatchCommand(request, "sidestep-pace", "log", {1, 2, 3}, 2, {}, "shard.sh", {"0", "3"}),
      " ");
  EXPECT_EQ(shards,
            "sbatch --parsable --job-name=sidestep-pace --output=log --cpus-per-task=8 "
            "--array=1-3%2 --signal=B:TERM@60 --time=01:00:00 --partition=short --account=lab "
            "--mem=4G shard.sh 0 3");
  const std::string merge =
      Joined(SbatchCommand({}, "merge", "log", {}, 0, {"12", "13"}, "merge.sh", {}), " ");
  EXPECT_THAT(merge, HasSubstr("--dependency=afterany:12:13"));
  EXPECT_THAT(merge, Not(HasSubstr("--array")));
}

TEST(MaxArraySizeIn, IsTheSites) {
  EXPECT_EQ(MaxArraySizeIn("Foo = 1\nMaxArraySize            = 10001\nMaxDBDMsgs = 20000\n"),
            10001);
  EXPECT_EQ(MaxArraySizeIn("nothing"), 1001);
}

TEST(StatesIn, CountsTasks) {
  const auto states = StatesIn("RUNNING\nPENDING\nRUNNING\n");
  EXPECT_EQ(states.at("RUNNING"), 2);
  EXPECT_EQ(states.at("PENDING"), 1);
}

TEST(RunSlurm, SaysWhereThereIsNoSuchProgram) {
  try {
    RunSlurm({"no-such-sbatch"});
    FAIL() << "was found";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no-such-sbatch: there is no such program here"));
  }
}

}  // namespace
}  // namespace sidestep::cli
