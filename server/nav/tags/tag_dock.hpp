#pragma once
// DOCK at a tag: to a place straight before it, by sight alone, in the odometry's frame O.
//
//      tag ◀─ stand_off ─ pose ◀── straight_m: as it points ── line ── gate ◀── way to the gate
//
//   Search ──seen──▶ ToGate ──stands there, faces the tag──▶ Look ──look_s──▶ Line ──stands──▶
//   Judge
//                      ▲                                                                       │
//                      └── Back ◀── outside of the tolerance, first and second time ───────────┤
//                                                          within it──▶ Docked                 │
//      any ── unseen for lost_s, stuck ──▶ Failed ◀────────third time──────────────────────────┘
//
// On the line the way is laid anew with every image until straight_m are left; from then on it is
// kept. For vehicles that turn on the spot. Control thread; allocates when it lays a way.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/setting.hpp"
#include "nav/behave/trip.hpp"
#include "nav/tags/params.hpp"
#include "nav/tags/tag_track.hpp"

namespace roverd::nav::tags {

class TagDock {
 public:
  enum class State { Search, ToGate, Look, Line, Back, Docked, Failed };

  TagDock(base::Setting<PathParams> path, base::Setting<BehaveParams> behave);

  void begin(base::Time now);
  /// A new image of the tag, after TagTrack::take.
  void see(const TagTrack& track);
  /// @param vehicle in O
  TrackOutput step(const Vehicle& vehicle, const TagDockParams& params, base::Time now,
                   double dt_s);

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return reason_; }  ///< why Failed
  /// Where the vehicle is to stand, in O; empty: the tag was not seen.
  std::optional<sense::Pose2> goal() const noexcept { return goal_; }
  int tries() const noexcept { return tries_; }

 private:
  static PathParams careful(PathParams params);
  void to_gate(const Vehicle& v, const TagDockParams& params);
  void lay_line(const Vehicle& v, const TagDockParams& params, bool first);
  void back(const Vehicle& v, const TagDockParams& params);
  void judge(const Vehicle& v, const TagDockParams& params);
  void fail(std::string why);
  TrackOutput on_line(const Vehicle& v, const TagDockParams& params, double dt_s);
  double left_m(const Vehicle& v) const noexcept;

  base::Setting<PathParams> path_;
  Trip trip_;
  Tracker tracker_;
  std::shared_ptr<const Path> line_;
  std::optional<sense::Pose2> tag_;
  std::optional<sense::Pose2> goal_;
  base::Time seen_at_{};
  bool news_ = false;
  State state_ = State::Search;
  double looked_s_ = 0.0;
  double on_line_s_ = 0.0;
  int tries_ = 0;
  int gates_ = 0;
  int turns_ = 0;  ///< on the spot, at the pose
  std::string reason_;
};

std::string_view to_string(TagDock::State s) noexcept;

}  // namespace roverd::nav::tags
