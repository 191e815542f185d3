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
//      any but Docked, Failed ── interrupt() ──▶ Look, or Search where it was not seen yet
//
// On the line the way is laid anew with every image until straight_m are left; from then on it is
// kept but for its length. Docked is who stands within the tolerance by thrice of what is
// uncertain, the tag's direction included, which moves the pose sidewards; as long as more images
// may decide it, it stands and looks. Only images that were taken standing decide: what is seen
// while it drives lies aside by as much as the picture's moment is wrong. A tag whose direction is
// in doubt (two poses of it look alike) is never docked at. Frame O of the odometry: it needs no
// position and does not notice when that jumps. For vehicles that turn on the spot. Control thread;
// allocates when it lays a way.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/setting.hpp"
#include "nav/behave/trip.hpp"
#include "nav/tags/params.hpp"
#include "nav/tags/tag_book.hpp"

namespace roverd::nav::tags {

class TagDock {
 public:
  enum class State { Idle, Search, ToGate, Look, Line, Back, Docked, Failed };

  struct Order {
    int tag = 0;
    std::optional<double> stand_off_m{};  ///< empty: as the parameters say
  };

  TagDock(base::Setting<PathParams> path, base::Setting<BehaveParams> behave,
          base::Setting<TagDockParams> params);

  void begin(const Order& order, base::Time now);
  void reset() noexcept { state_ = State::Idle; }
  /// Somebody else drives, or something stands in the way; the next step goes on from wherever the
  /// robot is then.
  void interrupt() noexcept;
  /// @param vehicle as everywhere; its place and direction are taken from the sight
  TrackOutput step(const TagSight& sight, const Vehicle& vehicle, double limit_mps, double dt_s);

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return reason_; }  ///< why Failed
  /// Where the vehicle is to stand, in O; empty: the tag was not seen.
  std::optional<sense::Pose2> goal() const noexcept { return goal_; }
  /// It comes to the tag on its line, or stands before it: what stands there is the dock.
  bool on_line() const noexcept { return state_ == State::Line; }
  int tag() const noexcept { return order_.tag; }
  std::optional<double> distance_left_m() const noexcept;
  int tries() const noexcept { return tries_; }
  TrackPhase phase() const noexcept { return tracker_.phase(); }

 private:
  static PathParams careful(PathParams params);
  static PathParams on_the_way(const PathParams& said);
  void look(const TagSight& sight);
  void to_gate(const Vehicle& v);
  void lay_line(const Vehicle& v, bool first);
  void back(const Vehicle& v);
  struct Stand;
  Stand stand(const TagSight& sight, const Vehicle& v) const noexcept;
  void judge(const Stand& s, const Vehicle& v);
  void stands_anew(base::Time now) noexcept;
  std::string why_unseen(const TagSight& sight) const;
  void fail(std::string why);
  bool looked(double dt_s) noexcept;
  void step_look(const Vehicle& v, double dt_s);
  TrackOutput step_trip(const TagSight& sight, const Vehicle& v, double limit_mps, double dt_s);
  TrackOutput step_line(const TagSight& sight, const Vehicle& v, double limit_mps, double dt_s);
  double left_m(const Vehicle& v) const noexcept;

  base::Setting<PathParams> said_;  ///< as it drives everywhere
  base::Setting<PathParams> path_;  ///< as it drives here
  base::Setting<PathParams> way_;   ///< up to the gate
  base::Setting<TagDockParams> params_;
  Trip trip_;
  Tracker tracker_;
  std::shared_ptr<const Path> line_;
  sense::Pose2 line_end_;  ///< the goal, when its direction was laid
  Order order_;
  const TagTrack* track_ = nullptr;  ///< within one step only
  std::optional<sense::Pose2> goal_;
  std::optional<double> left_;
  base::Time seen_at_{};
  base::Time taken_{};  ///< the last image that was made use of
  bool news_ = false;
  bool again_ = false;  ///< it goes on: from here on the tag must be seen
  State state_ = State::Idle;
  double looked_s_ = 0.0;
  base::Time stood_at_{};  ///< since then it stands at the pose
  int sights_ = 0;         ///< of the tag, taken since
  double on_line_s_ = 0.0;
  int tries_ = 0;
  double late_m_ = 0.0;  ///< it stopped beyond the place, the tries before
  int gates_ = 0;
  int turns_ = 0;  ///< on the spot, at the pose
  std::string reason_;
};

std::string_view to_string(TagDock::State s) noexcept;

}  // namespace roverd::nav::tags
