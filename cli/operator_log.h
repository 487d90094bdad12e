#pragma once

#include <optional>
#include <string>

#include "sidestep/hardware/readiness.h"

namespace sidestep::cli {

/// What `sidestep hardware` refused and recovered, in the order of time: no episode was run then
/// whose result could hold it. A CSV file of this user, `sidestep/hardware.csv` in the folder
/// XDG_STATE_HOME (~/.local/state).
///
/// Ages are those of the machine's steady clock, which goes on from one program to the next: who
/// sets the time of day changes none. After a restart of the machine what came before has no age.
class OperatorLog {
 public:
  /// @param robot its address.
  explicit OperatorLog(std::string robot);

  const std::string& path() const { return path_; }

  /// @throws InputError if the file cannot be read or written.
  void Refused(const hardware::Objection& objection) const;
  void Recovered(const std::string& why) const;

  /// Since this robot was recovered the last time, in this session of the machine.
  std::optional<double> SecondsSinceRecovery() const;

 private:
  void Append(const hardware::Objection& entry, const char* reaction) const;

  std::string robot_, path_;
};

/// The day, YYYY-MM-DD.
std::string TodayUtc();

}  // namespace sidestep::cli
