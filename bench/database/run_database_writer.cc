#include "sidestep/bench/database/run_database_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <system_error>

#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/outcome.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/parse_number.h"

namespace sidestep::bench {
namespace {

// The value of an outcome in `runs.outcome`; `enums` has its word.
int OutcomeNumber(const std::string& word) {
  const std::optional<Outcome> outcome = OutcomeFromString(word);
  return outcome ? static_cast<int>(*outcome) : static_cast<int>(std::size(kAllOutcomes));
}

std::vector<std::string> OutcomeWords() {
  std::vector<std::string> words;
  for (const Outcome outcome : kAllOutcomes) words.push_back(ToString(outcome));
  words.emplace_back(kFailed);
  return words;
}

bool IsNumber(const std::string& text) { return NumberIn<double>(text).has_value(); }

// A name as SQL and Planner Arena take it without quotes.
std::string ColumnText(const std::string& name) {
  std::string text;
  for (const char c : name) text += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return text;
}

// Whether a factor says how the robot plans, rather than what stands before it.
bool IsOfPlanner(const std::string& factor) {
  const std::string first = factor.substr(0, factor.find_first_of(".[/"));
  static const std::set<std::string> kPlanning = {
      "planner",  "knowledge", "predictor", "prediction",   "replanning",
      "tracking", "safety",    "search",    "static_world", "growth"};
  return kPlanning.contains(first);
}

std::string SqlType(const FactorColumn& factor) { return factor.is_number ? "REAL" : "TEXT"; }

// What makes a list of columns of a CREATE TABLE.
std::string ColumnsSql(const std::vector<FactorColumn>& factors, bool of_planner) {
  std::string text;
  for (const FactorColumn& factor : factors) {
    if (factor.is_planner == of_planner) {
      text += ", " + SqlName(factor.column) + " " + SqlType(factor);
    }
  }
  return text;
}

std::string Questions(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += i == 0 ? "?" : ", ?";
  return text;
}

std::string SchemaSql(const RunTableHead& head) {
  std::string metrics, metric_names, drawn, drawn_names;
  for (const Metric& metric : Metrics()) {
    const bool is_count = std::string(metric.unit) == "count";
    metrics += ", " + SqlName(metric.name) + (is_count ? " INTEGER" : " REAL");
    metric_names += ", r." + SqlName(metric.name);
  }
  for (const std::string& key : head.drawn) {
    drawn += ", " + SqlName(DrawnColumn(key)) + " REAL";
    drawn_names += ", r." + SqlName(DrawnColumn(key));
  }
  std::string factor_names;
  for (const FactorColumn& factor : head.factors) {
    factor_names += std::string(factor.is_planner ? ", c." : ", e.") + SqlName(factor.column);
  }
  const auto is_factor = [&](const std::string& column) {
    return std::any_of(head.factors.begin(), head.factors.end(),
                       [&](const FactorColumn& factor) { return factor.column == column; });
  };
  std::string words;
  for (const char* const word : {"planner", "knowledge", "predictor"}) {
    if (!is_factor(word)) words += std::string(", c.") + word;
  }
  if (!is_factor("robot")) words += ", e.robot";
  std::string outcome = "CASE r.outcome";
  int number = 0;
  for (const std::string& word : OutcomeWords()) {
    outcome += " WHEN " + std::to_string(number++) + " THEN '" + word + "'";
  }
  outcome += " END";
  return "CREATE TABLE sidestep(name TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;"
         "CREATE TABLE factors(position INTEGER PRIMARY KEY, name TEXT, \"column\" TEXT, kind TEXT,"
         " type TEXT);"
         "CREATE TABLE factor_values(factor INTEGER REFERENCES factors, position INTEGER,"
         " value TEXT, PRIMARY KEY(factor, position)) WITHOUT ROWID;"
         "CREATE TABLE experiments(id INTEGER PRIMARY KEY, name VARCHAR(512), totaltime REAL,"
         " timelimit REAL, memorylimit REAL, runcount INTEGER, version VARCHAR(128),"
         " hostname VARCHAR(1024), cpuinfo TEXT, date DATETIME, seed INTEGER, setup TEXT" +
         std::string(is_factor("robot") ? "" : ", robot TEXT") + ColumnsSql(head.factors, false) +
         ");"
         "CREATE TABLE plannerConfigs(id INTEGER PRIMARY KEY, name VARCHAR(512) NOT NULL,"
         " settings TEXT" +
         std::string(is_factor("planner") ? "" : ", planner TEXT") +
         (is_factor("knowledge") ? "" : ", knowledge TEXT") +
         (is_factor("predictor") ? "" : ", predictor TEXT") + ColumnsSql(head.factors, true) +
         ");"
         "CREATE TABLE enums(name VARCHAR(512), value INTEGER, description TEXT,"
         " PRIMARY KEY(name, value));"
         "CREATE TABLE runs(id INTEGER PRIMARY KEY, experimentid INTEGER REFERENCES experiments,"
         " plannerid INTEGER REFERENCES plannerConfigs, seed INTEGER, outcome INTEGER,"
         " solved BOOLEAN, time REAL, charged_latency_s REAL" +
         metrics + drawn +
         ");"
         "CREATE TABLE progress(runid INTEGER REFERENCES runs, time REAL, clearance_m REAL,"
         " PRIMARY KEY(runid, time));"
         "CREATE TABLE combinations(experimentid INTEGER, plannerid INTEGER, models TEXT,"
         " command TEXT, PRIMARY KEY(experimentid, plannerid)) WITHOUT ROWID;"
         "CREATE TABLE run_facts(runid INTEGER PRIMARY KEY REFERENCES runs, key TEXT, run TEXT,"
         " scenario_fingerprint TEXT, touched TEXT, error TEXT, trace TEXT);"
         "CREATE TABLE wall_clock(runid INTEGER PRIMARY KEY REFERENCES runs, machine INTEGER,"
         " episode_s REAL, cycle_p50_ms REAL, cycle_p95_ms REAL, cycle_p99_ms REAL,"
         " cycle_max_ms REAL, cycles_over_charge INTEGER, late_plans INTEGER);"
         "CREATE TABLE wall_clock_machines(machine INTEGER, name TEXT, value TEXT,"
         " PRIMARY KEY(machine, name)) WITHOUT ROWID;"
         "CREATE VIEW results AS SELECT r.id AS id, e.name AS scenario" +
         words + factor_names + ", r.seed AS seed, " + outcome +
         " AS outcome, f.touched AS touched, f.error AS error,"
         " r.charged_latency_s AS charged_latency_s" +
         metric_names + drawn_names +
         ", f.key AS \"key\", f.run AS run, f.scenario_fingerprint AS scenario_fingerprint,"
         " o.models AS models, f.trace AS trace,"
         " CASE WHEN o.command IS NULL OR f.run IS NULL THEN NULL ELSE o.command || ' --seed ' ||"
         " r.seed || ' --out out/again/' || f.run END AS command, r.experimentid AS experimentid,"
         " r.plannerid AS plannerid"
         " FROM runs r JOIN experiments e ON e.id = r.experimentid"
         " JOIN plannerConfigs c ON c.id = r.plannerid"
         " JOIN combinations o ON o.experimentid = r.experimentid AND o.plannerid = r.plannerid"
         " JOIN run_facts f ON f.runid = r.id;";
}

void BindText(SqlStatement& statement, int parameter, const std::string& text) {
  if (text.empty()) {
    statement.BindNull(parameter);
  } else {
    statement.Bind(parameter, text);
  }
}

double NumberOr(const std::map<std::string, double>& numbers, const std::string& name) {
  const auto found = numbers.find(name);
  return found == numbers.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

}  // namespace

std::string DrawnColumn(const std::string& key) { return "drawn_" + ColumnText(key); }

std::vector<FactorColumn> FactorColumnsOf(
    const std::vector<std::pair<std::string, std::vector<std::string>>>& factors) {
  const auto lower = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
  };
  // SQL does not tell capitals apart, and the view has columns of its own.
  std::set<std::string> taken = {
      "id",      "scenario", "seed",    "outcome",      "touched",   "error", "charged_latency_s",
      "key",     "run",      "models",  "trace",        "command",   "name",  "settings",
      "setup",   "version",  "date",    "experimentid", "plannerid", "time",  "solved",
      "cpuinfo", "hostname", "runcount"};
  for (const Metric& metric : Metrics()) taken.insert(metric.name);
  std::vector<FactorColumn> columns;
  for (const auto& [name, values] : factors) {
    FactorColumn& factor = columns.emplace_back();
    factor.name = name;
    factor.column = ColumnText(name);
    if (name == "robot.model") factor.column = "robot";
    if (name == "planner.name") factor.column = "planner";
    while (!taken.insert(lower(factor.column)).second) factor.column += "_";
    factor.is_planner = IsOfPlanner(name);
    factor.values = values;
    factor.is_number = !values.empty() && std::all_of(values.begin(), values.end(), &IsNumber);
  }
  return columns;
}

// The open file, its statements, and which experiments and configurations it has.
class RunDatabaseWriter::Tables {
 public:
  Tables(const std::string& file, const std::string& name, const RunTableHead& head)
      : head_(head), database_(SqlDatabase::Create(file, name)) {
    // What is not whole in the end goes, so nothing has to survive on the way.
    database_.Execute("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
    database_.Execute(SchemaSql(head));
    database_.Execute("BEGIN");
    WriteHead();
    int metrics = 0;
    for ([[maybe_unused]] const Metric& metric : Metrics()) ++metrics;
    const int drawn = static_cast<int>(head.drawn.size());
    run_.emplace(Insert("runs", 8 + metrics + drawn));
    facts_.emplace(Insert("run_facts", 7));
    clock_.emplace(Insert("wall_clock", 9));
  }

  void Add(const NumberedRun& run, const RunRow& row) {
    const Place place = PlaceOf(run, row);
    AddRun(run, row, place);
    SqlStatement& facts = *facts_;
    facts.Reset();
    facts.Bind(1, run.id);
    BindText(facts, 2, run.key);
    const bool was_resolved = !row.identity.build.empty();
    BindText(facts, 3, was_resolved ? RunId(row.identity) : "");
    BindText(facts, 4, row.identity.scenario);
    BindText(facts, 5, row.touched);
    BindText(facts, 6, row.error);
    BindText(facts, 7, row.trace);
    facts.Step();
    SqlStatement& clock = *clock_;
    clock.Reset();
    clock.Bind(1, run.id);
    clock.Bind(2, static_cast<std::int64_t>(run.machine));
    int parameter = 3;
    for (const double number : {row.clock.episode_s, row.clock.cycle_p50_ms, row.clock.cycle_p95_ms,
                                row.clock.cycle_p99_ms, row.clock.cycle_max_ms}) {
      clock.Bind(parameter++, number);
    }
    clock.Bind(parameter++, static_cast<std::int64_t>(row.clock.cycles_over_charge));
    clock.Bind(parameter, static_cast<std::int64_t>(row.clock.late_plans));
    clock.Step();
  }

  void Finish() {
    database_.Execute(
        "UPDATE experiments SET runcount = (SELECT max(n) FROM (SELECT count(*) AS n FROM runs"
        " WHERE experimentid = experiments.id GROUP BY plannerid))");
    database_.Execute("COMMIT");
    run_.reset();
    facts_.reset();
    clock_.reset();
  }

 private:
  struct Place {
    std::int64_t experiment = 0, planner = 0;
  };

  SqlStatement Insert(const std::string& table, int num_columns) const {
    return database_.Prepare("INSERT INTO " + table + " VALUES(" + Questions(num_columns) + ")");
  }

  void WriteHead() const {
    SqlStatement fact = Insert("sidestep", 2);
    std::map<std::string, std::string> facts = head_.facts;
    facts["format"] = kDatabaseFormat;
    for (const auto& [name, value] : facts) {
      fact.Reset();
      fact.Bind(1, name);
      fact.Bind(2, value);
      fact.Step();
    }
    SqlStatement factor = Insert("factors", 5), value_of = Insert("factor_values", 3);
    for (std::size_t i = 0; i < head_.factors.size(); ++i) {
      factor.Reset();
      factor.Bind(1, static_cast<std::int64_t>(i + 1));
      factor.Bind(2, head_.factors[i].name);
      factor.Bind(3, head_.factors[i].column);
      factor.Bind(4, head_.factors[i].is_planner ? "planner" : "problem");
      factor.Bind(5, head_.factors[i].is_number ? "number" : "text");
      factor.Step();
      std::int64_t position = 0;
      for (const std::string& level : head_.factors[i].values) {
        value_of.Reset();
        value_of.Bind(1, static_cast<std::int64_t>(i + 1));
        value_of.Bind(2, ++position);
        value_of.Bind(3, level);
        value_of.Step();
      }
    }
    SqlStatement word = Insert("enums", 3);
    int value = 0;
    for (const std::string& outcome : OutcomeWords()) {
      word.Reset();
      word.Bind(1, "outcome");
      word.Bind(2, static_cast<std::int64_t>(value++));
      word.Bind(3, outcome);
      word.Step();
    }
    SqlStatement fact_of_machine = Insert("wall_clock_machines", 3);
    for (std::size_t m = 0; m < head_.machines.size(); ++m) {
      for (const auto& [name, text] : head_.machines[m]) {
        fact_of_machine.Reset();
        fact_of_machine.Bind(1, static_cast<std::int64_t>(m));
        fact_of_machine.Bind(2, name);
        fact_of_machine.Bind(3, text);
        fact_of_machine.Step();
      }
    }
  }

  // Their values of one kind, in the order of the columns.
  std::vector<std::string> Values(const RunRow& row, bool of_planner) const {
    std::vector<std::string> values;
    for (const FactorColumn& factor : head_.factors) {
      if (factor.is_planner != of_planner) continue;
      const auto found = row.factors.find(factor.name);
      values.push_back(found == row.factors.end() ? "" : found->second);
    }
    return values;
  }

  bool HasFactor(const std::string& column) const {
    return std::any_of(head_.factors.begin(), head_.factors.end(),
                       [&](const FactorColumn& factor) { return factor.column == column; });
  }

  // The experiment and the configuration of a run, made where they are new.
  Place PlaceOf(const NumberedRun& run, const RunRow& row) {
    const RunSubject& subject = row.subject;
    std::vector<std::string> experiment = Values(row, false);
    experiment.insert(experiment.begin(), {run.scenario, subject.robot});
    std::vector<std::string> planner = Values(row, true);
    planner.insert(planner.begin(), {subject.planner, subject.knowledge, subject.predictor});
    const auto [e, is_new_experiment] =
        experiments_.emplace(experiment, static_cast<std::int64_t>(experiments_.size() + 1));
    const auto [p, is_new_planner] =
        planners_.emplace(planner, static_cast<std::int64_t>(planners_.size() + 1));
    const Place place{e->second, p->second};
    if (is_new_experiment) AddExperiment(place.experiment, run, row);
    if (is_new_planner) AddPlanner(place.planner, row);
    if (combinations_.emplace(place.experiment, place.planner).second) {
      SqlStatement combination = Insert("combinations", 4);
      combination.Bind(1, place.experiment);
      combination.Bind(2, place.planner);
      BindText(combination, 3, row.identity.models);
      BindText(combination, 4, run.combination_command);
      combination.Step();
    }
    return place;
  }

  void BindFactors(SqlStatement& statement, int parameter, const RunRow& row, bool of_planner) {
    for (const std::string& value : Values(row, of_planner)) {
      BindText(statement, parameter++, value);  // the column's type makes a number of it
    }
  }

  void AddExperiment(std::int64_t id, const NumberedRun& run, const RunRow& row) {
    const bool has_robot = HasFactor("robot");
    const int num_factors = static_cast<int>(Values(row, false).size());
    SqlStatement experiment = Insert("experiments", 12 + (has_robot ? 0 : 1) + num_factors);
    experiment.Bind(1, id);
    experiment.Bind(2, run.scenario);
    experiment.Bind(3, 0.0);
    experiment.Bind(4, 0.0);
    experiment.Bind(5, 0.0);
    experiment.Bind(7, head_.version);
    experiment.Bind(8, std::string());
    experiment.Bind(9, std::string());
    experiment.Bind(10, std::string());
    experiment.Bind(11, std::int64_t{0});
    experiment.Bind(12, run.setup);
    if (!has_robot) BindText(experiment, 13, row.subject.robot);
    BindFactors(experiment, has_robot ? 13 : 14, row, false);
    experiment.Step();
  }

  void AddPlanner(std::int64_t id, const RunRow& row) {
    const RunSubject& subject = row.subject;
    std::vector<std::string> name, settings;
    for (const std::string& word : {subject.planner, subject.knowledge}) {
      if (!word.empty()) name.push_back(word);
    }
    int num_factors = 0;
    for (const FactorColumn& factor : head_.factors) {
      if (!factor.is_planner) continue;
      ++num_factors;
      const auto found = row.factors.find(factor.name);
      if (found == row.factors.end()) continue;
      settings.push_back(factor.name + "=" + found->second);
      const bool is_told = factor.column == "planner" || factor.column == "knowledge";
      if (!is_told || subject.planner.empty() || found->second != WordOf(factor, subject)) {
        name.push_back(factor.column == "predictor" ? found->second : settings.back());
      }
    }
    SqlStatement planner = Insert(
        "plannerConfigs", 3 + num_factors + (HasFactor("planner") ? 0 : 1) +
                              (HasFactor("knowledge") ? 0 : 1) + (HasFactor("predictor") ? 0 : 1));
    planner.Bind(1, id);
    planner.Bind(2, name.empty() ? "refused" : Joined(name, " "));
    planner.Bind(3, Joined(settings, "\n"));
    int parameter = 4;
    if (!HasFactor("planner")) BindText(planner, parameter++, subject.planner);
    if (!HasFactor("knowledge")) BindText(planner, parameter++, subject.knowledge);
    if (!HasFactor("predictor")) BindText(planner, parameter++, subject.predictor);
    BindFactors(planner, parameter, row, true);
    planner.Step();
  }

  static std::string WordOf(const FactorColumn& factor, const RunSubject& subject) {
    return factor.column == "planner" ? subject.planner : subject.knowledge;
  }

  void AddRun(const NumberedRun& run, const RunRow& row, const Place& place) {
    SqlStatement& statement = *run_;
    statement.Reset();
    statement.Bind(1, run.id);
    statement.Bind(2, place.experiment);
    statement.Bind(3, place.planner);
    statement.Bind(4, static_cast<std::int64_t>(run.seed));
    statement.Bind(5, static_cast<std::int64_t>(OutcomeNumber(row.outcome)));
    statement.Bind(6, std::int64_t{row.outcome == ToString(Outcome::kGoal) ? 1 : 0});
    statement.Bind(7, NumberOr(row.metrics, "time_to_goal_s"));
    statement.Bind(8, row.subject.charged_latency_s);
    int parameter = 9;
    for (const Metric& metric : Metrics()) {
      statement.Bind(parameter++, NumberOr(row.metrics, metric.name));
    }
    for (const std::string& key : head_.drawn) {
      statement.Bind(parameter++, NumberOr(row.drawn, key));
    }
    statement.Step();
  }

  const RunTableHead& head_;
  SqlDatabase database_;
  std::optional<SqlStatement> run_, facts_, clock_;
  std::map<std::vector<std::string>, std::int64_t> experiments_, planners_;
  std::set<std::pair<std::int64_t, std::int64_t>> combinations_;
};

RunDatabaseWriter::RunDatabaseWriter(const std::string& path, const RunTableHead& head)
    : path_(path), head_(head) {
  CheckCanWrite(path);
  const std::filesystem::path target(path);
  // SQLite opens names itself; it is made under another one, as AtomicFile makes what it writes.
  temporary_ = (target.parent_path() / (".sidestep-" + std::to_string(getpid()) + "-" +
                                        target.filename().string() + ".part"))
                   .string();
  tables_ = std::make_unique<Tables>(temporary_, path_, head_);
}

RunDatabaseWriter::~RunDatabaseWriter() {
  tables_.reset();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void RunDatabaseWriter::Add(const NumberedRun& run, const RunRow& row) { tables_->Add(run, row); }

void RunDatabaseWriter::Commit() {
  tables_->Finish();
  tables_.reset();
  const auto fail = [&] {
    throw InputError(path_, std::string("cannot be written: ") + std::strerror(errno));
  };
  const int file = open(temporary_.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) fail();
  const bool is_on_disk = fsync(file) == 0 || errno == EINVAL;
  if (close(file) != 0 || !is_on_disk) fail();
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
}

}  // namespace sidestep::bench
