#pragma once
// What of the estimate and the receiver an operator must find later: fix classes that last, jumps,
// inputs that are refused for long, the gyro's and the heading's coming and going, the anchor.
// Control thread; time is an argument.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/snapshot.hpp"

namespace roverd::robot {

using base::Time;

class EstimateWatch {
 public:
  static constexpr base::Duration kRefusedLasts = std::chrono::seconds(2);
  static constexpr base::Duration kFixLasts = std::chrono::seconds(1);

  struct News {
    base::Severity level = base::Severity::Info;
    const char* kind = "";
    std::string detail;
  };

  /// Once a tick. Valid until the next call.
  const std::vector<News>& step(const base::EstimatorHealth& health, base::FixType fix, Time now);
  /// An operator moved the estimate himself: that is no jump to tell of.
  void moved_on_purpose(const base::EstimatorHealth& health) noexcept { resets_ = health.resets; }
  /// He anchored it, or dropped the anchor.
  void anchored(bool is) noexcept { anchored_ = is; }
  /// At the last step the anchor was dropped by the estimator itself.
  /// Turns were measured by a gyro once, and are not now.
  bool gyro_lost() const noexcept { return gyro_known_ && !gyro_; }
  bool anchor_lost() const noexcept { return anchor_lost_; }

 private:
  void watch_fix(base::FixType fix, Time now);
  void watch_resets(const base::EstimatorHealth& health);
  void watch_refusals(const base::EstimatorHealth& health, Time now);
  void tell(base::Severity level, const char* kind, std::string detail) {
    news_.push_back({level, kind, std::move(detail)});
  }

  std::vector<News> news_;
  std::uint64_t resets_ = 0;
  bool gyro_ = false;
  bool gyro_known_ = false;
  bool anchored_ = false;
  bool anchor_lost_ = false;
  base::Alignment alignment_ = base::Alignment::Unknown;
  std::array<bool, 4> refusal_told_{};
  base::FixType fix_told_ = base::FixType::None;
  base::FixType fix_seen_ = base::FixType::None;
  Time fix_since_{};
};

/// One decimal, without its sign.
std::string tenths_of(double value);

}  // namespace roverd::robot
