#pragma once

#include <compare>

namespace sidestep {

/// A span of time [s]: how far ahead of a moment another lies. Never a moment itself.
class HorizonOffset {
 public:
  constexpr HorizonOffset() = default;
  explicit constexpr HorizonOffset(double seconds) : seconds_(seconds) {}
  constexpr double seconds() const { return seconds_; }
  auto operator<=>(const HorizonOffset&) const = default;

 private:
  double seconds_ = 0;
};

/// A moment: the time since the episode began [s]. Fields are sampled at an EpisodeTime. It does
/// not mix with HorizonOffset but by the three operations below, because a prediction asked for "1
/// s ahead" and answered for "1 s after the start" is wrong and looks right.
class EpisodeTime {
 public:
  constexpr EpisodeTime() = default;
  explicit constexpr EpisodeTime(double seconds) : seconds_(seconds) {}
  constexpr double seconds() const { return seconds_; }
  auto operator<=>(const EpisodeTime&) const = default;

 private:
  double seconds_ = 0;
};

constexpr EpisodeTime operator+(EpisodeTime t, HorizonOffset dt) {
  return EpisodeTime(t.seconds() + dt.seconds());
}
constexpr EpisodeTime operator-(EpisodeTime t, HorizonOffset dt) {
  return EpisodeTime(t.seconds() - dt.seconds());
}
constexpr HorizonOffset operator-(EpisodeTime a, EpisodeTime b) {
  return HorizonOffset(a.seconds() - b.seconds());
}

}  // namespace sidestep
