#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "sidestep/sim/fci/panda_world.h"
#include "sidestep/sim/fci/server.h"
#include "tests/hardware/own_loopback.h"

namespace sidestep::hardware {

/// A simulated Panda on the loopback, served by a thread of its own while this lives.
class ServedPanda {
 public:
  using MakeCamera = std::function<std::unique_ptr<robot::FrameSource>(const sim::World&)>;

  /// @param camera what it shows of its world; empty: nothing.
  explicit ServedPanda(const std::string& faults = "", sim::fci::ServerOptions options = {},
                       const scenarios::Scenario& scenario = sim::fci::PandaAlone(),
                       const MakeCamera& camera = {})
      : robot_(robot::RobotModel::Load(kModels, "panda", scenario.X_WB)),
        world_(sim::fci::MakePandaWorld(scenario, robot_, kModels,
                                        robot_.configurations().at("home"))),
        plant_(robot_, world_.get()) {
    const auto script = sim::fci::ParseFaultScript(faults.empty() ? "{}" : faults, "faults.yaml");
    panda_ = std::make_unique<sim::fci::SimulatedPanda>(&plant_, script);
    options.address = OwnLoopback();
    options.version = script.version;
    server_ = std::make_unique<sim::fci::Server>(panda_.get(), options);
    if (camera) {
      frames_ = std::make_unique<sim::fci::FrameServer>(options.address, *world_,
                                                        [this, camera] { return camera(*world_); });
      server_->Show(frames_.get());
    }
    thread_ = std::thread([this] { server_->Run([this] { return stop_.load(); }); });
  }
  ~ServedPanda() {
    stop_ = true;
    thread_.join();
  }

  std::string address() const { return OwnLoopback(); }
  const robot::RobotModel& robot() const { return robot_; }

 private:
  static constexpr const char* kModels = SIDESTEP_SOURCE_DIR "/models";
  robot::RobotModel robot_;
  std::unique_ptr<sim::World> world_;
  sim::fci::PandaPlant plant_;
  std::unique_ptr<sim::fci::SimulatedPanda> panda_;
  std::unique_ptr<sim::fci::FrameServer> frames_;
  std::unique_ptr<sim::fci::Server> server_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace sidestep::hardware
