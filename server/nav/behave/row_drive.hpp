#pragma once
// Along a row by what is seen of it (nav/rows), in the frame O of the odometry: it needs no
// satellites and does not notice when the position jumps.
//
//   Idle ──begin──▶ Seeking ──a row is sure──▶ Driving ──stands at its end, or as far as it was
//                     │  ▲                      │  │ ▲                         asked──▶ Done
//                     │  └ row lost, not far ───┘  │ └─ seen again
//                     └─ none within entry_m ─▶ Failed ◀─ stands without one for wait_s
//
// With every look the way is laid anew: an arc of the length over which the row is known. Its end
// is a stop, so a view that grows old or vague brakes the robot in time. Seeking it creeps straight
// on from where it began, also towards a row that is seen, but not surely yet. Speed falls with the
// certainty. Control thread; no allocation after construction.

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "base/params.hpp"
#include "base/setting.hpp"
#include "nav/rows/view.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {

/// Section [nav.row].
struct RowDriveParams {
  double speed_mps = 0.6;
  double creep_mps = 0.2;
  double entry_m = 3.0;
  double horizon_m = 4.0;
  double sure_m = 0.06;
  double unsure_m = 0.16;
  double old_s = 0.5;
  double wait_s = 5.0;
};

template <class V>
void fields(V& v, RowDriveParams& p) {
  v("speed_mps", p.speed_mps, 0.05, 3.0, "along a row whose item says no speed");
  v("creep_mps", p.creep_mps, 0.05, 1.0, "towards a row that is not seen yet, or hardly");
  v("entry_m", p.entry_m, 0.0, 20.0, "so far it creeps straight on until it sees the row");
  v("horizon_m", p.horizon_m, 1.0, 10.0, "the way is laid so far ahead");
  v("sure_m", p.sure_m, 0.01, 1.0, "1 sigma of the row 1.5 m ahead: full speed up to here");
  v("unsure_m", p.unsure_m, 0.02, 2.0,
    base::lower_is_stricter("where the row is known no better than this, it is not driven"));
  v("old_s", p.old_s, 0.1, 3.0, base::lower_is_stricter("an older view of the row stops it"));
  v("wait_s", p.wait_s, 0.0, 600.0, "standing without a row for so long, the item has failed");
}

/// What is known of the row at one tick.
struct RowSight {
  const rows::RowView* view = nullptr;  ///< null: none is seen
  double age_s = 0.0;                   ///< of the view
  rows::Pose2 body;                     ///< X_OB now
};

class RowDrive {
 public:
  enum class State { Idle, Seeking, Driving, Done, Failed };
  static constexpr double kLook_m = 1.5;  ///< so far ahead the row's certainty counts

  RowDrive(base::Setting<PathParams> path, base::Setting<RowDriveParams> params)
      : path_params_(path), params_(std::move(params)), tracker_(std::move(path)) {
    for (Path& p : paths_) {
      p.points.reserve(kMostPoints);
      p.legs.reserve(1);
    }
  }

  struct Order {
    std::optional<double> speed_mps{};
    std::optional<double> distance_m{};  ///< done after so much way along the row; empty: its end
    /// Likewise at the latest beside this place of O.
    std::optional<rows::Pose2> place{};
    double driven_m = 0.0;  ///< of an item that was interrupted: so much is done already
  };
  void begin(const Order& order) noexcept;
  void reset() noexcept;
  /// Somebody else drives; the next step goes on from wherever the robot is then.
  void interrupt() noexcept;
  /// It ends at the latest beside this place of O, as it is known by now.
  void end_beside(const rows::Pose2& place) noexcept { order_.place = place; }

  /// @param vehicle as everywhere; its place and direction are taken from the sight.
  TrackOutput step(const RowSight& sight, const Vehicle& vehicle, double limit_mps, double dt_s);

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return reason_; }  ///< why Failed
  double driven_m() const noexcept { return driven_m_; }          ///< along the row, as it was seen
  /// Positive: the vehicle is left of the line. Empty where the line is not known well enough
  /// beside it: before the first plants it is what was made of those that stand ahead.
  std::optional<double> cross_track_m() const noexcept {
    return beside_ ? std::optional(tracker_.cross_track_m()) : std::nullopt;
  }
  TrackPhase phase() const noexcept { return tracker_.phase(); }
  /// It stands because nothing certain is seen.
  bool waits() const noexcept { return waited_s_ > 0.0; }
  std::optional<double> left_m() const noexcept { return left_m_; }
  /// 1: the row is as sure as full speed needs; 0: so unsure that it stands. @param sigma_m of
  /// where the line lies kLook_m ahead, 1 sigma
  double certainty(double sigma_m) const noexcept;

 private:
  static constexpr std::size_t kMostPoints = 64;
  bool usable(const RowSight& sight) const noexcept;
  bool sure(const rows::RowView& view, const rows::Along& at) const noexcept;
  double wanted_mps(const rows::RowView& view, double s_m) const noexcept;
  void lay(const rows::Pose2& from, double curvature_1pm, double begin_m, double end_m,
           double speed_mps, double at_m);
  void seek(const RowSight& sight);
  void follow(const RowSight& sight, const rows::Along& at, const Vehicle& v);
  void brake(const RowSight& sight, const Vehicle& v);
  void fail(std::string why);

  base::Setting<PathParams> path_params_;
  base::Setting<RowDriveParams> params_;
  Tracker tracker_;
  std::array<Path, 2> paths_;
  std::size_t slot_ = 0;
  State state_ = State::Idle;
  std::string reason_;
  Order order_;
  std::optional<rows::Pose2> began_;  ///< X_OB from where the way leads that looks for it
  std::optional<rows::Pose2> last_;   ///< X_OB of the last step
  std::optional<double> left_m_;
  std::optional<base::Time> laid_;  ///< by the view of this time
  rows::Pose2 line_;                ///< of the way in hand
  double curvature_1pm_ = 0.0;
  double driven_m_ = 0.0;
  double waited_s_ = 0.0;
  bool beside_ = false;   ///< the line is known where the vehicle is
  bool at_end_ = false;   ///< the way that is laid ends where the item does
  bool goes_on_ = false;  ///< it is one to drive, none to brake along
};

}  // namespace roverd::nav
