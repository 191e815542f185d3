#pragma once
// Drives ways that are laid anew while it drives: the tracker (nav/track/tracker.hpp) in the
// odometry's frame O, without any satellite.
//
//   Idle ──way──▶ Driving ──its end is reached, no newer way──▶ Ended ──way──▶ Driving
//     └──a way that ends where it stands──▶ Ended
//
// A newer way replaces the one that is driven, without a stop. Within a rounded corner the old one
// is kept until it is behind: both lie on the same ground, and half a corner cannot be laid anew.
// Control thread, or whoever steps it; allocates when it takes a way.

#include <memory>
#include <utility>

#include "base/setting.hpp"
#include "nav/marks/ways.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav::marks {

class SightDrive {
 public:
  enum class State { Idle, Driving, Ended };

  explicit SightDrive(base::Setting<PathParams> params)
      : params_(std::move(params)), tracker_(params_) {}

  /// @return false: it keeps to the way that it drives, for a corner; or stands, for the way ends
  /// here.
  bool take(const Way& way);
  /// @param vehicle in O
  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s) noexcept;
  void reset() noexcept;

  State state() const noexcept { return state_; }
  WayEnd end() const noexcept { return end_; }
  double cross_track_m() const noexcept { return tracker_.cross_track_m(); }
  /// To the end of what is laid.
  double left_m() const noexcept;
  const Path* path() const noexcept { return path_.get(); }

 private:
  bool in_corner() const noexcept;
  void stand(WayEnd end) noexcept;

  base::Setting<PathParams> params_;
  Tracker tracker_;
  std::shared_ptr<const Path> path_;
  std::vector<std::size_t> corners_;
  WayEnd end_ = WayEnd::Horizon;
  State state_ = State::Idle;
};

}  // namespace roverd::nav::marks
