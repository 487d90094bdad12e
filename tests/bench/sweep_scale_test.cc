// A hundred thousand runs, but for the running: what a sweep keeps, reads and merges of them.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/sweep/merge.h"
#include "sidestep/bench/sweep/shard_file.h"
#include "sidestep/core/random.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench {
namespace {

constexpr std::int64_t kMegabyte = 1 << 20;

std::int64_t MostMemory() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024;
}

TEST(SweepScale, OfAHundredThousandRunsNeedsLittleMemoryAndAKilobyteARun) {
  const SweepPlan plan(ParseSweep(
      "scenarios: [hall]\naxes: {speed_m_s: {from: 0.1, to: 1, step: 0.1}, knowledge: [static, "
      "prediction], planner.epsilon_m: [0.1, 0.2, 0.3, 0.4, 0.5]}\nseeds: 1000\n",
      "many.yaml"));
  ASSERT_EQ(plan.num_runs(), 100'000u);
  const TemporaryFolder folder;
  const ShardMaker maker{"build", "inputs"};
  for (const int number : {2, 1}) {
    ShardWriter shard(folder.path() / FileOf({number, 2}), maker, {{"hostname", "here"}});
    for (auto i = static_cast<std::uint64_t>(number - 1); i < plan.num_runs(); i += 2) {
      RandomStream random(i, "rows");
      RunRow row;
      row.outcome = i % 3 == 0 ? "goal" : "collision";
      for (const Metric& metric : Metrics()) row.metrics[metric.name] = random.Normal();
      row.drawn = {{"delay_s", random.Uniform()}};
      row.identity = {"0123456789abcdef", "0123456789abcdef", "build", ""};
      row.subject = {"panda", "gpmp_fast", plan.At(i).factors.at("knowledge"), "kalman_cv", 0.1};
      row.clock = {random.Uniform(),
                   random.Uniform(),
                   random.Uniform(),
                   random.Uniform(),
                   random.Uniform(),
                   1,
                   2};
      shard.Append(plan.KeyOf(i), RowText(row));
    }
  }
  const SweepRows rows(plan, folder.path(), maker);
  EXPECT_EQ(rows.num_done(), plan.num_runs());
  const std::string path = folder.path() / "results.db";
  MergeRows(plan, rows,
            {.path = path,
             .facts = {},
             .version = "sidestep 1",
             .command = [](const PlannedRun&) { return "sidestep run hall"; },
             .trace = [](std::uint64_t) { return ""; },
             .scenario = [](const PlannedRun&) { return "hall"; }});
  const RunDatabase database(path);
  EXPECT_EQ(database.num_runs(), 100'000);
  EXPECT_EQ(DigestOf(database).size(), 16u);
  EXPECT_LT(MostMemory(), 150 * kMegabyte);
  EXPECT_LE(std::filesystem::file_size(path), 100'000u * 1000);
  RecordProperty("bytes_a_run", static_cast<int>(std::filesystem::file_size(path) / 100'000));
  RecordProperty("memory_mb", static_cast<int>(MostMemory() / kMegabyte));
}

}  // namespace
}  // namespace sidestep::bench
