#pragma once
// Drives a way around what stands before a mission, and says when to ask for another one.
//
//   Idle ──a way is found──▶ Drives ──at its end──▶ Done: the mission goes on behind it
//     ▲                        │  ▲
//     └──── none any more ─────┘  └─ another one, from where the robot is: the view grew
//
// The way was found in the odometry's frame and is driven in the robot's: the two drift against
// each other slowly, and every answer is placed anew. Control thread; allocates when a way begins.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/geo.hpp"
#include "base/setting.hpp"
#include "nav/behave/trip.hpp"
#include "robot/guard/around.hpp"

namespace roverd::robot {

/// The found way as a trip drives it, in the robot's frame; empty: it only turns on the spot.
/// @param speed_mps at most @param from number of the place that it is driven from
std::vector<nav::Vertex> way_of(const AroundAnswer& answer, double speed_mps, std::size_t from = 0);

class Detour {
 public:
  static constexpr base::Duration kAskEvery = std::chrono::seconds(1);

  Detour(base::Setting<nav::PathParams> path, base::Setting<nav::BehaveParams> behave)
      : trip_(std::move(path), std::move(behave)) {}

  bool drives() const noexcept { return answer_ != nullptr; }
  /// What is driven led too near to something.
  bool stopped() const noexcept { return stopped_; }
  /// No question is open, and the last one was long enough ago.
  bool may_ask(base::Time now) const noexcept;
  /// @return the id of the question that is asked now
  std::uint64_t asks(base::Time now) noexcept;
  /// The places that are still to be driven, where `X_OL` is as given.
  std::vector<nav::around::Place> rest(const nav::sense::Pose2& local) const;

  /// Of the last question, and not long ago.
  bool answers(const AroundAnswer& answer, base::Time now) const noexcept;
  enum class Taken {
    Left,     ///< there is none, or what is driven is as good
    Useless,  ///< it would only turn on the spot, where it turned already
    Again,    ///< the one that is driven, begun anew where the robot is held
    Adopted,
    Begun
  };
  /// Such an answer. One that is only a turn is driven once at a place: what is seen then decides.
  Taken take(std::shared_ptr<const AroundAnswer> answer, const nav::Vehicle& vehicle,
             double speed_mps);
  nav::TrackOutput step(const nav::Vehicle& vehicle, double limit_mps, base::Time now, double dt_s);
  /// It stands before something on the way around.
  void interrupt(base::Time now) noexcept;
  /// It does so no more.
  void let_go() noexcept { held_ = false; }
  bool done() const noexcept { return trip_.state() == nav::Trip::State::There; }
  bool failed() const noexcept { return trip_.state() == nav::Trip::State::Failed; }
  /// While it drives: what it drives, and how the way goes on.
  const AroundAnswer& answer() const noexcept { return *answer_; }
  const nav::Path& path() const noexcept { return turns_ ? nowhere_ : trip_.path(); }
  double s_m() const noexcept { return turns_ ? 0.0 : trip_.s_m(); }
  /// It turns on the spot to drive on, and nothing holds it. Another way found meanwhile would
  /// begin at some heading of this turn, and lead nearer to what stands there than at its end.
  bool turns_onto() const noexcept { return drives() && !turns_ && !held_ && trip_.turns_onto(); }
  /// What it drives is a turn on the spot.
  bool turns() const noexcept { return drives() && turns_; }
  void reset() noexcept;
  /// For another way: where it turned on this one says nothing about what stands there.
  void begin_anew() noexcept;
  /// Nobody asked it to drive for a while: somebody else does something else.
  bool left_alone(base::Time now) const noexcept;

 private:
  bool worth(const AroundAnswer& answer, const std::vector<nav::Vertex>& way) const noexcept;
  bool same_way(const std::vector<nav::Vertex>& way) const noexcept;
  Taken turn(std::shared_ptr<const AroundAnswer> answer, const nav::Vehicle& vehicle);

  nav::Trip trip_;
  nav::Path nowhere_;
  bool turns_ = false;
  std::optional<base::EnuPoint> turned_at_;  ///< it drove no way since
  std::shared_ptr<const AroundAnswer> answer_;
  std::uint64_t asked_ = 0;
  bool open_ = false;
  bool stopped_ = false;  ///< by what stands on the way around, since it was taken
  bool held_ = false;     ///< and is so now
  base::Time asked_at_{};
  base::Time stepped_at_{};
};

}  // namespace roverd::robot
