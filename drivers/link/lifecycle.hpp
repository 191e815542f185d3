#pragma once
// The small machine every driver is, without what it drives:
//
//        start            heard                 lost, silent, refused
//   Down ─────▶ Opening ─────────▶ Up ──────────────────────────────▶ Faulty
//     ▲            │ ▲                                                   │
//     │            │ └──────────────── back-off over ────────────────────┤
//     │            └───── open failed, silent ───────────────────────────▶
//     └── stop, from anywhere
//
// The back-off doubles from first_s to max_s and starts anew once the driver was Up.
// Not thread-safe: device thread. Time is an argument.

#include <algorithm>
#include <string>
#include <utility>

#include "base/measurements.hpp"
#include "base/time.hpp"

namespace roverd::link {

class Lifecycle {
 public:
  using Phase = base::DriverPhase;

  /// Status is repeated this often without a change.
  static constexpr base::Duration kReportPeriod = std::chrono::milliseconds(500);

  Lifecycle(double first_s, double max_s) : first_s_(first_s), max_s_(max_s), wait_s_(first_s) {}

  Phase phase() const noexcept { return phase_; }
  /// Why it is not up; empty when up.
  const std::string& reason() const noexcept { return reason_; }

  void down() {
    wait_s_ = first_s_;
    enter(Phase::Down, "");
  }
  void opening(std::string reason) { enter(Phase::Opening, std::move(reason)); }
  void up() {
    wait_s_ = first_s_;
    enter(Phase::Up, "");
  }
  void faulty(std::string reason, base::Time now) {
    retry_at_ = now + base::from_seconds(wait_s_);
    wait_s_ = std::min(wait_s_ * 2.0, max_s_);
    enter(Phase::Faulty, std::move(reason));
  }

  /// Faulty, and the back-off is over.
  bool retry_due(base::Time now) const noexcept {
    return phase_ == Phase::Faulty && now >= retry_at_;
  }

  /// True after a change, and every kReportPeriod; the caller then reports.
  bool report_due(base::Time now) noexcept {
    if (!changed_ && now < next_report_) return false;
    changed_ = false;
    next_report_ = now + kReportPeriod;
    return true;
  }

 private:
  void enter(Phase phase, std::string reason) {
    changed_ = changed_ || phase != phase_ || reason != reason_;
    phase_ = phase;
    reason_ = std::move(reason);
  }

  const double first_s_;
  const double max_s_;
  double wait_s_;
  Phase phase_ = Phase::Down;
  std::string reason_;
  base::Time retry_at_{};
  base::Time next_report_{};
  bool changed_ = true;
};

}  // namespace roverd::link
