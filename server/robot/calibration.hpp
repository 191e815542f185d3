#pragma once
// When a guided calibration drive may begin, and what of it is kept.
//
//   none ──begin──▶ running ──driven──▶ done ──keep──▶ in use, and in the file for 90 days
//                      │                 └──discard──▶ none
//                      └──anything ends it──▶ failed, aborted: nothing is changed
//
// What was kept is told to the file with its age, until a later life of the program recalls it or a
// person forgets it. Control thread, but for the pure parts.

#include <optional>
#include <string>

#include "base/snapshot.hpp"
#include "nav/calibrate/calibrate.hpp"
#include "nav/estimate/learned.hpp"
#include "robot/safety/fence_guard.hpp"

namespace roverd::robot {

struct CalibrationFacts {
  base::CalibrationKind kind = base::CalibrationKind::Drive;
  const std::optional<base::Pose>& pose;
  const LaidFence* fence = nullptr;  ///< of the pose's frame; null: none
  double margin_m = 0.0;             ///< that the body's origin keeps from the fence
  const nav::PathParams& path;
  bool compass = false;   ///< heard
  bool antennas = false;  ///< likewise
  bool steep = false;     ///< it may not turn on the spot where it stands
};

/// Why the figure cannot be driven from here, whatever else holds the robot; empty: it can.
std::string calibration_refusal(const CalibrationFacts& facts);

/// The corners of its space on the ground, around.
std::array<base::EnuPoint, 4> calibration_corners(const base::CalibrationSpace& space,
                                                  const base::Pose& pose) noexcept;

/// What of a drive that is done can be kept: measured, and within what a vehicle can have. The zero
/// of steered wheels is the bend of a straight command, which every command is corrected by.
nav::Learned learned_by(const base::CalibrationState& done, double wheelbase_m) noexcept;
/// The antennas' offset likewise.
std::optional<double> antennas_offset_by(const base::CalibrationState& done) noexcept;

/// What a person said is to be kept.
class KeptCalibration {
 public:
  void keep(const nav::Learned& learned, base::Time now) noexcept;
  /// Another life of this program kept it.
  void recall(const nav::Learned& known) noexcept { recalled_ = known; }
  void forget() noexcept;
  bool any() const noexcept { return anything(kept_) || anything(recalled_); }
  /// Something in use was measured by a calibration drive: only that tells turns.
  bool measured() const noexcept {
    return anything(kept_) || recalled_.yaw_scale || recalled_.pull_1pm;
  }
  /// Adds what nobody learned since, with its age.
  void tell(nav::Learned& known, base::Time now) const noexcept;

 private:
  static bool anything(const nav::Learned& l) noexcept;

  nav::Learned kept_;
  nav::Learned recalled_;
  base::Time when_{};
  bool forgotten_ = false;
};

}  // namespace roverd::robot
