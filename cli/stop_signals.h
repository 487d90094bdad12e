#pragma once

namespace sidestep::cli {

/// While one lives, Ctrl-C and SIGTERM are counted instead of ending the process at once, so that
/// what moves can be stopped and what has been recorded kept. The third one ends it.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  int count() const;
};

}  // namespace sidestep::cli
