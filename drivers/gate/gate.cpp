#include "gate/gate.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace roverd::gate {

namespace {

constexpr std::uint32_t kSystemState = 0x211;
constexpr std::uint32_t kMotionState = 0x221;
constexpr std::uint32_t kControlMode = 0x421;
constexpr std::uint8_t kNormal = 0;
constexpr std::uint8_t kStandby = 0;
constexpr std::uint8_t kCan = 1;

/// The base itself forgets a motion command after this long.
constexpr double kCommandLife_s = 0.5;

constexpr bool is_plain(const CanFrame& f) noexcept {
  return !f.extended && !f.remote && !f.error;
}

constexpr int value_at(const CanFrame& f, std::size_t at) noexcept {
  return static_cast<std::int16_t>((f.data[at] << 8U) | f.data[at + 1]);
}

constexpr bool all_zero(const CanFrame& f, std::size_t from) noexcept {
  for (std::size_t i = from; i < f.len; ++i) {
    if (f.data[i] != 0) return false;
  }
  return true;
}

/// How far `to` lies beyond `from`, away from zero. A change of sign counts from zero.
constexpr int growth(int from, int to) noexcept {
  const bool same_side = (from < 0) == (to < 0);
  const int start = same_side ? std::abs(from) : 0;
  return std::abs(to) - start;
}

}  // namespace

Gate::Gate(const Limits& limits) noexcept
    : must_arrive_{RxRule{kMotionState, 8, 0.02, limits.motion_max_age_s},
                   RxRule{kSystemState, 8, 0.2, limits.state_max_age_s}},
      values_{ValueRule{0, limits.max_linear, limits.max_linear_step},
              ValueRule{2, limits.max_angular, limits.max_angular_step}} {}

void Gate::saw(const CanFrame& frame, Time now) noexcept {
  if (!is_plain(frame)) return;
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < must_arrive_.size(); ++i) {
    if (frame.id != must_arrive_[i].id || frame.len < must_arrive_[i].len) continue;
    seen_[i] = now;
    if (frame.id == kSystemState) {
      vehicle_state_ = frame.data[0];
      control_mode_ = frame.data[1];
    }
  }
}

bool Gate::allows(const CanFrame& frame, Time now) noexcept {
  const std::lock_guard lock(mutex_);
  const Refusal refusal = check(frame, now);
  if (refusal != Refusal::None) {
    ++counts_.refused[static_cast<std::size_t>(refusal)];
    return false;
  }
  ++counts_.allowed;
  return true;
}

void Gate::permit(bool on) noexcept {
  const std::lock_guard lock(mutex_);
  permitted_ = on;
  if (on) return;
  seen_ = {};
  control_mode_ = 0xFF;
}

Refusal Gate::check(const CanFrame& frame, Time now) noexcept {
  const auto rule = std::find_if(kMayLeave.begin(), kMayLeave.end(),
                                 [&](const TxRule& r) { return r.id == frame.id; });
  if (rule == kMayLeave.end() || !is_plain(frame)) return Refusal::NotListed;
  if (frame.len != rule->len) return Refusal::WrongLength;
  return rule->payload == Payload::Motion ? check_motion(frame, now)
                                          : check_code(*rule, frame, now);
}

Refusal Gate::check_motion(const CanFrame& frame, Time now) noexcept {
  const bool running = last_motion_ && base::seconds(now - *last_motion_) < kCommandLife_s;
  const std::array<int, 2> before = running ? last_values_ : std::array<int, 2>{};
  if (!all_zero(frame, 0)) {
    if (!all_zero(frame, 4)) return Refusal::WrongContent;
    if (!permitted_) return Refusal::NotPermitted;
    if (!fresh(now)) return Refusal::Stale;
    if (vehicle_state_ != kNormal || control_mode_ != kCan) return Refusal::NotReady;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const int value = value_at(frame, values_[i].at);
      if (std::abs(value) > values_[i].max) return Refusal::TooLarge;
      if (growth(before[i], value) > values_[i].max_step) return Refusal::TooSudden;
    }
  }
  last_motion_ = now;
  last_values_ = {value_at(frame, values_[0].at), value_at(frame, values_[1].at)};
  return Refusal::None;
}

Refusal Gate::check_code(const TxRule& rule, const CanFrame& frame, Time now) noexcept {
  const std::uint8_t code = frame.data[0];
  if (code > rule.max_code || !all_zero(frame, 1)) return Refusal::WrongContent;
  if (rule.zero_is_stop && code == 0) return Refusal::None;
  if (!permitted_) return Refusal::NotPermitted;
  // A base asked for CAN mode while its radio drives flips between the two and can latch a fault.
  if (frame.id == kControlMode && control_mode_ != kStandby) return Refusal::NotReady;
  auto& last = last_code_[static_cast<std::size_t>(&rule - kMayLeave.data())];
  if (last && base::seconds(now - *last) < rule.min_period_s) return Refusal::TooOften;
  last = now;
  return Refusal::None;
}

bool Gate::fresh(Time now) const noexcept {
  for (std::size_t i = 0; i < must_arrive_.size(); ++i) {
    if (!seen_[i] || base::seconds(now - *seen_[i]) > must_arrive_[i].max_age_s) return false;
  }
  return true;
}

Gate::Counts Gate::counts() const noexcept {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::uint64_t Gate::Counts::refused_total() const noexcept {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

}  // namespace roverd::gate
