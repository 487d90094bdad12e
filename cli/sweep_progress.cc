#include "sidestep/cli/sweep_progress.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>

#include "sidestep/cli/console.h"

namespace sidestep::cli {
namespace {

// From one word to the next; longer as the work goes on.
constexpr double kShortest_s = 5, kLongest_s = 60;

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

SweepProgress::SweepProgress(std::uint64_t count)
    : count_(count), begun_s_(Now_s()), told_s_(begun_s_) {}

void SweepProgress::Count(bool failed) {
  ++done_;
  failed_ += failed ? 1 : 0;
  const double now_s = Now_s(), since_s = now_s - begun_s_;
  if (now_s - told_s_ < std::fmin(kLongest_s, std::fmax(kShortest_s, since_s / 20))) return;
  told_s_ = now_s;
  const double rate = static_cast<double>(done_) / since_s;
  PrintError("{} of {} runs, {:.3g} a second, {} left{}\n", done_, count_, rate,
             DurationText(static_cast<double>(count_ - done_) / rate),
             failed_ > 0 ? fmt::format("; {} failed", failed_) : "");
}

std::string SweepProgress::DurationText(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace sidestep::cli
