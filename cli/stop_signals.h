#pragma once

#include <string>

namespace sidestep::cli {

/// While one lives, Ctrl-C, SIGTERM and the end of the terminal are counted instead of ending the
/// process at once, so that what moves can be stopped and what has been recorded kept. The third
/// one ends it, with a line that says so.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  int count() const;
  /// "Ctrl-C", "SIGTERM", "SIGHUP": the first one that came; empty before.
  std::string first() const;
};

}  // namespace sidestep::cli
