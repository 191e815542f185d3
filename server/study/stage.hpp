#pragma once
// The whole robot in one thread and simulated time: plant ⇄ real frames and bytes over memory links
// ⇄ real drivers, codecs and gate ⇄ Robot::tick every 20 ms.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "config/settings.hpp"
#include "gnss/driver.hpp"
#include "link/memory.hpp"
#include "robot/robot.hpp"
#include "sim/bunker.hpp"
#include "sim/cart.hpp"

namespace roverd::study {

class Stage {
 public:
  static constexpr base::Duration kTick = std::chrono::milliseconds(20);

  /// @param settings of a vehicle whose drive the plant's wire speaks.
  Stage(const Settings& settings, const sim::Params& plant, std::uint64_t seed,
        const sim::Start& start);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void tick();
  /// Within a tick, each time that the devices have been heard and before the robot acts: every 10
  /// ms. May be empty.
  std::function<void(base::Time)> on_heard;
  base::Result<void> ask(robot::Command command);

  /// The program dies: from now on only the vehicle goes on.
  void kill_program() noexcept { alive_ = false; }
  bool alive() const noexcept { return alive_; }
  /// Somebody else on the bus sends this. On a vehicle without one: nothing happens.
  void put_on_bus(const base::CanFrame& frame) { can_.b->send(frame); }

  sim::Vehicle& plant() noexcept { return *plant_; }
  robot::Robot& robot() noexcept { return robot_; }
  double now_s() const noexcept { return base::seconds(now_.time_since_epoch()); }
  /// Of the last tick, what Robot::tick alone took.
  double tick_us() const noexcept { return tick_us_; }

 private:
  void wire_sensors(const Settings& s);
  void wire_bunker(const Settings& s, sim::Bunker& plant);
  void wire_cart(const Settings& s, sim::Cart& plant);
  template <class Driver, class Wired>
  void add(const std::string& name, const Wired& wired, link::MemoryBytePair& pair);
  void join(link::MemoryBytePair& pair);

  std::unique_ptr<sim::Vehicle> plant_;
  base::WallTime wall_;
  robot::Robot robot_;
  base::Time now_{};
  base::Time at_{};  ///< finer than now_: when a frame leaves within a tick
  double tick_us_ = 0.0;
  bool alive_ = true;
  link::MemoryFramePair can_;
  link::MemoryBytePair drive_;
  link::MemoryBytePair bumper_;
  link::MemoryBytePair gnss_bytes_;
  link::MemoryBytePair imu_bytes_;
  std::vector<std::function<void(base::Time)>> ticks_;
  std::vector<robot::PendingReply> replies_;
  std::vector<base::Event> events_;
};

}  // namespace roverd::study
