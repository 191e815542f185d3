#pragma once
// What goes on beside the driving, on a thread of its own: the trail, the runs, slips, teach-in,
// the radio's edits, and which fence holds. It looks at the robot's snapshots and speaks with the
// store; neither the control loop nor the web ever waits for it.
//
//   robot ─snapshots, edits, wishes─▶ ┌──────────┐ ─revisions, runs, points─▶ store
//   web ─calls─▶ desk ──────────────▶ │ services │ ─events, changes─▶ web
//   web ◀─View, answers────────────── └──────────┘

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/latest.hpp"
#include "services/fence_keeper.hpp"
#include "services/radio_edits.hpp"
#include "services/run_recorder.hpp"
#include "services/slip_recorder.hpp"
#include "services/teach.hpp"
#include "services/trail.hpp"
#include "services/way_keeper.hpp"

namespace roverd::services {

/// What everybody may read at any time.
struct View {
  TeachView teach{};
  /// The mission that another life of the program left behind; empty: none, or it is in hand.
  std::optional<store::StoredPlace> offer{};
  /// The store has said whether there is one.
  bool recalled = false;
};

class Services {
 public:
  static constexpr base::Duration kSample = std::chrono::milliseconds(50);
  static constexpr base::Duration kSave = std::chrono::seconds(1);

  /// Called on the services' thread.
  struct Ears {
    /// An event, as if the robot had said it.
    std::function<void(base::Event)> tell{};
    /// A mission was stored.
    std::function<void(const std::string& id, std::int64_t revision)> mission_changed{};
    /// Runs what answers a call: the web's thread. Empty: answered at once.
    std::function<void(std::function<void()>)> answer{};
  };

  /// Nothing runs before start(). Both must outlive it. @param store any asker's
  Services(robot::Robot& robot, const store::Store& store, std::string vehicle);
  ~Services();
  Services(const Services&) = delete;
  Services& operator=(const Services&) = delete;

  void start(Ears ears);
  /// What is at work ends; nothing is told or answered after that.
  void stop();

  /// Any thread, never waits.
  std::shared_ptr<const View> view() const { return view_.get(); }

  // Any thread; the answer comes later, through Ears::answer.
  using Done = TeachIn::Done;
  void start_teach(mission::TeachSettings settings, std::string name, Done done);
  void pause_teach(Done done);
  void resume_teach(Done done);
  void discard_teach(Done done);
  void stop_teach(std::string name, std::optional<double> tolerance_m, TeachIn::Saved saved);
  /// The trail up to the snapshot that comes with it, rendered on the services' thread.
  /// @param render pure; gets what was driven and the last snapshot
  void read_trail(std::function<std::string(const Trail&, const base::Snapshot&)> render,
                  std::function<void(std::optional<std::string>)> done);
  /// The mission that another life of the program left behind is offered no more.
  void forget_left_behind(Done done);
  /// From now on. @param fence null: none. @param done empty, or called when the robot holds it
  void use_fence(std::shared_ptr<const mission::Fence> fence, Done done = {});
  /// Any thread. What is to be kept out of beside the fence; see FenceKeeper.
  void keep_out(std::vector<mission::FenceArea> areas, std::string name);
  /// Any thread. So many of them do not hold: with the chosen fence's they are too many.
  std::size_t not_kept_out() const noexcept { return fence_.left_out(); }
  /// The way of the loaded mission, by the parameters as they are now. Conflict while it is in
  /// hand: it is done by itself when it is not any more.
  void lay_way_anew(Done done);
  /// The robot said so.
  void take(base::Event event);

 private:
  void beat();
  void publish();
  void answer(std::function<void()> work);
  Done answered(Done done);
  Done later(Done done);

  robot::Robot& robot_;
  Desk desk_;
  std::unique_ptr<store::Store> store_;
  Ears ears_;
  base::Latest<View> view_;
  base::Time saved_{};
  std::vector<robot::MissionEdit> edits_;
  std::vector<robot::TeachWish> wishes_;

  Trail trail_;
  RunRecorder runs_;
  SlipRecorder slips_;
  FenceKeeper fence_;
  WayKeeper way_;
  RadioEdits radio_;
  std::unique_ptr<TeachIn> teach_;  ///< from start() on
};

}  // namespace roverd::services
