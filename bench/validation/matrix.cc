#include "sidestep/bench/validation/matrix.h"

#include <string>

#include "sidestep/bench/validation/behaviours.h"
#include "sidestep/bench/validation/faults.h"
#include "sidestep/bench/validation/perception.h"
#include "sidestep/bench/validation/timing.h"

namespace sidestep::bench {
namespace {

using namespace validation_group;

// Of the declared speed. What is measured of the greatest one errs, so it is not all of it.
constexpr double kSlow = 0.2, kMiddle = 0.5, kQuick = 0.8;
constexpr double kWithin[] = {kSlow, kMiddle, kQuick};
constexpr double kBeyond[] = {1.6, 2.8, 4};

// What stands for all behaviours where something else is varied.
constexpr const char* kSome[] = {"cross", "slow_down", "circle"};
constexpr const char* kForPairs[] = {"cross",     "head_on", "follow",
                                     "slow_down", "circle",  "two_boxes"};
constexpr const char* kForSpeed[] = {"cross", "head_on", "circle", "reverse"};

class Matrix {
 public:
  Matrix(const scenarios::Scenario& scenario, int draws, bool with_wire)
      : scenario_(scenario), draws_(draws), with_wire_(with_wire) {
    SetLikelySensor(scenario_);
  }

  std::vector<ValidationCase> Make() {
    AddBehaviours();
    AddFast();
    AddPerceptions();
    AddTimings();
    AddPairs();
    AddFaults();
    AddRepeats();
    return std::move(cases_);
  }

 private:
  ValidationCase Begin(const char* group, const char* behaviour, double share) const {
    ValidationCase one;
    one.group = group;
    one.behaviour = behaviour;
    one.speed_m_s = share * scenario_.safety.obstacle_speed_m_s;
    one.knowledge = scenario_.knowledge;
    return one;
  }

  // Once a draw, from `first` on.
  void Add(ValidationCase one, int draws, int first = 1) {
    for (one.draw = first; one.draw < first + draws; ++one.draw) cases_.push_back(one);
  }
  void Add(const ValidationCase& one) { Add(one, draws_); }

  void AddBehaviours() {
    for (const Behaviour& behaviour : Behaviours()) {
      const char* const group = behaviour.acceleration_share > 1 ? kSudden : kEnvelope;
      for (const double share : kWithin) {
        const bool stands = std::string(behaviour.name) == "stand";
        if (stands && share != kSlow) continue;
        Add(Begin(group, behaviour.name, stands ? 0 : share));
      }
    }
  }

  void AddFast() {
    for (const char* const behaviour : kForSpeed) {
      for (const double share : kBeyond) Add(Begin(kFast, behaviour, share));
    }
  }

  void AddPerceptions() {
    for (const Perception& perception : Perceptions()) {
      if (&perception == &Perceptions().front()) continue;
      if (perception.noise > 1 && !HasNoiseModel(scenario_)) continue;
      for (const char* const behaviour : kSome) {
        ValidationCase one = Begin(kPerception, behaviour, kMiddle);
        one.perception = perception.name;
        Add(one);
      }
    }
  }

  void AddTimings() {
    for (const Timing& timing : Timings()) {
      const bool is_nominal = &timing == &Timings().front();
      for (const char* const behaviour : kSome) {
        ValidationCase one = Begin(is_nominal ? kEnvelope : kTiming, behaviour, kMiddle);
        one.timing = timing.name;
        one.on_the_wire = is_nominal || timing.lost_share > 0;
        if (one.on_the_wire && !with_wire_) continue;
        if (one.on_the_wire) {
          Add(one, 1);
        } else {
          Add(one);
        }
      }
    }
  }

  // Each pair meets the same obstacle.
  void AddPairs() {
    for (const char* const behaviour : kForPairs) {
      for (const double share : {kMiddle, kQuick}) {
        for (const char* const knowledge : {"prediction", "execute_and_update"}) {
          ValidationCase one = Begin(kPrediction, behaviour, share);
          one.knowledge = knowledge;
          one.is_supervised = false;
          Add(one);
        }
      }
    }
  }

  void AddFaults() {
    for (const ValidationFault& fault : ValidationFaults()) {
      if (&fault == &ValidationFaults().front()) continue;
      ValidationCase one = Begin(kFault, "cross", kSlow);
      one.fault = fault.name;
      one.on_the_wire = *fault.on_the_wire != '\0';
      if (!one.on_the_wire || with_wire_) Add(one, 1);
    }
  }

  // Of what is above, one simulated and one on the wire.
  void AddRepeats() {
    ValidationCase one = Begin(kRepeat, "cross", kMiddle);
    Add(one, 1);
    one.behaviour = "circle";
    Add(one, 1);
    one.on_the_wire = true;
    if (with_wire_) Add(one, 1);
  }

  scenarios::Scenario scenario_;
  const int draws_;
  const bool with_wire_;
  std::vector<ValidationCase> cases_;
};

}  // namespace

std::vector<ValidationCase> ValidationMatrix(const scenarios::Scenario& scenario, int draws,
                                             bool with_wire) {
  return Matrix(scenario, draws, with_wire).Make();
}

std::vector<ValidationCase> SoakCases(const scenarios::Scenario& scenario, int first, int last) {
  std::vector<ValidationCase> cases;
  for (int draw = first; draw <= last; ++draw) {
    ValidationCase one;
    one.group = kSoak;
    one.behaviour = "random";
    one.speed_m_s = scenario.safety.obstacle_speed_m_s;
    one.knowledge = scenario.knowledge;
    one.draw = draw;
    cases.push_back(one);
  }
  return cases;
}

}  // namespace sidestep::bench
