#include "sidestep/bench/sweep/merge.h"

#include <utility>
#include <vector>

#include "sidestep/bench/database/run_database_writer.h"
#include "sidestep/core/joined.h"

namespace sidestep::bench {
namespace {

RunTableHead HeadOf(const SweepPlan& plan, const SweepRows& rows, const MergeOptions& options) {
  const Sweep& sweep = plan.sweep();
  RunTableHead head;
  head.facts = options.facts;
  head.facts["title"] = sweep.name;
  head.facts["description"] = sweep.description;
  head.facts["plan"] = plan.Hash();
  head.facts["num_planned"] = std::to_string(plan.num_runs());
  head.facts["num_done"] = std::to_string(rows.num_done());
  head.facts["scenarios"] = Joined(sweep.scenarios);
  if (sweep.search > 0) head.facts["search"] = std::to_string(sweep.search);
  for (const auto& [key, value] : sweep.settings) head.facts["set." + key] = value;
  if (!sweep.question.factor.empty()) {
    head.facts["compare.factor"] = sweep.question.factor;
    head.facts["compare.of"] = sweep.question.of;
    head.facts["compare.with"] = sweep.question.with;
  }
  head.version = options.version;
  std::vector<std::pair<std::string, std::vector<std::string>>> factors;
  for (const SweepAxis& axis : sweep.axes) factors.emplace_back(axis.name, axis.values);
  head.factors = FactorColumnsOf(factors);
  head.drawn = rows.Drawn();
  head.machines = rows.machines();
  return head;
}

}  // namespace

void MergeRows(const SweepPlan& plan, const SweepRows& rows, const MergeOptions& options) {
  RunDatabaseWriter writer(options.path, HeadOf(plan, rows, options));
  std::string of_combination;
  std::uint64_t combination = plan.num_combinations();  // none
  for (std::uint64_t index = 0; index < plan.num_runs(); ++index) {
    if (!rows.Has(index)) continue;
    PlannedRun planned = plan.At(index);
    if (planned.combination != combination) {
      combination = planned.combination;
      of_combination = options.command(planned);
    }
    SweepRows::Found found = rows.Read(index);
    found.row.factors = std::move(planned.factors);
    const std::uint64_t key = plan.KeyOf(index);
    found.row.trace = options.trace(key);
    writer.Add({.id = static_cast<std::int64_t>(index + 1),
                .key = KeyText(key),
                .scenario = planned.scenario,
                .setup = options.scenario(planned),
                .seed = planned.seed,
                .machine = found.machine,
                .combination_command = of_combination},
               found.row);
  }
  writer.Commit();
}

}  // namespace sidestep::bench
