#include "sidestep/cli/sweep_runner.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "sidestep/bench/json_text.h"
#include "sidestep/bench/process_pool.h"
#include "sidestep/bench/sweep/merge.h"
#include "sidestep/cli/build_id.h"
#include "sidestep/cli/case_row.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/machine.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_case.h"
#include "sidestep/cli/stop_signals.h"
#include "sidestep/cli/sweep_fault.h"
#include "sidestep/cli/sweep_progress.h"
#include "sidestep/cli/versions.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/fingerprint.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/text_file.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/scenarios/variations.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlanFormat = "sidestep-plan-1";
constexpr std::uintmax_t kMaxPlanBytes = 1 << 20;
// Of an axis, that are resolved before the work: evenly chosen, the first and the last among them.
constexpr std::size_t kMostChecked = 50;
constexpr std::uint64_t kMostTried = 1000;

// Why rows of one maker are none of the other.
std::string Difference(const bench::ShardMaker& before, const bench::ShardMaker& now) {
  if (before.build != now.build) return "holds runs of another build of sidestep";
  return "holds runs of other scenarios, settings or robots (a file of theirs has changed, or "
         "`set` or `variations`)";
}

}  // namespace

SweepRunner::SweepRunner(const bench::SweepPlan& plan, const std::string& folder, std::string out,
                         DataPaths paths)
    : plan_(plan),
      folder_((fs::current_path() / folder).lexically_normal().string()),
      out_(std::move(out)),
      paths_(std::move(paths)),
      make_world_(SimulatedWorlds(paths_)) {}

std::string SweepRunner::ScenarioOf(const bench::PlannedRun& run) const {
  const std::string& name = run.scenario;
  const bool is_path = name.find('/') != std::string::npos || name.ends_with(".yaml");
  if (!is_path) return name;
  // From the root, so that the results can be run again from anywhere.
  return (fs::path(folder_) / name).lexically_normal().string();
}

bench::Factors SweepRunner::AllFactorsOf(const bench::PlannedRun& run) const {
  const scenarios::Settings& settings = plan_.sweep().settings;
  bench::Factors all(settings.begin(), settings.end());
  all.insert(run.factors.begin(), run.factors.end());
  all["seed"] = std::to_string(run.seed);
  return all;
}

std::string SweepRunner::CommandOf(const bench::PlannedRun& run) const {
  bench::Factors factors = AllFactorsOf(run);
  factors.erase("seed");
  return RunCommandOf(ScenarioOf(run), factors);
}

std::string SweepRunner::TraceOf(std::uint64_t key) const {
  return "traces/" + bench::KeyText(key) + ".h5";
}

bool SweepRunner::WantsTrace(const std::string& outcome) const {
  switch (plan_.sweep().traces) {
    case bench::KeptTraces::kNone:
      return false;
    case bench::KeptTraces::kFailures:
      return outcome != ToString(bench::Outcome::kGoal);
    case bench::KeptTraces::kAll:
      break;
  }
  return true;
}

SweepRunner::Checked SweepRunner::Check() const {
  const bench::Sweep& sweep = plan_.sweep();
  std::vector<bench::PlannedRun> asked;
  const auto first = [&](const std::string& scenario) {
    bench::PlannedRun run = plan_.At(0);
    run.scenario = scenario;
    return run;
  };
  for (const std::string& scenario : sweep.scenarios) {
    asked.push_back(first(scenario));
    for (const bench::SweepAxis& axis : sweep.axes) {
      const std::size_t count = std::min(axis.values.size(), kMostChecked);
      for (std::size_t i = 1; i < count; ++i) {
        bench::PlannedRun& run = asked.emplace_back(first(scenario));
        run.factors[axis.name] = axis.values[i * (axis.values.size() - 1) / (count - 1)];
      }
    }
  }
  Checked checked;
  std::set<std::string> models;
  std::optional<InputError> first_error;
  const auto check = [&](const bench::PlannedRun& run) {
    ++checked.num_checked;
    try {
      const Problem problem = LoadCase(ScenarioOf(run), AllFactorsOf(run), paths_, &robots_);
      const bench::RunIdentity identity = Identify(problem.scenario, paths_);
      models.insert(identity.models);
      checked.seed_matters =
          checked.seed_matters || !scenarios::WhatTheSeedChanges(problem.scenario).empty();
      if (checked.description.empty()) checked.description = problem.scenario.description;
      return true;
    } catch (const InputError& fault) {
      const InputError error = FaultInSweep(sweep, fault);
      if (!first_error) first_error = error;
      std::string what = run.scenario;
      for (const auto& [factor, value] : run.factors) what += ", " + factor + " " + value;
      checked.refused.push_back(what + ": " + error.what());
      return false;
    }
  };
  bool can_be_run = false;
  for (const bench::PlannedRun& run : asked) can_be_run = check(run) || can_be_run;
  // Perhaps the first values of two axes are both wrong.
  for (std::uint64_t c = 0; c < std::min(plan_.num_combinations(), kMostTried) && !can_be_run;
       ++c) {
    can_be_run = check(plan_.At(plan_.FirstOf(c)));
  }
  if (!can_be_run) throw *first_error;
  // Without the values that are varied, so that there may be others some other time.
  Fingerprint inputs;
  for (const std::string& scenario : sweep.scenarios) {
    bench::PlannedRun plain = first(scenario);
    plain.factors.clear();
    try {
      inputs.Add(IdentityOf(plain).scenario);
    } catch (const InputError&) {
      inputs.Add("needs what is varied");
    }
  }
  for (const std::string& robot : models) inputs.Add(robot);
  checked.inputs = inputs.Text();
  return checked;
}

bench::RunIdentity SweepRunner::IdentityOf(const bench::PlannedRun& run) const {
  return Identify(LoadCase(ScenarioOf(run), AllFactorsOf(run), paths_, &robots_).scenario, paths_);
}

void SweepRunner::CheckSeeds(const Checked& checked) const {
  if (plan_.sweep().seeds.size() < 2 || checked.seed_matters) return;
  const bench::Sweep& sweep = plan_.sweep();
  const auto line = sweep.lines.find("seeds");
  throw InputError(sweep.file, line == sweep.lines.end() ? 1 : line->second, "seeds",
                   "a seed changes nothing: the scenario has no variations, nothing walks at "
                   "random, and its sensor is perfect");
}

bench::ShardMaker SweepRunner::Maker() const {
  const std::string path = out_ + "/plan.json";
  const auto plan = nlohmann::json::parse(ReadTextFile(path, kMaxPlanBytes), nullptr, false);
  if (!plan.is_object() || plan.value("format", "") != kPlanFormat) {
    throw InputError(path, "is no plan of this version of sidestep");
  }
  return {plan.value("build", ""), plan.value("inputs", "")};
}

std::string SweepRunner::WhatChanged() const {
  const bench::ShardMaker before = Maker();
  try {
    const bench::ShardMaker now{BuildId(), Check().inputs};
    return before == now ? "" : out_ + ": " + Difference(before, now);
  } catch (const InputError& error) {
    return error.what();
  }
}

bench::ShardMaker SweepRunner::Prepare(bool again) const {
  const Checked checked = Check();
  CheckSeeds(checked);
  bench::ShardMaker maker{BuildId(), checked.inputs};
  MakeOutFolder(out_, {"plan.json"});
  MakeOutFolder(shards(), {});
  if (plan_.sweep().traces != bench::KeptTraces::kNone) MakeOutFolder(out_ + "/traces", {});
  std::error_code error;
  if (fs::exists(out_ + "/plan.json", error)) {
    const bench::ShardMaker before = Maker();
    if (before == maker) return maker;
    if (!again) {
      throw InputError(out_, Difference(before, maker) +
                                 ": take another folder by --out, or let --again run them again "
                                 "(what is there stays in the shards, and counts no more)");
    }
  }
  WriteFile(out_ + "/plan.json", bench::JsonText({{"format", kPlanFormat},
                                                  {"sweep", plan_.sweep().name},
                                                  {"build", maker.build},
                                                  {"inputs", maker.inputs}}));
  return maker;
}

bench::RunRow SweepRunner::RunOne(std::uint64_t index) const {
  const bench::PlannedRun run = plan_.At(index);
  bench::RecordedRun done = RunCase(ScenarioOf(run), AllFactorsOf(run), plan_.sweep().search,
                                    paths_, make_world_, &robots_);
  if (done.recording && WantsTrace(done.row.outcome)) {
    AddProvenance(done.row.identity, *done.recording);
    record::WriteRecording(*done.recording, out_ + "/" + TraceOf(plan_.KeyOf(index)));
  }
  return std::move(done.row);
}

bool SweepRunner::Run(const RunOptions& options) const {
  const bench::ShardMaker maker = Prepare(options.again);
  const bench::ShardName& mine = options.shard;
  bench::ShardWriter shard(shards() + "/" + FileOf(mine), maker, Machine());
  // Other shards of the same division hold other runs.
  const bench::SweepRows before(plan_, shards(), maker, [&](const bench::ShardName& other) {
    return other.of == mine.of && other.number != mine.number;
  });
  for (const std::string& line : before.damage()) PrintError("{}\n", line);
  const auto is_done = [&](std::uint64_t index) {
    if (!before.Has(index)) return false;
    if (plan_.sweep().traces == bench::KeptTraces::kNone) return true;
    const bench::RunRow row = before.Read(index).row;
    const bool has_none = row.metrics.empty() || IsSearch(AllFactorsOf(plan_.At(index)));
    std::error_code error;
    return has_none || !WantsTrace(row.outcome) ||
           fs::exists(out_ + "/" + TraceOf(plan_.KeyOf(index)), error);
  };
  const auto step = static_cast<std::uint64_t>(mine.of);
  const auto begin = static_cast<std::uint64_t>(mine.number - 1);
  std::vector<std::uint64_t> missing;
  std::uint64_t count = 0;
  for (std::uint64_t index = begin; index < plan_.num_runs(); index += step) {
    ++count;
    if (!is_done(index)) missing.push_back(index);
  }
  if (missing.size() < count) {
    PrintError("{} of {} runs, from before\n", count - missing.size(), count);
  }
  const StopSignals signals;
  SweepProgress progress(missing.size());
  std::size_t given = 0, finished = 0;
  bench::RunInProcesses(
      {.num_jobs = options.jobs},
      [&]() -> std::optional<std::uint64_t> {
        if (signals.count() > 0 || given == missing.size()) return {};
        return missing[given++];
      },
      [&](std::uint64_t index) { return bench::RowText(RunOne(index)); },
      [&](std::uint64_t index, const bench::ProcessAnswer& answer) {
        if (answer.was_killed) {  // that says nothing of the run
          PrintError("run {}: {}\n", index + 1, answer.why_failed);
          return;
        }
        const bool has_crashed = !answer.why_failed.empty();
        const std::string row =
            has_crashed ? bench::RowText(bench::FailedRow({}, answer.why_failed)) : answer.text;
        shard.Append(plan_.KeyOf(index), row);
        ++finished;
        progress.Count(row.rfind("{\"o\":\"failed\"", 0) == 0);
      },
      [&] { shard.Leave(); });
  shard.Sync();
  if (finished == missing.size()) return true;
  PrintError("{}: {} of {} runs are finished, and the same command goes on\n",
             signals.count() > 0
                 ? "stopped by " + signals.first()
                 : std::string("killed again and again, perhaps for want of memory"),
             count - missing.size() + finished, count);
  return false;
}

bench::SweepRows SweepRunner::Rows() const { return {plan_, shards(), Maker()}; }

void SweepRunner::Merge(const bench::SweepRows& rows) const {
  const bench::ShardMaker maker = Maker();
  const auto trace = [&](std::uint64_t key) {
    std::error_code error;
    std::string path = TraceOf(key);
    return fs::exists(out_ + "/" + path, error) ? path : std::string();
  };
  bench::MergeRows(plan_, rows,
                   {.path = database(),
                    .facts = {{"build_id", maker.build}, {"inputs", maker.inputs}},
                    .version = VersionNumber(),
                    .command = [&](const bench::PlannedRun& run) { return CommandOf(run); },
                    .trace = trace,
                    .scenario = [&](const bench::PlannedRun& run) { return ScenarioOf(run); }});
}

}  // namespace sidestep::cli
