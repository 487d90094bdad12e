#include "sidestep/sim/fci/fault_script.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sidestep/core/yaml_reader.h"
#include "sidestep/robot/fci/errors.h"

namespace sidestep::sim::fci {
namespace {

// What each kind of fault asks for besides at_s.
struct Keys {
  const char* word;
  FaultKind kind;
  bool lasts = false, counts = false, has_joint = false;
  const char* number = nullptr;  // a key of its own
  double Fault::*value = nullptr;
};
constexpr Keys kKinds[] = {
    {"lose_commands", FaultKind::kLoseCommands, false, true},
    {"lose_states", FaultKind::kLoseStates, false, true},
    {"lose_some", FaultKind::kLoseSome, true, false, false, "rate", &Fault::rate},
    {"user_stop", FaultKind::kUserStop, true},
    {"guiding", FaultKind::kGuiding, true},
    {"error", FaultKind::kError},
    {"cut_link", FaultKind::kCutLink},
    {"external_torque", FaultKind::kExternalTorque, true, false, true, "rate_n_m_s", &Fault::rate},
    {"friction", FaultKind::kFriction, true, false, true, "torque_n_m", &Fault::torque_n_m},
    {"blocked_joint", FaultKind::kBlockedJoint, true, false, true},
    {"tracking_offset", FaultKind::kTrackingOffset, true, false, true, "offset_rad",
     &Fault::offset_rad},
};

Fault ReadFault(const YamlReader& reader) {
  std::vector<std::string> words;
  for (const Keys& keys : kKinds) words.emplace_back(keys.word);
  const std::string word = reader.GetChoice("kind", words);
  const Keys& keys = *std::find_if(std::begin(kKinds), std::end(kKinds),
                                   [&](const Keys& k) { return word == k.word; });
  Fault fault;
  fault.kind = keys.kind;
  fault.at_s = reader.GetNonNegative("at_s");
  if (keys.lasts) fault.duration_s = reader.GetPositive("for_s");
  if (keys.counts) {
    fault.count = reader.GetInt("count");
    if (fault.count < 1) reader.Fail("count", "must be >= 1, is " + std::to_string(fault.count));
  }
  if (keys.has_joint) {
    const int joint = reader.GetInt("joint");
    if (joint < 1 || joint > robot::fci::kNumJoints) {
      reader.Fail("joint", "must be 1 to 7, is " + std::to_string(joint));
    }
    fault.joint = joint - 1;
  }
  if (keys.number != nullptr) fault.*keys.value = reader.GetDouble(keys.number);
  if (fault.kind == FaultKind::kLoseSome && !(fault.rate >= 0 && fault.rate <= 1)) {
    reader.Fail("rate", "must be 0 to 1");
  }
  if (fault.kind == FaultKind::kError) {
    const std::string name = reader.GetString("name");
    const auto error = robot::fci::FindError(name);
    if (!error) reader.Fail("name", "no error of the robot is named '" + name + "'");
    fault.error = *error;
  }
  reader.CheckNoUnknownKeys();
  return fault;
}

int GetIntFromZero(const YamlReader& reader, const std::string& key) {
  const int value = reader.GetInt(key);
  if (value < 0) reader.Fail(key, "must be >= 0, is " + std::to_string(value));
  return value;
}

FaultScript Read(const YamlReader& reader) {
  FaultScript script;
  if (reader.Has("seed")) {
    script.seed = static_cast<std::uint64_t>(GetIntFromZero(reader, "seed"));
  }
  if (reader.Has("version")) {
    const int version = GetIntFromZero(reader, "version");
    if (version > std::numeric_limits<std::uint16_t>::max()) reader.Fail("version", "is too large");
    script.version = static_cast<std::uint16_t>(version);
  }
  if (reader.Has("refuse_moves")) script.refuse_moves = GetIntFromZero(reader, "refuse_moves");
  if (reader.Has("force_estimate")) {
    const YamlReader estimate = reader.GetMap("force_estimate");
    script.force_per_speed_n_s_m = estimate.GetNonNegative("per_speed_n_s_m");
    script.force_per_acceleration_kg = estimate.GetNonNegative("per_acceleration_kg");
    estimate.CheckNoUnknownKeys();
  }
  if (reader.Has("faults")) {
    for (const YamlReader& fault : reader.GetMaps("faults")) {
      script.faults.push_back(ReadFault(fault));
    }
  }
  reader.CheckNoUnknownKeys();
  return script;
}

}  // namespace

FaultScript ReadFaultScript(const std::string& path) { return Read(YamlReader::FromFile(path)); }

FaultScript ParseFaultScript(const std::string& text, const std::string& name) {
  return Read(YamlReader::FromText(text, name));
}

}  // namespace sidestep::sim::fci
