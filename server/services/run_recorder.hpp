#pragma once
// Writes down what the robot drives: runs with their tracks, and where the mission in hand stands.
// It reads snapshots; nothing of it runs in the control loop, and the store writes on its own
// thread. The services' thread.
//
//   Idle ──mission runs──▶ Recording ──pause──▶ Resting ──runs again──▶ Recording
//                              └──finished, stopped, another mission──▶ Idle
//
// Points come at 5 Hz and go to the store every second, so a power cut loses at most these. While
// the store is busy they wait, at most kMost of them; then the oldest go, and that is counted.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/snapshot.hpp"
#include "robot/robot.hpp"
#include "store/store.hpp"

namespace roverd::services {

class RunRecorder {
 public:
  static constexpr base::Duration kEvery = std::chrono::milliseconds(200);
  static constexpr base::Duration kFlush = std::chrono::seconds(1);
  static constexpr std::size_t kMost = 3000;
  static constexpr base::Duration kStops = std::chrono::seconds(10);
  static constexpr double kStanding_mps = 0.02;

  RunRecorder(robot::Robot& robot, store::Store& store, std::string vehicle)
      : robot_(robot), store_(store), vehicle_(std::move(vehicle)) {}

  /// Every sample of the snapshot, 20 Hz.
  void look(const base::Snapshot& s);
  void take(const base::Event& event);

  /// The mission that another life of the program left behind; empty: none, it is in hand, or
  /// another one is loaded. Until one is begun it is offered again when that one is not.
  std::optional<store::StoredPlace> offer() const;
  /// Offers it no more, in no later life either. @param done once the store has it
  void forget(std::function<void(base::Result<void>)> done);
  /// Reads it; once, before the first sample counts.
  void recall();
  /// It was read, or could not be, or a mission is in hand since: offer() is right.
  bool recalled() const noexcept { return recalled_; }

  std::optional<std::int64_t> running() const noexcept { return id_; }
  std::uint64_t lost_points() const noexcept { return lost_; }

 private:
  void begin(const base::Snapshot& s);
  void end(store::RunOutcome outcome, const base::Snapshot& s);
  void sample(const base::Snapshot& s);
  bool drives(const base::Snapshot& s);
  void flush(base::WallTime wall, std::optional<store::RunOutcome> outcome);
  void send();
  void keep_place(const base::Snapshot& s);

  robot::Robot& robot_;
  store::Store& store_;
  std::string vehicle_;
  std::optional<store::StoredPlace> offer_;
  std::string loaded_id_;  ///< of the last sample; empty: no mission is loaded
  bool recalling_ = false;
  bool recalled_ = false;
  bool place_kept_ = false;
  std::string place_seen_;
  base::Time place_at_;

  bool open_ = false;               ///< a run is in hand
  std::optional<std::int64_t> id_;  ///< once the store has told it
  std::uint64_t generation_ = 0;    ///< of the run in hand: late answers know theirs
  std::string mission_id_;
  base::ExecutionState state_ = base::ExecutionState::Idle;
  base::Time begun_;
  base::Time sampled_;
  base::Time ran_;      ///< the mission, last
  bool stands_ = true;  ///< it stopped since then, or had no time to
  base::Time flushed_;
  int lap_ = 1;
  store::RunBatch batch_;
  bool sending_ = false;
  std::uint64_t lost_ = 0;
  std::shared_ptr<RunRecorder*> self_ = std::make_shared<RunRecorder*>(this);
};

}  // namespace roverd::services
