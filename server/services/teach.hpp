#pragma once
// Teach-in: the recording of a driven way, from the first sample to the mission.
//
//   Idle ──start──▶ Recording ◀──pause, resume──▶ Paused
//    ▲                  │                           │
//    └── stop: a mission, discard: nothing ─────────┘
//   Interrupted (found in the store at the start) ──resume, stop, discard──▶ as from Paused
//
// Points go to the store once a second: a power cut loses at most the last second. Whoever drives,
// and by what means, makes no difference. The services' thread.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/snapshot.hpp"
#include "mission/edit/teach.hpp"
#include "robot/robot.hpp"
#include "store/store.hpp"

namespace roverd::services {

enum class TeachState { Loading, Idle, Recording, Paused, Interrupted };
/// "recording"
const char* to_string(TeachState state) noexcept;

/// What people see of a recording.
struct TeachView {
  TeachState state = TeachState::Loading;
  std::size_t points = 0;
  double length_m = 0.0;
  std::string name;  ///< of Idle and Loading: empty, as all below
  base::WallTime started{};
  int gaps = 0;
  std::size_t unsaved_points = 0;  ///< not on the disk yet
  std::string waiting;             ///< why nothing is recorded now; empty: it is
  mission::TeachSettings settings{};
};

class TeachIn {
 public:
  using State = TeachState;
  using Done = std::function<void(base::Result<void>)>;
  using Saved = store::Reply<store::StoredMission>;

  /// Looks for a recording that was interrupted. @param store must outlive it
  explicit TeachIn(store::Store& store);
  ~TeachIn();
  TeachIn(const TeachIn&) = delete;
  TeachIn& operator=(const TeachIn&) = delete;

  /// Writes an event as if the robot had said it. Set it before anything else.
  std::function<void(base::Event)> tell;
  /// A mission was made.
  std::function<void(const store::StoredMission&)> announce;

  /// Every Services::kSample.
  void sample(const base::Snapshot& snapshot);
  /// Once a second.
  void save();
  /// What the radio asks for: done, or refused with an event.
  void wish(robot::TeachWish wish);

  /// Each calls `done` once: at once with a Conflict that names the state, or when the store has
  /// it. @param name empty: "Taught 2026-05-12 14:03"
  void start(const mission::TeachSettings& settings, std::string name, Done done);
  void pause(Done done);
  void resume(Done done);
  void discard(Done done);
  /// @param name empty: as it was started. @param tolerance_m empty: likewise
  void stop(std::string name, std::optional<double> tolerance_m, Saved saved);

  TeachView view() const;

 private:
  base::Result<void> allow(const char* what, std::initializer_list<State> from) const;
  void take(const std::vector<mission::TaughtPoint>& points);
  void forget();
  void event(base::Severity level, const char* kind, std::string detail);

  store::Store& store_;
  State state_ = State::Loading;
  bool busy_ = false;  ///< the store has not answered a start, stop or discard yet
  store::TeachRecord record_;
  std::size_t saved_ = 0;    ///< points that the store has
  std::size_t sending_ = 0;  ///< points on their way to it
  bool save_failed_ = false;
  std::optional<mission::Sampler> sampler_;
  double length_m_ = 0.0;
  int gaps_ = 0;
  std::string waiting_;  ///< why nothing is recorded now; empty: it is
  /// Answers of the store may come when this is gone: they ask here first.
  std::shared_ptr<TeachIn*> self_ = std::make_shared<TeachIn*>(this);
};

}  // namespace roverd::services
