#pragma once
// The guided calibration drive: a figure of its own, after which the robot stands about where it
// began. It only drives and measures; what is made of it is somebody else's word.
//
//   turns on the spot                    steered
//
//     ──────straight──────▶ ⟲              ──────straight──────╮      then the same to the right
//    ⟲ ◀─────straight──────                ╰─────straight──────╯
//
//   Idle ──begin──▶ Running ──figure driven──▶ Done
//                      └──ended, left its space, does not follow──▶ Failed
//
// Straights are begun with the acceleration that is set and ended by the word to stand: that shows
// the brakes. On some of them it weaves a little and changes its speed: that shows the delays.
//
//   Enter: armed, position and heading certain, the whole figure inside the fence, level ground.
//   Exit: any other mode or goal; a condition that holds or slows; the radio; its space.
// Control thread; no allocation but for the reason.

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "base/calibration.hpp"
#include "base/setting.hpp"
#include "nav/behave/rotate_in_place.hpp"
#include "nav/calibrate/calibration_meter.hpp"

namespace roverd::nav {

/// What the figure of this kind needs, the way to stop by half of the set brakes included. Pure.
base::CalibrationSpace calibration_space(base::CalibrationKind kind,
                                         const PathParams& set) noexcept;
/// The speed of its straights; a limit below it spoils what is measured.
double calibration_mps(const PathParams& set) noexcept;
/// How long the figure takes.
double calibration_seconds(base::CalibrationKind kind, const PathParams& set);

class Calibrate {
 public:
  enum class State { Idle, Running, Done, Failed, Ended };

  explicit Calibrate(base::Setting<PathParams> path) : path_(std::move(path)) {}

  /// @param set as the parameters say, whatever was learned
  void begin(base::CalibrationKind kind, const Vehicle& vehicle, const CalibrationBefore& before,
             const PathParams& set);
  /// Somebody or something else ends it. Nothing if it does not run.
  void end(std::string why);
  /// What it came to is dropped.
  void drop() noexcept { state_ = State::Idle; }

  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s);
  // The measuring, before deciding and after it; once a tick while it runs.
  void see(const CalibrationSight& sight) noexcept { meter_.see(sight); }
  void sent(const base::BodyTwist& twist) noexcept { meter_.sent(twist); }

  State state() const noexcept { return state_; }
  bool running() const noexcept { return state_ == State::Running; }
  const std::string& reason() const noexcept { return reason_; }
  base::CalibrationKind kind() const noexcept { return kind_; }
  /// Left of the figure.
  double left_s() const noexcept;
  base::CalibrationState tell() const;

 private:
  enum class Do { Rest, Straight, Turn, Bend };
  enum class Wave { None, Turn, Speed };
  struct Op {
    Do what = Do::Rest;
    double value = 0.0;  ///< Rest: s; Turn, Bend: rad, left positive
    bool back = false;   ///< Straight: towards where it began
    Wave wave = Wave::None;
  };

  void plan(base::CalibrationKind kind) noexcept;
  void add(Op op) noexcept;
  void next() noexcept;
  TrackOutput fail(std::string why);
  double seconds_of(const Op& op) const noexcept;
  bool inside(const Vehicle& v) const noexcept;
  TrackOutput rest();
  TrackOutput straight(const Vehicle& v, double dt_s);
  TrackOutput turn(const Vehicle& v, double dt_s);
  TrackOutput bend(const Vehicle& v, double dt_s);
  void stopped(const Vehicle& v) noexcept;
  double wave_radps() const noexcept;

  base::Setting<PathParams> path_;
  PathParams set_;
  CalibrationMeter meter_;
  RotateInPlace rotation_;
  base::CalibrationKind kind_ = base::CalibrationKind::Drive;
  base::CalibrationSpace space_;
  State state_ = State::Idle;
  std::string reason_;
  std::uint64_t id_ = 0;

  static constexpr std::size_t kMostOps = 24;
  std::array<Op, kMostOps> ops_{};
  std::size_t count_ = 0;
  std::size_t at_ = 0;
  bool fresh_ = true;  ///< the operation has not begun

  EnuPoint start_;
  double yaw_rad_ = 0.0;   ///< of the first straight
  double far_m_ = 0.0;     ///< length of a straight
  double stop_m_ = 0.0;    ///< way from the word to stand until it stands
  double radius_m_ = 0.0;  ///< of bends
  double clock_s_ = 0.0;   ///< of the operation
  double still_s_ = 0.0;
  double wave_s_ = 0.0;
  EnuPoint from_;           ///< of the straight
  double speed_mps_ = 0.0;  ///< told, over ground
  double rate_radps_ = 0.0;
  bool ramping_ = false;
  bool stopping_ = false;
  bool tells_speed_ = true;
  EnuPoint stop_from_;
  double bent_rad_ = 0.0;
  double bent_yaw_rad_ = 0.0;
};

}  // namespace roverd::nav
