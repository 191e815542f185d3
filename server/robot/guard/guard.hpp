#pragma once
// The last word on moving where the robot sees: nothing is touched. Holds for every mode that
// moves, sticks included.
//
//   Free ──something on the commanded curve──▶ Slowed ──too near to drive on──▶ Stopped
//     ▲                                          │                                │ the way has
//     └────────── the way is clear ──────────────┴────────────────────────────────┘ been clear for
//                                                                                   clear_s
// While it stops an autonomous drive it looks along the curve that was wanted last. Without any
// sensor in the profile it lets everything pass. A picture that is too old is none: what was seen
// then is not believed any more, and the creep speeds of what no sensor sees hold.
//
// Where the stop by counted rays (nav/sense/rays_rule.hpp) is enabled, it slows and stops whatever
// drives ahead, too; or alone, and then the curve is not looked along. What the rays of a sensor
// said that is lost (RaysStop::lost) is driven into as ground that nobody has seen, by what looks
// along the curve; where that is not looked along, not before another sensor has seen it free. It
// knows no dock: while who docks is within sense.protect.dock_m of it, the curve alone is looked
// along.
//
// Control thread; allocates for the sentence of a stop only.

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/measurements.hpp"
#include "base/sensing.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/odometry.hpp"
#include "nav/sense/params.hpp"
#include "nav/sense/protect.hpp"
#include "nav/sense/skid.hpp"
#include "nav/sense/trailer.hpp"
#include "nav/track/params.hpp"
#include "robot/guard/blocked.hpp"
#include "robot/guard/outline.hpp"
#include "robot/guard/surroundings.hpp"

namespace roverd::robot {

class Guard {
 public:
  /// Before the first tick, where the profile has sensors. @param demands one of them at least
  void set(const nav::sense::ProtectParams& params, const nav::VehicleParams& vehicle, bool demands,
           const BlockedParams& blocked = {}, const nav::ToolParams& tool = {},
           const OutlineParams& outline = {}, const nav::sense::RaysParams& rays = {});
  /// Between two ticks: other figures, for the same body and sensors. What stops it goes on to.
  void change(const nav::sense::ProtectParams& params, const BlockedParams& blocked,
              const nav::sense::RaysParams& rays);
  bool sees() const noexcept { return sees_; }
  bool demands() const noexcept { return demands_; }
  /// Once a tick: braking that is known to be there; what was set bounds it.
  void brake_by(double decel_mps2) noexcept;
  /// What the sensors saw last is older than it may be.
  bool too_old(base::Time now) const noexcept;

  /// @return what it replaces, for somebody else to free
  std::shared_ptr<const Surroundings> take(std::shared_ptr<const Surroundings> news) noexcept;
  /// Once a tick: how the body moved. @param measured over ground. @param lean empty: level
  /// @param left_mps of its origin, to its left; 1 m/s at most is believed
  const nav::sense::Odometry& move(const base::BodyTwist& measured, base::Time now,
                                   const std::optional<base::Attitude>& lean = {},
                                   double left_mps = 0.0) noexcept;

  const nav::sense::Odometry& odometry() const noexcept { return odometry_; }

  /// What may leave of a wanted twist. @param by_itself nobody's hand is on it: after a stop it
  /// waits until the way has been clear for a while
  base::BodyTwist judge(const base::BodyTwist& wanted, bool by_itself, base::Time now);
  /// A hand that holds the guard off: the wanted twist where the guard would let it pass, else as
  /// much of it as it lets, but at least that at which no corner moves faster than
  /// sense.protect.override_mps. Never for what drives by itself.
  base::BodyTwist overrule(const base::BodyTwist& wanted, base::Time now);
  /// It stops a drive: the drive is not asked any more until may_go_on().
  bool stops() const noexcept { return stopped_since_.has_value(); }
  /// While it stops: looks along the curve that was wanted last. Now and then the drive is to be
  /// asked anew, for it may want to go elsewhere by now: then this is true as well, and judge()
  /// holds what it wants.
  bool may_go_on(base::Time now);
  /// Once a tick, after those two. @param by_itself nobody's hand drives
  /// @return what is to become of a drive that has been stopped for too long; told once
  std::optional<Then> decide(bool by_itself, base::Time now) noexcept;
  /// For the control thread: a way around what stands there is wanted (blocked.hpp).
  bool wants_around() const noexcept { return blocked_.wants_around(); }
  bool blocked() const noexcept { return blocked_.blocked(); }
  const BlockedParams& when_blocked() const noexcept { return blocked_.params(); }
  /// Why it stops, in words that stay while the reason does; empty: it does not.
  const std::string& why() const noexcept { return why_; }
  /// Once a tick, before the others: what stands at the dock is not in the way of who docks there,
  /// within sense.protect.dock_m. @param docked X_BD, where the body will stand; empty: it docks
  /// not
  /// @param reverse its tail is there
  void spare_dock(const std::optional<nav::sense::Pose2>& docked, bool reverse) noexcept;
  /// What the tracker should plan with, so that the last word need not cut.
  double limit_mps() const noexcept { return limit_mps_; }
  /// Somebody else begins: what was wanted before says nothing.
  void forget() noexcept;

  /// At each tick of a drive: it follows a way that was planned around what stands there.
  void follow(bool planned) noexcept { follows_ = planned; }
  base::Duration stopped_for(base::Time now) const noexcept {
    return stopped_since_ ? now - *stopped_since_ : base::Duration{};
  }
  const nav::sense::Footprint& body() const noexcept { return body_; }
  double side_m() const noexcept { return params_.side_m; }
  /// What nobody has seen is driven into by what drives by itself, slowly.
  bool creeps() const noexcept { return params_.creep_mps > 0.0; }
  bool creeps_back() const noexcept { return params_.creep_back_mps > 0.0; }

  const base::Obstacle& obstacle() const noexcept { return obstacle_; }
  /// It stopped just now, or let go; empty: neither. Told once.
  std::optional<bool> news() noexcept { return std::exchange(news_, std::nullopt); }
  const std::shared_ptr<const Surroundings>& around() const noexcept { return around_; }

 private:
  nav::sense::ProtectParams params_of(bool by_itself) const noexcept;
  struct Looked : nav::sense::Verdict {
    int rays = 0;           ///< not 0: it is they that limit,
    double within_m = 0.0;  ///< being shorter than this
    bool lost = false;      ///< what a sensor said that does not see any more
    bool trailer = false;   ///< it is what the trailer would touch
    bool moves = false;     ///< it is somebody who moves
    bool foreseen = false;  ///< before he is in the way
    bool may_turn = false;  ///< he does not come, but might
    double radius_m = 0.0;  ///< of whoever was foreseen, about `at`
  };
  Looked look(const base::BodyTwist& twist, bool by_itself, base::Time now) const noexcept;
  Looked look_where_lost(const base::BodyTwist& twist,
                         const nav::sense::ProtectParams& params) const noexcept;
  Looked told_by(const RaysStop& said, double within_m) const noexcept;
  void look_along_rays(Looked& v, const base::BodyTwist& twist,
                       const nav::sense::ProtectParams& params) const noexcept;
  void look_ahead_of_time(Looked& v, const base::BodyTwist& twist, bool by_itself,
                          const nav::sense::ProtectParams& params) const noexcept;
  void look_where_it_skids(Looked& v, const base::BodyTwist& twist,
                           const nav::sense::ProtectParams& params) const noexcept;
  void look_behind(Looked& v, const base::BodyTwist& twist,
                   const nav::sense::ProtectParams& params) const noexcept;
  void tell(const Looked& v, base::GuardAction action, base::Time now);
  double room_m(const Looked& v) const noexcept;

  bool clear_long_enough(base::Time now);

  bool sees_ = false;
  bool follows_ = false;
  bool demands_ = false;
  nav::sense::ProtectParams params_;
  nav::sense::RaysParams rays_;
  double decel_set_mps2_ = 0.6;
  std::optional<double> swings_m_;  ///< ahead of its front: turning on the spot; empty: it steers
  nav::sense::Footprint body_ = footprint_of({});
  std::optional<nav::sense::Trailer> trailer_;
  nav::sense::Coupling coupling_;
  std::optional<nav::sense::Footprint> whole_;  ///< with the trailer straight behind
  std::optional<nav::sense::Spared> spared_;
  std::shared_ptr<const Surroundings> around_;
  nav::sense::Odometry odometry_;
  nav::sense::Lately lately_;  ///< how it moves by that
  bool began_ = false;
  base::BodyTwist wanted_;
  base::BodyTwist held_;  ///< what was wanted when it was stopped last
  double limit_mps_ = 1e9;
  std::optional<base::Time> stopped_since_;
  std::optional<base::Time> clear_since_;
  base::Time asked_{};                        ///< the drive, while it stops
  std::optional<base::Time> wishless_since_;  ///< asked, it wants to stand
  std::optional<bool> news_;
  Blocked blocked_;
  std::string why_;
  std::string_view why_what_;
  std::optional<base::Time> limits_since_;
  bool limits_by_stop_ = false;
  base::Obstacle obstacle_;
};

}  // namespace roverd::robot
