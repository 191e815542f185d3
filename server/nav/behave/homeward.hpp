#pragma once
// RTL and SMART_RTL: to home, or to the rally point that can be reached.
//
//   Enter: armed, position known, a home. RTL: the straight way lies inside the fence, else the
//          nearest rally point whose way does. SMART_RTL: breadcrumbs without a long gap.
//
//   Idle ──begin──▶ Driving ──stands at home──▶ Home (HOLD follows)
//                      └──missed, stuck, lost──▶ Failed (HOLD follows)
//
//   Exit: any other mode; a condition that holds; the fence. Begun again, SMART_RTL goes on from
//         the crumbs that are left: those behind it were forgotten on the way.
// Control thread.

#include <optional>
#include <span>
#include <string>

#include "nav/behave/trip.hpp"

namespace roverd::nav {

class Homeward {
 public:
  enum class State { Idle, Driving, Home, Failed };

  Homeward(const PathParams& path, const BehaveParams& behave) : path_(path), trip_(path, behave) {}
  void use(const PathParams& path, const BehaveParams& behave) {
    path_ = path;
    trip_.use(path, behave);
  }

  /// @param way to be driven in order; the last one is home. Corners are rounded.
  void begin(std::span<const EnuPoint> way, const Vehicle& vehicle) {
    Trip::Order order;
    order.way.reserve(way.size());
    const double speed_mps = std::min(path_.speed.default_mps, path_.speed.max_mps);
    for (const EnuPoint& p : way) {
      order.way.push_back(
          {p, speed_mps, false, false, mission::Turn::Auto, path_.track.corner_deviation_m});
    }
    trip_.begin(std::move(order), vehicle, false);
    state_ = State::Driving;
  }
  void reset() noexcept {
    trip_.reset();
    state_ = State::Idle;
  }
  void interrupt() noexcept { trip_.interrupt(); }

  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s) {
    if (state_ != State::Driving) return {};
    const TrackOutput out = trip_.step(vehicle, limit_mps, dt_s);
    if (trip_.state() == Trip::State::There) state_ = State::Home;
    if (trip_.state() == Trip::State::Failed) state_ = State::Failed;
    return out;
  }

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return trip_.reason(); }
  const Trip& trip() const noexcept { return trip_; }

 private:
  PathParams path_;
  Trip trip_;
  State state_ = State::Idle;
};

}  // namespace roverd::nav
