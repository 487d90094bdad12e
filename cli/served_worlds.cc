#include "sidestep/cli/served_worlds.h"

#include <unistd.h>

#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "sidestep/cli/hardware_world.h"
#include "sidestep/cli/sensors.h"
#include "sidestep/core/number_text.h"
#include "sidestep/sim/fci/fault_script.h"
#include "sidestep/sim/fci/panda_world.h"
#include "sidestep/sim/fci/server.h"
#include "sidestep/sim/safety_of.h"

namespace sidestep::cli {
namespace {

constexpr int kMostAddresses = 1000;

// Of 127.0.0.0/8, most of which nobody uses: a process begins somewhere of its own.
std::string Address(int number) {
  const auto place = static_cast<unsigned>(getpid()) * 64 + static_cast<unsigned>(number);
  return "127." + std::to_string(64 + (place >> 16 & 0x3f)) + "." +
         std::to_string(place >> 8 & 0xff) + "." + std::to_string(place & 0xff);
}

sim::fci::FaultScript ScriptOf(const std::string& faults, double lost_share) {
  std::string lines = faults;
  if (lost_share > 0) {
    lines = "{kind: lose_some, at_s: 0, for_s: 1000, rate: " + ShortestText(lost_share) + "}" +
            (faults.empty() ? "" : ", " + faults);
  }
  return sim::fci::ParseFaultScript("faults: [" + lines + "]", "faults");
}

// Serves from a thread of its own as long as it lives.
class ServedPanda {
 public:
  ServedPanda(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
              const ModelFolders& models, const sim::fci::FaultScript& script)
      : robot_(robot),
        world_(sim::fci::MakePandaWorld(Alone(scenario), robot_, models, scenario.q_start)),
        plant_(robot_, world_.get()),
        panda_(&plant_, script) {
    Listen();
    thread_ = std::thread([this] { server_->Run([this] { return stop_.load(); }); });
  }
  ~ServedPanda() {
    stop_ = true;
    thread_.join();
  }
  ServedPanda(const ServedPanda&) = delete;
  ServedPanda& operator=(const ServedPanda&) = delete;

  const std::string& address() const { return address_; }

 private:
  // Obstacles are virtual, as at a real robot.
  static scenarios::Scenario Alone(scenarios::Scenario scenario) {
    scenario.moving_obstacles.clear();
    return scenario;
  }

  void Listen() {
    static std::atomic<int> next{0};
    for (int tried = 0;; ++tried) {
      sim::fci::ServerOptions options;
      options.address = address_ = Address(next++);
      try {
        server_.emplace(&panda_, options);
        return;
      } catch (const robot::fci::LinkError&) {
        if (tried == kMostAddresses) throw;
      }
    }
  }

  const robot::RobotModel robot_;
  const std::unique_ptr<sim::World> world_;
  sim::fci::PandaPlant plant_;
  sim::fci::SimulatedPanda panda_;
  std::string address_;
  std::optional<sim::fci::Server> server_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace

bench::WorldFactory ServedWorlds(const DataPaths& paths, const std::string& faults,
                                 double lost_share) {
  const sim::fci::FaultScript script = ScriptOf(faults, lost_share);
  return [=](const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
    struct Owner {
      std::unique_ptr<ServedPanda> server;  // outlives who is connected to it
      std::shared_ptr<void> world;
    };
    const auto owner = std::make_shared<Owner>();
    owner->server = std::make_unique<ServedPanda>(scenario, robot, paths.all_models(), script);
    const bench::WorldFactory make = HardwareWorlds(
        paths, {owner->server->address(), &MakeSensor, ""},
        {.safety = sim::SafetyOf(scenario, robot), .lockstep = true, .stops_at_once = {}});
    bench::EpisodeWorld world = make(scenario, robot);
    owner->world = std::exchange(world.owner, owner);
    return world;
  };
}

}  // namespace sidestep::cli
