#include "sidestep/record/recording_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "sidestep/record/hdf5_image.h"
#include "sidestep/record/sealed_file.h"

namespace sidestep::record {
namespace {

const SealedFormat kTraceFormat = {"sidestep trace", kTraceVersion};

using Doubles = Hdf5Array<double>;
using Integers = Hdf5Array<std::int64_t>;
using Strings = Hdf5Array<std::string>;
constexpr hsize_t kAny = Hdf5ImageReader::kAny;
constexpr double kLatest_s = 3600;

void RequireOfRecording(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("Recording: " + what);
}

template <typename Samples>
std::vector<double> Times(const Samples& samples) {
  std::vector<double> times;
  for (const auto& sample : samples) times.push_back(sample.t.seconds());
  return times;
}

bool Increase(const std::vector<double>& times) {
  return std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
}

struct LimitColumn {
  const char* name;
  Eigen::VectorXd MotionLimits::*member;
  const char* unit;
};
constexpr LimitColumn kLimitColumns[] = {
    {"v_max", &MotionLimits::v_max, "rad/s"},
    {"a_max", &MotionLimits::a_max, "rad/s^2"},
    {"jerk_max", &MotionLimits::jerk_max, "rad/s^3"},
    {"torque_rate_max", &MotionLimits::torque_rate_max, "N m/s"},
};
struct LimitGroup {
  const char* name;
  MotionLimits Recording::*member;
};
constexpr LimitGroup kLimitGroups[] = {{"robot_limits", &Recording::robot_limits},
                                       {"limits", &Recording::limits}};

// One after the other, by their paths.
template <typename Limits, typename Do>
void ForEachLimit(Limits& recording, const Do& act) {
  for (const LimitGroup& group : kLimitGroups) {
    for (const LimitColumn& column : kLimitColumns) {
      act(std::string(group.name) + "/" + column.name, recording.*group.member.*column.member,
          column.unit);
    }
  }
}

Eigen::VectorXd ScaleOf(const Recording& recording) {
  const auto n = static_cast<Eigen::Index>(recording.joints.size());
  return recording.tolerance_scale.size() > 0 ? recording.tolerance_scale
                                              : Eigen::VectorXd::Ones(n);
}

void CheckRecording(const Recording& recording) {
  const auto n = static_cast<Eigen::Index>(recording.joints.size());
  RequireOfRecording(recording.q_start.size() == n, "q_start needs one number a joint");
  RequireOfRecording(recording.q_goal.size() == n, "q_goal needs one number a joint");
  RequireOfRecording(ScaleOf(recording).size() == n,
                     "tolerance_scale needs one number a joint, or none");
  ForEachLimit(recording, [&](const std::string& path, const Eigen::VectorXd& limit, const char*) {
    RequireOfRecording(limit.size() == n, path + " needs one number a joint");
  });
  RequireOfRecording(
      recording.p_WTool.empty() || recording.p_WTool.size() == recording.control.size(),
      "the tool needs one position a control sample, or none");
  RequireOfRecording(Increase(Times(recording.control)), "the times of control must increase");
  RequireOfRecording(Increase(Times(recording.truth)), "the times of truth must increase");
  RequireOfRecording(Increase(Times(recording.observations)),
                     "the times of observations must increase");
  for (const ControlSample& sample : recording.control) {
    for (const Eigen::VectorXd* column : {&sample.q_command, &sample.v_command, &sample.a_command,
                                          &sample.q, &sample.v, &sample.torque}) {
      RequireOfRecording(column->size() == n, "a control sample needs one number a joint");
    }
  }
  for (const TruthSample& sample : recording.truth) {
    RequireOfRecording(sample.X_WO.size() == recording.obstacles.size(),
                       "truth needs one pose an obstacle");
  }
  for (const CycleRecord& cycle : recording.cycles) {
    if (cycle.plan.num_states() > 0) {
      CheckTrajectory(cycle.plan);
      RequireOfRecording(cycle.plan.num_joints() == n, "a plan needs one number a joint");
    }
    for (const PredictedObject& object : cycle.objects) {
      RequireOfRecording(object.t.size() == object.X_WO.size(),
                         "a predicted object needs one pose a time");
    }
  }
}

// ---- columns: one array from one member of every row, and back

template <typename Rows, typename Get>
Doubles Column(const Rows& rows, Get get) {
  Doubles column{{rows.size()}, {}};
  for (const auto& row : rows) column.values.push_back(get(row));
  return column;
}

template <typename Rows, typename Get>
Integers IntegerColumn(const Rows& rows, Get get) {
  Integers column{{rows.size()}, {}};
  for (const auto& row : rows) column.values.push_back(get(row));
  return column;
}

template <typename Rows, typename Get>
Strings StringColumn(const Rows& rows, Get get) {
  Strings column{{rows.size()}, {}};
  for (const auto& row : rows) column.values.push_back(get(row));
  return column;
}

template <typename Rows, typename Get>
Doubles VectorColumn(const Rows& rows, Eigen::Index width, Get get) {
  Doubles column{{rows.size(), static_cast<hsize_t>(width)}, {}};
  for (const auto& row : rows) {
    const auto& vector = get(row);
    column.values.insert(column.values.end(), vector.data(), vector.data() + vector.size());
  }
  return column;
}

Eigen::VectorXd VectorAt(const Doubles& column, std::size_t row) {
  const auto width = static_cast<Eigen::Index>(column.shape[1]);
  return Eigen::Map<const Eigen::VectorXd>(
      column.values.data() + row * static_cast<std::size_t>(width), width);
}

// Poses as two arrays: positions (x, y, z) and quaternions (w, x, y, z).
struct PoseArrays {
  std::vector<double> positions;
  std::vector<double> quaternions;

  void Append(const Pose& X) {
    const Eigen::Vector3d& p = X.translation();
    const Eigen::Quaterniond& R = X.rotation();
    positions.insert(positions.end(), {p.x(), p.y(), p.z()});
    quaternions.insert(quaternions.end(), {R.w(), R.x(), R.y(), R.z()});
  }
};

// Where row i's part begins in an array that holds every row's part one after another; one more
// entry than rows.
template <typename Rows, typename Count>
Integers Offsets(const Rows& rows, Count count) {
  Integers offsets{{rows.size() + 1}, {0}};
  for (const auto& row : rows) {
    offsets.values.push_back(offsets.values.back() + static_cast<std::int64_t>(count(row)));
  }
  return offsets;
}

// ---- writing

void WriteHeaderAndMetrics(Hdf5ImageWriter& file, const Recording& recording) {
  file.MakeGroup("header");
  file.Write("header/key",
             StringColumn(recording.header, [](const auto& entry) { return entry.first; }));
  file.Write("header/value",
             StringColumn(recording.header, [](const auto& entry) { return entry.second; }));
  file.MakeGroup("metrics");
  file.Write("metrics/name",
             StringColumn(recording.metrics, [](const auto& entry) { return entry.first; }));
  file.Write("metrics/value",
             Column(recording.metrics, [](const auto& entry) { return entry.second; }));
}

void WriteProblem(Hdf5ImageWriter& file, const Recording& recording) {
  const auto identity = [](const std::string& text) { return text; };
  file.Write("scenario_yaml", Strings{{}, {recording.scenario_yaml}});
  file.Write("model_xml", Strings{{}, {recording.model_xml}});
  file.Write("joints", StringColumn(recording.joints, identity));
  file.Write("obstacles", StringColumn(recording.obstacles, identity));
  const auto write_joints = [&](const std::string& path, const Eigen::VectorXd& values,
                                const std::string& unit) {
    file.Write(path, {{recording.joints.size()}, {values.data(), values.data() + values.size()}},
               unit);
  };
  write_joints("q_start", recording.q_start, "rad");
  write_joints("q_goal", recording.q_goal, "rad");
  file.Write("dwell", Doubles{{}, {recording.dwell_s}}, "s");
  write_joints("tolerance_scale", ScaleOf(recording), "");
  for (const LimitGroup& group : kLimitGroups) file.MakeGroup(group.name);
  ForEachLimit(recording, write_joints);
  file.MakeGroup("tool");
  file.Write("tool/a_max", Doubles{{}, {recording.tool_a_max}}, "m/s^2");
  file.Write("tool/a_reflex", Doubles{{}, {recording.tool_a_reflex}}, "m/s^2");
}

struct ControlColumn {
  const char* name;
  Eigen::VectorXd ControlSample::*member;
  const char* unit;
};
constexpr ControlColumn kControlColumns[] = {
    {"q_command", &ControlSample::q_command, "rad"},
    {"v_command", &ControlSample::v_command, "rad/s"},
    {"a_command", &ControlSample::a_command, "rad/s^2"},
    {"q", &ControlSample::q, "rad"},
    {"v", &ControlSample::v, "rad/s"},
    {"torque", &ControlSample::torque, "N m"},
};

void WriteControl(Hdf5ImageWriter& file, const Recording& recording) {
  const auto n = static_cast<Eigen::Index>(recording.joints.size());
  file.MakeGroup("control");
  file.Write("control/t",
             Column(recording.control, [](const auto& sample) { return sample.t.seconds(); }), "s");
  for (const ControlColumn& column : kControlColumns) {
    file.Write(std::string("control/") + column.name,
               VectorColumn(
                   recording.control,
                   n, [&](const auto& sample) -> const auto& { return sample.*column.member; }),
               column.unit);
  }
  const auto identity = [](const Eigen::Vector3d& p) -> const Eigen::Vector3d& { return p; };
  file.Write("tool/position", VectorColumn(recording.p_WTool, 3, identity), "m");
}

void WriteTruth(Hdf5ImageWriter& file, const Recording& recording) {
  const std::vector<TruthSample>& truth = recording.truth;
  file.MakeGroup("truth");
  file.Write("truth/t", Column(truth, [](const auto& s) { return s.t.seconds(); }), "s");
  file.Write("truth/clearance", Column(truth, [](const auto& s) { return s.clearance_m; }), "m");
  file.Write("truth/nearest_robot_part",
             StringColumn(truth, [](const auto& s) { return s.nearest_robot_part; }));
  file.Write("truth/nearest_object",
             StringColumn(truth, [](const auto& s) { return s.nearest_object; }));
  file.Write("truth/in_contact", IntegerColumn(truth, [](const auto& s) { return s.in_contact; }));
  file.Write("truth/contact_time", Column(truth, [](const auto& s) { return s.contact_s; }), "s");
  file.Write("truth/contact_object",
             StringColumn(truth, [](const auto& s) { return s.contact_object; }));
  file.Write("truth/contact_point",
             VectorColumn(
                 truth, 3, [](const auto& s) -> const auto& { return s.p_WContact; }),
             "m");
  PoseArrays poses;
  for (const TruthSample& sample : truth) {
    for (const Pose& X_WO : sample.X_WO) poses.Append(X_WO);
  }
  const std::size_t num_obstacles = recording.obstacles.size();
  file.Write("truth/obstacle_position", {{truth.size(), num_obstacles, 3}, poses.positions}, "m");
  file.Write("truth/obstacle_quaternion", {{truth.size(), num_obstacles, 4}, poses.quaternions});
}

void WriteCycles(Hdf5ImageWriter& file, const Recording& recording) {
  const std::vector<CycleRecord>& cycles = recording.cycles;
  file.MakeGroup("cycles");
  file.Write("cycles/t", Column(cycles, [](const auto& c) { return c.t.seconds(); }), "s");
  file.Write("cycles/t_effect", Column(cycles, [](const auto& c) { return c.t_effect.seconds(); }),
             "s");
  file.Write("cycles/status", StringColumn(cycles, [](const auto& c) { return c.status; }));
  file.Write("cycles/reason", StringColumn(cycles, [](const auto& c) { return c.reason; }));
  file.Write("cycles/accepted", IntegerColumn(cycles, [](const auto& c) { return c.accepted; }));
  file.Write("cycles/iterations",
             IntegerColumn(cycles, [](const auto& c) { return c.iterations; }));
  file.Write("cycles/cut_short", IntegerColumn(cycles, [](const auto& c) { return c.cut_short; }));
  file.Write("cycles/cost", Column(cycles, [](const auto& c) { return c.cost; }));
  file.Write("cycles/predicted_clearance",
             Column(cycles, [](const auto& c) { return c.predicted_clearance_m; }), "m");
  file.Write("cycles/samples_outside_grid",
             IntegerColumn(cycles, [](const auto& c) { return c.samples_outside_grid; }));
  file.Write("cycles/plan_start",
             Column(cycles, [](const auto& c) { return c.plan_start.seconds(); }), "s");

  const hsize_t n = recording.joints.size();
  Doubles t, q{{0, n}, {}}, v{{0, n}, {}};
  for (const CycleRecord& cycle : cycles) {
    const Trajectory& plan = cycle.plan;
    t.values.insert(t.values.end(), plan.t_s.data(), plan.t_s.data() + plan.t_s.size());
    q.values.insert(q.values.end(), plan.q.data(), plan.q.data() + plan.q.size());
    v.values.insert(v.values.end(), plan.v.data(), plan.v.data() + plan.v.size());
  }
  t.shape = {t.values.size()};
  q.shape[0] = v.shape[0] = t.values.size();
  file.MakeGroup("plans");
  file.Write("plans/offset", Offsets(cycles, [](const auto& c) { return c.plan.num_states(); }));
  file.Write("plans/t", t, "s");
  file.Write("plans/q", q, "rad");
  file.Write("plans/v", v, "rad/s");

  std::vector<PredictedObject> objects;
  for (const CycleRecord& cycle : cycles) {
    objects.insert(objects.end(), cycle.objects.begin(), cycle.objects.end());
  }
  Doubles pose_t;
  PoseArrays poses;
  for (const PredictedObject& object : objects) {
    for (const EpisodeTime& time : object.t) pose_t.values.push_back(time.seconds());
    for (const Pose& X_WO : object.X_WO) poses.Append(X_WO);
  }
  const std::size_t num_poses = pose_t.values.size();
  pose_t.shape = {num_poses};
  file.MakeGroup("predictions");
  file.Write("predictions/offset", Offsets(cycles, [](const auto& c) { return c.objects.size(); }));
  file.Write("predictions/id", IntegerColumn(objects, [](const auto& o) { return o.id; }));
  file.Write("predictions/half_extents",
             VectorColumn(
                 objects, 3, [](const auto& o) -> const auto& { return o.half_extents_m; }),
             "m");
  file.MakeGroup("predictions/poses");
  file.Write("predictions/poses/offset",
             Offsets(objects, [](const auto& o) { return o.X_WO.size(); }));
  file.Write("predictions/poses/t", pose_t, "s");
  file.Write("predictions/poses/position", {{num_poses, 3}, poses.positions}, "m");
  file.Write("predictions/poses/quaternion", {{num_poses, 4}, poses.quaternions});
}

void WriteEvents(Hdf5ImageWriter& file, const Recording& recording) {
  const std::vector<TrackEvent>& events = recording.events;
  file.MakeGroup("events");
  file.Write("events/t", Column(events, [](const auto& e) { return e.t.seconds(); }), "s");
  file.Write("events/what", StringColumn(events, [](const auto& e) { return e.what; }));
  file.Write("events/id", IntegerColumn(events, [](const auto& e) { return e.id; }));
  file.Write("events/other_id", IntegerColumn(events, [](const auto& e) { return e.other_id; }));
  file.Write("events/position",
             VectorColumn(
                 events, 3, [](const auto& e) -> const auto& { return e.p_W; }),
             "m");
}

void WriteSafety(Hdf5ImageWriter& file, const Recording& recording) {
  const std::vector<SafetyEvent>& safety = recording.safety;
  file.MakeGroup("safety");
  file.Write("safety/t", Column(safety, [](const auto& e) { return e.t.seconds(); }), "s");
  file.Write("safety/check", StringColumn(safety, [](const auto& e) { return e.check; }));
  file.Write("safety/reaction", StringColumn(safety, [](const auto& e) { return e.reaction; }));
  file.Write("safety/value", Column(safety, [](const auto& e) { return e.value; }));
  file.Write("safety/limit", Column(safety, [](const auto& e) { return e.limit; }));
}

void WriteObservations(Hdf5ImageWriter& file, const Recording& recording) {
  const std::vector<ObservationRecord>& observations = recording.observations;
  Integers cells;
  std::vector<SeenObject> objects;
  for (const ObservationRecord& observation : observations) {
    cells.values.insert(cells.values.end(), observation.changed_cells.begin(),
                        observation.changed_cells.end());
    objects.insert(objects.end(), observation.objects.begin(), observation.objects.end());
  }
  cells.shape = {cells.values.size()};
  PoseArrays poses;
  for (const SeenObject& object : objects) poses.Append(object.X_WO);
  file.MakeGroup("observations");
  file.Write("observations/t", Column(observations, [](const auto& o) { return o.t.seconds(); }),
             "s");
  file.Write("observations/t_arrival",
             Column(observations, [](const auto& o) { return o.t_arrival.seconds(); }), "s");
  file.MakeGroup("observations/changed");
  file.Write("observations/changed/offset",
             Offsets(observations, [](const auto& o) { return o.changed_cells.size(); }));
  file.Write("observations/changed/cell", cells);
  file.MakeGroup("observations/objects");
  file.Write("observations/objects/offset",
             Offsets(observations, [](const auto& o) { return o.objects.size(); }));
  file.Write("observations/objects/id", StringColumn(objects, [](const auto& o) { return o.id; }));
  file.Write("observations/objects/position", {{objects.size(), 3}, poses.positions}, "m");
  file.Write("observations/objects/quaternion", {{objects.size(), 4}, poses.quaternions});
  file.Write("observations/objects/covariance",
             VectorColumn(
                 objects, 36, [](const auto& o) -> const auto& { return o.covariance; }));
}

// ---- reading

Doubles ReadTimes(const Hdf5ImageReader& file, const std::string& path, hsize_t size) {
  Doubles times = file.ReadDoubles(path, {size});
  for (std::size_t i = 0; i < times.values.size(); ++i) {
    // Whoever draws a trace looks at each hundredth of a second of it.
    if (!(times.values[i] >= 0 && times.values[i] <= kLatest_s)) {
      file.Fail(path, "holds a time that is not from 0 to 3600 s");
    }
  }
  return times;
}

Doubles ReadIncreasingTimes(const Hdf5ImageReader& file, const std::string& path) {
  Doubles times = ReadTimes(file, path, kAny);
  if (!Increase(times.values)) file.Fail(path, "does not increase");
  return times;
}

Integers ReadOffsets(const Hdf5ImageReader& file, const std::string& path, std::size_t num_rows,
                     std::size_t num_parts) {
  Integers offsets = file.ReadIntegers(path, {num_rows + 1});
  if (offsets.values.front() != 0 ||
      !std::is_sorted(offsets.values.begin(), offsets.values.end()) ||
      offsets.values.back() != static_cast<std::int64_t>(num_parts)) {
    file.Fail(path, "must rise from 0 to " + std::to_string(num_parts));
  }
  return offsets;
}

std::vector<Pose> ReadPoses(const Hdf5ImageReader& file, const std::string& positions_path,
                            const std::string& quaternions_path, std::vector<hsize_t> shape) {
  shape.push_back(3);
  const Doubles positions = file.ReadDoubles(positions_path, shape);
  shape.back() = 4;
  const Doubles quaternions = file.ReadDoubles(quaternions_path, shape);
  std::vector<Pose> poses;
  poses.reserve(positions.values.size() / 3);
  for (std::size_t i = 0; i < positions.values.size() / 3; ++i) {
    const double* const p = positions.values.data() + 3 * i;
    const double* const w = quaternions.values.data() + 4 * i;
    try {
      poses.emplace_back(Eigen::Quaterniond(w[0], w[1], w[2], w[3]),
                         Eigen::Vector3d(p[0], p[1], p[2]));
    } catch (const std::invalid_argument&) {
      file.Fail(quaternions_path, "row " + std::to_string(i) + " is not a finite pose");
    }
  }
  return poses;
}

void ReadProblem(const Hdf5ImageReader& file, Recording* recording) {
  const Strings keys = file.ReadStrings("header/key", {kAny});
  const Strings values = file.ReadStrings("header/value", {keys.shape});
  for (std::size_t i = 0; i < keys.values.size(); ++i) {
    recording->header[keys.values[i]] = values.values[i];
  }
  const Strings names = file.ReadStrings("metrics/name", {kAny});
  const Doubles metrics = file.ReadDoubles("metrics/value", {names.shape});
  for (std::size_t i = 0; i < names.values.size(); ++i) {
    recording->metrics[names.values[i]] = metrics.values[i];
  }
  recording->scenario_yaml = file.ReadStrings("scenario_yaml", {}).values.front();
  recording->model_xml = file.ReadStrings("model_xml", {}).values.front();
  recording->joints = file.ReadStrings("joints", {kAny}).values;
  recording->obstacles = file.ReadStrings("obstacles", {kAny}).values;
  const auto read_joints = [&](const std::string& path) -> Eigen::VectorXd {
    const Doubles q = file.ReadDoubles(path, {recording->joints.size()});
    return Eigen::Map<const Eigen::VectorXd>(q.values.data(),
                                             static_cast<Eigen::Index>(q.values.size()));
  };
  recording->q_start = read_joints("q_start");
  recording->q_goal = read_joints("q_goal");
  recording->dwell_s = file.ReadDoubles("dwell", {}).values.front();
  if (!(recording->dwell_s >= 0)) file.Fail("dwell", "must be >= 0");
  recording->tolerance_scale = read_joints("tolerance_scale");
  if (!(recording->tolerance_scale.array() > 0).all()) {
    file.Fail("tolerance_scale", "must be > 0");
  }
  ForEachLimit(*recording, [&](const std::string& path, Eigen::VectorXd& limit, const char*) {
    limit = read_joints(path);
  });
  recording->tool_a_max = file.ReadDoubles("tool/a_max", {}).values.front();
  recording->tool_a_reflex = file.ReadDoubles("tool/a_reflex", {}).values.front();
}

void ReadControl(const Hdf5ImageReader& file, Recording* recording) {
  const Doubles t = ReadIncreasingTimes(file, "control/t");
  file.Claim("control/t", static_cast<double>(t.values.size() * sizeof(ControlSample)));
  recording->control.resize(t.values.size());
  for (std::size_t i = 0; i < t.values.size(); ++i) {
    recording->control[i].t = EpisodeTime(t.values[i]);
  }
  for (const ControlColumn& column : kControlColumns) {
    const Doubles values = file.ReadDoubles(std::string("control/") + column.name,
                                            {t.values.size(), recording->joints.size()});
    for (std::size_t i = 0; i < t.values.size(); ++i) {
      recording->control[i].*column.member = VectorAt(values, i);
    }
  }
  const Doubles tool = file.ReadDoubles("tool/position", {kAny, 3});
  const std::size_t num_positions = tool.shape.front();
  if (num_positions != 0 && num_positions != t.values.size()) {
    file.Fail("tool/position", "must have one row a control tick, or none");
  }
  for (std::size_t i = 0; i < num_positions; ++i) {
    recording->p_WTool.emplace_back(VectorAt(tool, i));
  }
}

void ReadTruth(const Hdf5ImageReader& file, Recording* recording) {
  const Doubles t = ReadIncreasingTimes(file, "truth/t");
  const hsize_t num_rows = t.values.size();
  const std::size_t num_obstacles = recording->obstacles.size();
  const Doubles clearance = file.ReadDoubles("truth/clearance", {num_rows});
  const Strings part = file.ReadStrings("truth/nearest_robot_part", {num_rows});
  const Strings object = file.ReadStrings("truth/nearest_object", {num_rows});
  const Integers in_contact = file.ReadIntegers("truth/in_contact", {num_rows});
  const Doubles contact_time = file.ReadDoubles("truth/contact_time", {num_rows});
  const Strings contact_object = file.ReadStrings("truth/contact_object", {num_rows});
  const Doubles contact_point = file.ReadDoubles("truth/contact_point", {num_rows, 3});
  const std::vector<Pose> poses = ReadPoses(file, "truth/obstacle_position",
                                            "truth/obstacle_quaternion", {num_rows, num_obstacles});
  recording->truth.resize(num_rows);
  for (std::size_t i = 0; i < num_rows; ++i) {
    TruthSample& sample = recording->truth[i];
    sample.t = EpisodeTime(t.values[i]);
    sample.clearance_m = clearance.values[i];
    sample.nearest_robot_part = part.values[i];
    sample.nearest_object = object.values[i];
    sample.in_contact = in_contact.values[i] != 0;
    sample.contact_s = contact_time.values[i];
    sample.contact_object = contact_object.values[i];
    sample.p_WContact = VectorAt(contact_point, i);
    const auto first = poses.begin() + static_cast<std::ptrdiff_t>(i * num_obstacles);
    sample.X_WO.assign(first, first + static_cast<std::ptrdiff_t>(num_obstacles));
  }
}

void ReadPlans(const Hdf5ImageReader& file, Recording* recording) {
  const hsize_t n = recording->joints.size();
  const Doubles t = ReadTimes(file, "plans/t", kAny);
  const Doubles q = file.ReadDoubles("plans/q", {t.values.size(), n});
  const Doubles v = file.ReadDoubles("plans/v", {t.values.size(), n});
  const Integers offsets =
      ReadOffsets(file, "plans/offset", recording->cycles.size(), t.values.size());
  for (std::size_t i = 0; i < recording->cycles.size(); ++i) {
    const auto first = static_cast<std::size_t>(offsets.values[i]);
    const auto num_states = static_cast<Eigen::Index>(offsets.values[i + 1] - offsets.values[i]);
    if (num_states == 0) continue;
    const auto rows = static_cast<Eigen::Index>(n);
    Trajectory& plan = recording->cycles[i].plan;
    plan.t_s = Eigen::Map<const Eigen::VectorXd>(t.values.data() + first, num_states);
    plan.q = Eigen::Map<const Eigen::MatrixXd>(q.values.data() + first * n, rows, num_states);
    plan.v = Eigen::Map<const Eigen::MatrixXd>(v.values.data() + first * n, rows, num_states);
    try {
      CheckTrajectory(plan);
    } catch (const std::invalid_argument& error) {
      file.Fail("plans", "cycle " + std::to_string(i) + ": " + error.what());
    }
  }
}

void ReadPredictions(const Hdf5ImageReader& file, Recording* recording) {
  const Integers id = file.ReadIntegers("predictions/id", {kAny});
  const std::size_t num_objects = id.values.size();
  const Doubles half_extents = file.ReadDoubles("predictions/half_extents", {num_objects, 3});
  const Doubles t = ReadTimes(file, "predictions/poses/t", kAny);
  const std::size_t num_poses = t.values.size();
  const std::vector<Pose> poses =
      ReadPoses(file, "predictions/poses/position", "predictions/poses/quaternion", {num_poses});
  const Integers pose_offsets =
      ReadOffsets(file, "predictions/poses/offset", num_objects, num_poses);
  const Integers offsets =
      ReadOffsets(file, "predictions/offset", recording->cycles.size(), num_objects);
  for (std::size_t i = 0; i < recording->cycles.size(); ++i) {
    for (auto k = static_cast<std::size_t>(offsets.values[i]);
         k < static_cast<std::size_t>(offsets.values[i + 1]); ++k) {
      PredictedObject object;
      object.id = static_cast<int>(id.values[k]);
      object.half_extents_m = VectorAt(half_extents, k);
      for (auto m = static_cast<std::size_t>(pose_offsets.values[k]);
           m < static_cast<std::size_t>(pose_offsets.values[k + 1]); ++m) {
        object.t.push_back(EpisodeTime(t.values[m]));
        object.X_WO.push_back(poses[m]);
      }
      recording->cycles[i].objects.push_back(std::move(object));
    }
  }
}

void ReadCycles(const Hdf5ImageReader& file, Recording* recording) {
  const Doubles t = ReadTimes(file, "cycles/t", kAny);
  const hsize_t num_rows = t.values.size();
  const Doubles t_effect = ReadTimes(file, "cycles/t_effect", num_rows);
  const Strings status = file.ReadStrings("cycles/status", {num_rows});
  const Strings reason = file.ReadStrings("cycles/reason", {num_rows});
  const Integers accepted = file.ReadIntegers("cycles/accepted", {num_rows});
  const Integers iterations = file.ReadIntegers("cycles/iterations", {num_rows});
  const Integers cut_short = file.ReadIntegers("cycles/cut_short", {num_rows});
  const Doubles cost = file.ReadDoubles("cycles/cost", {num_rows});
  const Doubles clearance = file.ReadDoubles("cycles/predicted_clearance", {num_rows});
  const Integers outside = file.ReadIntegers("cycles/samples_outside_grid", {num_rows});
  const Doubles plan_start = ReadTimes(file, "cycles/plan_start", num_rows);
  recording->cycles.resize(num_rows);
  for (std::size_t i = 0; i < num_rows; ++i) {
    CycleRecord& cycle = recording->cycles[i];
    cycle.t = EpisodeTime(t.values[i]);
    cycle.t_effect = EpisodeTime(t_effect.values[i]);
    cycle.status = status.values[i];
    cycle.reason = reason.values[i];
    cycle.accepted = accepted.values[i] != 0;
    cycle.iterations = static_cast<int>(iterations.values[i]);
    cycle.cut_short = cut_short.values[i] != 0;
    cycle.cost = cost.values[i];
    cycle.predicted_clearance_m = clearance.values[i];
    cycle.samples_outside_grid = static_cast<int>(outside.values[i]);
    cycle.plan_start = EpisodeTime(plan_start.values[i]);
  }
  ReadPlans(file, recording);
  ReadPredictions(file, recording);
}

void ReadEvents(const Hdf5ImageReader& file, Recording* recording) {
  const Doubles t = ReadTimes(file, "events/t", kAny);
  const hsize_t num_rows = t.values.size();
  const Strings what = file.ReadStrings("events/what", {num_rows});
  const Integers id = file.ReadIntegers("events/id", {num_rows});
  const Integers other_id = file.ReadIntegers("events/other_id", {num_rows});
  const Doubles position = file.ReadDoubles("events/position", {num_rows, 3});
  for (std::size_t i = 0; i < num_rows; ++i) {
    recording->events.push_back({EpisodeTime(t.values[i]), what.values[i],
                                 static_cast<int>(id.values[i]),
                                 static_cast<int>(other_id.values[i]), VectorAt(position, i)});
  }
}

void ReadSafety(const Hdf5ImageReader& file, Recording* recording) {
  const Doubles t = ReadTimes(file, "safety/t", kAny);
  const hsize_t num_rows = t.values.size();
  const Strings check = file.ReadStrings("safety/check", {num_rows});
  const Strings reaction = file.ReadStrings("safety/reaction", {num_rows});
  const Doubles value = file.ReadDoubles("safety/value", {num_rows});
  const Doubles limit = file.ReadDoubles("safety/limit", {num_rows});
  for (std::size_t i = 0; i < num_rows; ++i) {
    recording->safety.push_back({EpisodeTime(t.values[i]), check.values[i], reaction.values[i],
                                 value.values[i], limit.values[i]});
  }
}

void ReadObservations(const Hdf5ImageReader& file, Recording* recording) {
  const Doubles t = ReadIncreasingTimes(file, "observations/t");
  const std::size_t num_rows = t.values.size();
  const Doubles t_arrival = ReadTimes(file, "observations/t_arrival", num_rows);
  const Integers cells = file.ReadIntegers("observations/changed/cell", {kAny});
  const Integers cell_offset =
      ReadOffsets(file, "observations/changed/offset", num_rows, cells.values.size());
  const Strings ids = file.ReadStrings("observations/objects/id", {kAny});
  const hsize_t num_objects = ids.values.size();
  const Integers object_offset =
      ReadOffsets(file, "observations/objects/offset", num_rows, num_objects);
  const std::vector<Pose> poses = ReadPoses(file, "observations/objects/position",
                                            "observations/objects/quaternion", {num_objects});
  const Doubles covariance = file.ReadDoubles("observations/objects/covariance", {num_objects, 36});
  const auto at = [](const Integers& offsets, std::size_t row) {
    return static_cast<std::size_t>(offsets.values[row]);
  };
  for (std::size_t i = 0; i < num_rows; ++i) {
    ObservationRecord& observation = recording->observations.emplace_back();
    observation.t = EpisodeTime(t.values[i]);
    observation.t_arrival = EpisodeTime(t_arrival.values[i]);
    observation.changed_cells.assign(cells.values.begin() + cell_offset.values[i],
                                     cells.values.begin() + cell_offset.values[i + 1]);
    for (std::size_t k = at(object_offset, i); k < at(object_offset, i + 1); ++k) {
      SeenObject& object = observation.objects.emplace_back();
      object.id = ids.values[k];
      object.X_WO = poses[k];
      object.covariance = VectorAt(covariance, k).reshaped(6, 6);
    }
  }
}

}  // namespace

std::vector<unsigned char> ToHdf5(const Recording& recording) {
  CheckRecording(recording);
  Hdf5ImageWriter file;
  file.SetAttribute("format", kTraceFormat.name);
  file.SetAttribute("version", kTraceFormat.version);
  WriteHeaderAndMetrics(file, recording);
  WriteProblem(file, recording);
  WriteControl(file, recording);
  WriteTruth(file, recording);
  WriteCycles(file, recording);
  WriteEvents(file, recording);
  WriteSafety(file, recording);
  WriteObservations(file, recording);
  return file.Finish();
}

Recording FromHdf5(std::span<const unsigned char> payload, const std::string& name,
                   std::size_t* most_bytes) {
  const Hdf5ImageReader file(payload, name, *most_bytes);
  if (file.GetIntegerAttribute("version") != kTraceFormat.version) {
    file.Fail("version", "differs from the one in the file's head");
  }
  Recording recording;
  ReadProblem(file, &recording);
  ReadControl(file, &recording);
  ReadTruth(file, &recording);
  ReadCycles(file, &recording);
  ReadEvents(file, &recording);
  ReadSafety(file, &recording);
  ReadObservations(file, &recording);
  *most_bytes = file.bytes_left();
  return recording;
}

void WriteRecording(const Recording& recording, const std::string& path) {
  WriteSealedFile(path, kTraceFormat, ToHdf5(recording));
}

Recording ReadRecording(const std::string& path) {
  std::size_t most_bytes = Hdf5ImageReader::kMostBytes;
  return FromHdf5(ReadSealedFile(path, kTraceFormat), path, &most_bytes);
}

std::string Hdf5Version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release);
}

}  // namespace sidestep::record
