#pragma once
// FOLLOW: keeps behind, or beside, a moving target that tells where it is.
//
//   Enter: armed, position known, a target not older than it may be and not too far away.
//
//   Waiting ──target──▶ Following ──older than 1 s──▶ Braking ──target──▶ Following
//                                                       └──3 s──▶ Lost (HOLD follows)
//                       Following ──too far away──▶ Lost
//
//   Exit: any other mode; Lost; a condition that holds; the fence.
//
// The target is predicted for at most 1 s. Without an offset the robot follows its track at the gap
// D = gap_m + gap_s·v, at v = v_t + 0.5 (d − D), never backwards, and stands when it is nearer than
// stop_m. With an offset it goes to the place beside the target; the offset is fixed to north, or
// turns with the target's course, which is held while it hardly moves. A target that is more than
// 5 m ahead is followed where it went, not straight. One that jumps is not believed.
// Control thread; no allocation after construction.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/setting.hpp"
#include "base/time.hpp"
#include "nav/behave/ground.hpp"
#include "nav/behave/mode_params.hpp"

namespace roverd::nav {

/// As it was told.
struct FollowTarget {
  EnuPoint at;
  std::optional<EnuPoint> velocity_mps;  ///< east, north; empty: worked out from the positions
  base::Time stamp;
};

struct FollowOffset {
  enum class Frame { None, North, Course } frame = Frame::None;
  double a_m = 0.0;  ///< North: east. Course: forward
  double b_m = 0.0;  ///< North: north. Course: left
};

class Follow {
 public:
  enum class State { Waiting, Following, Braking, Lost };

  Follow(base::Setting<PathParams> path, base::Setting<ModeParams> modes)
      : path_(std::move(path)), modes_(std::move(modes)) {
    track_.reserve(kTrack);
  }

  /// Also while another mode drives. @return empty: taken. Else why it is not believed.
  std::string take(const FollowTarget& target, const FollowOffset& offset);
  /// Why FOLLOW cannot begin; empty: it can.
  std::string refusal(EnuPoint here, base::Time now) const;
  /// FOLLOW begins, or ends: what was driven is forgotten, the target is not.
  void reset() noexcept;

  TrackOutput step(const Vehicle& vehicle, double limit_mps, base::Time now, double dt_s);

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return reason_; }
  const std::optional<FollowTarget>& target() const noexcept { return target_; }
  double distance_m(EnuPoint here) const noexcept;

 private:
  static constexpr std::size_t kTrack = 400;

  EnuPoint predicted(base::Time now) const noexcept;
  EnuPoint aim(base::Time now) const noexcept;
  void lay_track(EnuPoint aim);
  EnuPoint ahead(const Vehicle& v, EnuPoint aim, double look_m, double& gap_m);
  TrackOutput stand(double dt_s) noexcept;
  TrackOutput command(const Vehicle& v, EnuPoint to, double wanted_mps, double dt_s) noexcept;

  base::Setting<PathParams> path_;
  base::Setting<ModeParams> modes_;
  std::optional<FollowTarget> target_;
  EnuPoint velocity_;
  double course_rad_ = 0.0;
  FollowOffset offset_;
  std::vector<EnuPoint> track_;  ///< where the aim was, oldest first
  State state_ = State::Waiting;
  std::string reason_;
  double speed_mps_ = 0.0;
  double rate_radps_ = 0.0;
  bool pivots_ = false;  ///< until it points there: else it would drive and turn by turns
};

}  // namespace roverd::nav
