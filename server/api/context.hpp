#pragma once
// What the handlers of the routes share. Web thread only.

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "api/access.hpp"
#include "api/api.hpp"
#include "api/audit.hpp"
#include "api/body.hpp"
#include "api/control.hpp"
#include "api/json/words.hpp"
#include "api/problem.hpp"
#include "api/router.hpp"
#include "api/validity.hpp"

namespace roverd::api {

/// Commands on their way to the robot and back. The robot answers with its next tick; if it does
/// not, the client hears 503, and what it asked for is refused as late by the robot itself.
class Commands {
 public:
  using Done = std::function<void(base::Result<void>)>;
  static constexpr std::size_t kWaiting = 64;
  static constexpr base::Duration kPatience = std::chrono::seconds(2);

  explicit Commands(robot::Robot& robot) : robot_(robot) {}

  /// `done` is called exactly once, later: with what the robot did, or Unavailable.
  /// @param validity the robot refuses it as late by that.
  void run(robot::Command command, const robot::Validity& validity, base::Time now, Done done);
  /// For what others than the robot answer: @return what to call with the answer, web thread. If
  /// nobody does until `give_up`, `done` hears Unavailable.
  Done expect(base::Time give_up, Done done);
  void sweep(base::Time now);
  /// Forgets them all, unanswered.
  void abandon() { waiting_.clear(); }

 private:
  struct Waiting {
    base::Time give_up;
    Done done;
  };
  void answer(std::uint64_t id, base::Result<void> result);

  robot::Robot& robot_;
  std::map<std::uint64_t, Waiting> waiting_;
  std::uint64_t next_ = 1;
  /// A reply may come when this is gone: it asks here first.
  std::shared_ptr<Commands*> self_ = std::make_shared<Commands*>(this);
};

/// What a piece of work reads or writes; a slow machine does 16 kB in well under 2 ms.
struct Effort {
  static constexpr std::size_t kAtOnce = 16 * 1024;
  static constexpr std::size_t kSmall = 256 * 1024;
  /// From here on, seconds: whole maps and sets of tiles. Missions do not wait behind them.
  static constexpr std::size_t kSlow = std::size_t{1} << 40U;
  std::size_t bytes = 0;
  bool must = false;  ///< something was changed already: it is not refused any more
};
/// Of a plan as text, about.
inline std::size_t bytes_of(const mission::Plan& plan) noexcept {
  return plan.items.size() * 100;
}

struct Context {
  explicit Context(Deps with)
      : deps(std::move(with)),
        access(deps.people, deps.tls),
        control(access, deps.control_grace),
        audit([this](people::Deed deed) { deps.store.add_deed(std::move(deed)); }),
        commands(deps.robot),
        begun(base::steady_now()) {}

  Deps deps;
  Access access;
  Control control;
  Audit audit;
  Commands commands;
  Router router;
  base::Time begun;
  /// Passwords and PINs that are being hashed; log_in.hpp bounds them.
  std::shared_ptr<std::atomic<int>> hashing = std::make_shared<std::atomic<int>>(0);
  std::map<std::string, double> driver_rates;
  std::string openapi_tag;
  std::function<void(const std::string& id, std::optional<std::int64_t> revision)>
      on_mission_change;
  /// Sessions, tokens or roles changed: who lost a right loses the stream.
  std::function<void()> on_access_change;
  /// Makes the one-time code of the first admin, and tells it.
  void tell_code() const {
    const std::string code = access.book().make_code();
    if (deps.tell_code) deps.tell_code(code);
  }
  std::shared_ptr<const store::StoredFence> fence;  ///< the active one; null: none
  /// What the check found when the loaded mission was loaded.
  struct Warnings {
    std::string mission_id;
    std::int64_t revision = 0;
    Json list = Json::array();
  };
  Warnings warnings{};

  /// As the robot was told last.
  std::vector<base::KnownPlace> known_places{};

  /// Parameters that were changed for the next start, since this one.
  std::map<std::string, base::ParamValue> kept{};

  /// The vehicle as the parameters say it is now.
  Profile profile() const;
  /// The refusal of a call that acts on the robot, of whom control is not held by now.
  std::optional<Response> without_control(const Call& call) const;
  /// Where the map of that name lies: as the robot drives by it where it is in use, else by its
  /// anchor. Empty: there is none, or nobody knows.
  std::optional<base::MapLies> lies_of(const std::string& map) const;
  /// The whole state, with what the robot does not know of itself.
  Json vehicle(const base::Snapshot& snapshot, base::Time now) const;
  /// The mission that another life of the program left behind, if nothing else is in hand: what the
  /// services say of it is older than the snapshot by up to their beat.
  std::optional<store::StoredPlace> offer(const base::Snapshot& snapshot) const;
  /// What the sensors see; null: nothing yet, or there are none.
  std::shared_ptr<const robot::Outlook> outlook() const {
    return deps.outlook ? deps.outlook() : nullptr;
  }
  /// Answers 503 and returns null before the robot's first tick.
  std::shared_ptr<const base::Snapshot> snapshot_or_refuse(const CallPtr& call) const;
  /// What costs much leaves the web thread: `work` gives a value and touches nothing that others
  /// change; what it holds is freed there, too. Then `then(value)` on this thread. What costs
  /// little is done at once. Where there is no room the caller hears 503 and nothing was done.
  template <class Work, class Then>
  void aside(const CallPtr& call, Effort effort, Work work, Then then) const;
  /// The same, and the value is the answer.
  template <class Work>
  void answer_aside(const CallPtr& call, Effort effort, Work work) const {
    aside(call, effort, std::move(work),
          [call](Response response) { call->respond(std::move(response)); });
  }
  /// Frees what is large beside the web thread.
  void when_estop_kept(std::function<void()> then) const {
    return deps.when_estop_kept ? deps.when_estop_kept(std::move(then)) : then();
  }
  template <class T>
  void discard(T large) const {
    if (!deps.aside) return;
    auto held = std::make_shared<T>(std::move(large));
    deps.aside({.work = [held = std::move(held)] {}, .must = true});
  }
  /// A stored mission changed: tells the stream. @param revision empty: deleted.
  void announce(const std::string& id, std::optional<std::int64_t> revision) const;

 private:
  void go_aside(const CallPtr& call, Effort effort, std::function<void()> work,
                std::function<bool()> then) const;
};
using ContextPtr = std::shared_ptr<Context>;

template <class Work, class Then>
void Context::aside(const CallPtr& call, Effort effort, Work work, Then then) const {
  using Value = std::invoke_result_t<Work&>;
  struct Shared {
    std::optional<Work> work;
    Then then;
    std::optional<Value> made{};
  };
  auto shared = std::make_shared<Shared>(Shared{std::move(work), std::move(then)});
  go_aside(
      call, effort,
      [shared] {
        struct Freed {  // here, also when it fails
          std::optional<Work>& work;
          ~Freed() { work.reset(); }
        } const freed{shared->work};
        shared->made.emplace((*shared->work)());
      },
      [shared] {
        if (!shared->made) return false;
        shared->then(std::move(*shared->made));
        return true;
      });
}

void add_vehicle_routes(const ContextPtr& context);
void add_map_routes(const ContextPtr& context);
void add_place_routes(const ContextPtr& context);
void add_calibration_routes(const ContextPtr& context);
void add_execution_routes(const ContextPtr& context);
void add_mission_routes(const ContextPtr& context);
void add_operation_routes(const ContextPtr& context);
void add_rows_routes(const ContextPtr& context);
void add_survey_routes(const ContextPtr& context);
void add_check_routes(const ContextPtr& context);
void add_fence_routes(const ContextPtr& context);
/// Asks the store which fence is active; until it answers there is none.
void load_active_fence(const ContextPtr& context);
void add_file_routes(const ContextPtr& context);
void add_event_routes(const ContextPtr& context);
void add_camera_routes(const ContextPtr& context);
void add_sensor_routes(const ContextPtr& context);
void add_known_place_routes(const ContextPtr& context);
void add_slip_routes(const ContextPtr& context);
void add_server_routes(const ContextPtr& context);
void add_driver_routes(const ContextPtr& context);
void add_teach_routes(const ContextPtr& context);
void add_route_routes(const ContextPtr& context);
void add_way_routes(const ContextPtr& context);
void add_tile_routes(const ContextPtr& context);
void add_drive_routes(const ContextPtr& context);
void add_run_routes(const ContextPtr& context);
void add_parameter_routes(const ContextPtr& context);
void add_drill_routes(const ContextPtr& context);
void add_session_routes(const ContextPtr& context);
void add_device_routes(const ContextPtr& context);
void add_token_routes(const ContextPtr& context);
void add_user_routes(const ContextPtr& context);
void add_control_routes(const ContextPtr& context);
void add_audit_routes(const ContextPtr& context);
/// Asks the store who may come in; until it answers nobody may.
void load_people(const ContextPtr& context);

/// Whether this very call acts on the robot, so that control must be held. What cannot be read acts
/// on nothing: its handler says what is wrong.
bool acts(const Context& context, const Route& route, const Call& call);

/// Runs a command and answers with what `state` makes of the snapshot, or with the refusal.
void run_command(const ContextPtr& context, const CallPtr& call, robot::Command command,
                 const robot::Validity& validity, std::function<Json(const base::Snapshot&)> state);

}  // namespace roverd::api
