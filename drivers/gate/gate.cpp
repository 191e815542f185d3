#include "gate/gate.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace roverd::gate {

namespace {

constexpr std::uint32_t kControlMode = 0x421;
constexpr std::uint8_t kNormal = 0;
constexpr std::uint8_t kStandby = 0;  // of V1: the radio's mode
constexpr std::uint8_t kCan = 1;

constexpr std::size_t kTwoBytes = 2;

constexpr std::size_t kV2 = 0;
constexpr std::size_t kV1 = 1;

/// The base itself forgets a motion command after this long.
constexpr double kCommandLife_s = 0.5;

/// Bytes of 0x130, and of both light commands.
constexpr std::size_t kV1Clear = 1;
constexpr std::size_t kV1Speeds = 2;
constexpr std::uint8_t kV1LastClear = 8;
constexpr std::uint8_t kLastLightMode = 3;
constexpr std::uint8_t kBrightest = 100;

constexpr bool is_plain(const CanFrame& f) noexcept {
  return !f.extended && !f.remote && !f.error;
}

constexpr int value_at(const CanFrame& f, const ValueRule& rule) noexcept {
  if (rule.bytes == 1) return static_cast<std::int8_t>(f.data[rule.at]);
  return static_cast<std::int16_t>((f.data[rule.at] << 8U) | f.data[rule.at + 1]);
}

constexpr bool all_zero(const CanFrame& f, std::size_t from, std::size_t to) noexcept {
  for (std::size_t i = from; i < to; ++i) {
    if (f.data[i] != 0) return false;
  }
  return true;
}

/// @param f eight bytes long.
constexpr bool v1_intact(const CanFrame& f) noexcept {
  unsigned sum = (f.id & 0xFFU) + (f.id >> 8U) + f.len;
  for (std::size_t i = 0; i < 7; ++i) sum += f.data[i];
  return f.data[7] == (sum & 0xFFU);
}

/// How far `to` lies beyond `from`, away from zero. A change of sign counts from zero.
constexpr int growth(int from, int to) noexcept {
  const bool same_side = (from < 0) == (to < 0);  // mutant < 0: zero belongs to both sides
  const int start = same_side ? std::abs(from) : 0;
  return std::abs(to) - start;
}

bool young(const std::optional<Time>& seen, const RxRule& rule, Time now) noexcept {
  return seen && base::seconds(now - *seen) <= rule.max_age_s;
}

}  // namespace

Gate::Gate(const Limits& l) noexcept
    : protocols_{
          Protocol{RxRule{0x221, 8, 0.02, l.motion_max_age_s},
                   RxRule{0x211, 8, 0.2, l.state_max_age_s},
                   {ValueRule{0, kTwoBytes, l.max_linear, l.max_linear_step},
                    ValueRule{2, kTwoBytes, l.max_angular, l.max_angular_step}}},
          Protocol{RxRule{0x131, 8, 0.02, l.motion_max_age_s},
                   RxRule{0x151, 8, 0.2, l.state_max_age_s},
                   {ValueRule{kV1Speeds, 1, l.max_linear_pct, l.max_linear_step_pct},
                    ValueRule{kV1Speeds + 1, 1, l.max_angular_pct, l.max_angular_step_pct}}}} {}

void Gate::saw(const CanFrame& frame, Time now) noexcept {
  if (!is_plain(frame)) return;
  const std::lock_guard lock(mutex_);
  for (const std::size_t which : {kV2, kV1}) {
    const Protocol& p = protocols_[which];
    const bool is_state = frame.id == p.state.id;
    if (!is_state && frame.id != p.motion.id) continue;
    if (frame.len < (is_state ? p.state.len : p.motion.len)) continue;
    if (which == kV1 && !v1_intact(frame)) continue;
    if (!is_state) {
      heard_[which].motion = now;
      continue;
    }
    heard_[which].state = now;
    heard_[which].vehicle_state = frame.data[0];
    heard_[which].control_mode = frame.data[1];
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
  if (!on) heard_ = {};
}

Refusal Gate::check(const CanFrame& frame, Time now) noexcept {
  const auto rule = std::find_if(kMayLeave.begin(), kMayLeave.end(),
                                 [&](const TxRule& r) { return r.id == frame.id; });
  if (rule == kMayLeave.end() || !is_plain(frame)) return Refusal::NotListed;
  if (frame.len != rule->len) return Refusal::WrongLength;
  switch (rule->payload) {
    case Payload::Motion:
      return check_motion(*rule, frame, now);
    case Payload::MotionV1:
      return check_v1(*rule, frame, now);
    case Payload::Code:
      return check_code(*rule, frame, now);
    case Payload::Lights:
    case Payload::LightsV1:
      return check_lights(*rule, frame, now);
  }
  return Refusal::NotListed;  // mutant Refusal::NotListed;: every payload returned above
}

Refusal Gate::check_motion(const TxRule& rule, const CanFrame& frame, Time now) noexcept {
  if (!all_zero(frame, 0, rule.len)) {
    if (!all_zero(frame, 4, rule.len)) return Refusal::WrongContent;
    if (const Refusal r = check_speeds(kV2, frame, now); r != Refusal::None) return r;
  }
  left(kV2, frame, now);
  return Refusal::None;
}

Refusal Gate::check_v1(const TxRule& rule, const CanFrame& frame, Time now) noexcept {
  const std::uint8_t mode = frame.data[0];
  // Sideways speed and the spare byte are zero; byte 6 counts.
  if (mode > rule.max_code || !all_zero(frame, 4, 6) || !v1_intact(frame)) {
    return Refusal::WrongContent;
  }
  const bool clears = frame.data[kV1Clear] != 0;
  if (frame.data[kV1Clear] > kV1LastClear) return Refusal::WrongContent;
  const bool stands = all_zero(frame, kV1Speeds, kV1Speeds + 2);  // mutant 2: byte 4 is zero
  const bool in_can = heard_[kV1].control_mode == kCan;
  if (!stands) {
    if (mode != kCan || clears) return Refusal::WrongContent;
    if (const Refusal r = check_speeds(kV1, frame, now); r != Refusal::None) return r;
  } else if (clears || (mode == kCan && !in_can)) {
    // A request: to clear an error, or for CAN mode from a base that is not in it.
    if (!permitted_) return Refusal::NotPermitted;
    if (mode == kCan && !in_can && heard_[kV1].control_mode != kStandby) return Refusal::NotReady;
    if (const Refusal r = check_period(rule, now); r != Refusal::None) return r;
  }
  left(kV1, frame, now);
  return Refusal::None;
}

Refusal Gate::check_speeds(std::size_t which, const CanFrame& frame, Time now) noexcept {
  const std::size_t other = 1 - which;
  if (!permitted_) return Refusal::NotPermitted;
  if (motion_fresh(other, now) || state_fresh(other, now)) return Refusal::TwoProtocols;
  if (!motion_fresh(which, now) || !state_fresh(which, now)) return Refusal::Stale;
  if (heard_[which].vehicle_state != kNormal || heard_[which].control_mode != kCan) {
    return Refusal::NotReady;
  }
  const bool running = last_motion_ && last_protocol_ == which &&
                       base::seconds(now - *last_motion_) < kCommandLife_s;
  const auto& values = protocols_[which].values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const int value = value_at(frame, values[i]);
    if (std::abs(value) > values[i].max) return Refusal::TooLarge;
    if (growth(running ? last_values_[i] : 0, value) > values[i].max_step) {
      return Refusal::TooSudden;
    }
  }
  return Refusal::None;
}

void Gate::left(std::size_t which, const CanFrame& frame, Time now) noexcept {
  last_motion_ = now;
  last_protocol_ = which;
  const auto& values = protocols_[which].values;
  last_values_ = {value_at(frame, values[0]), value_at(frame, values[1])};
}

Refusal Gate::check_code(const TxRule& rule, const CanFrame& frame, Time now) noexcept {
  const std::uint8_t code = frame.data[0];
  if (code > rule.max_code || !all_zero(frame, 1, rule.len)) return Refusal::WrongContent;
  if (rule.zero_is_stop && code == 0) return Refusal::None;
  if (!permitted_) return Refusal::NotPermitted;
  // A base asked for CAN mode while its radio drives flips between the two and can latch a fault.
  if (frame.id == kControlMode && heard_[kV2].control_mode != kStandby) return Refusal::NotReady;
  return check_period(rule, now);
}

Refusal Gate::check_lights(const TxRule& rule, const CanFrame& frame, Time now) noexcept {
  const bool v1 = rule.payload == Payload::LightsV1;
  const auto& d = frame.data;
  if (d[0] > rule.max_code || d[1] > kLastLightMode || d[2] > kBrightest || d[3] > kLastLightMode ||
      d[4] > kBrightest || !all_zero(frame, 5, v1 ? 6 : 7) || (v1 && !v1_intact(frame))) {
    return Refusal::WrongContent;
  }
  if (!permitted_) return Refusal::NotPermitted;
  return check_period(rule, now);
}

Refusal Gate::check_period(const TxRule& rule, Time now) noexcept {
  auto& last = last_code_[static_cast<std::size_t>(&rule - kMayLeave.data())];
  if (last && base::seconds(now - *last) < rule.min_period_s) return Refusal::TooOften;
  last = now;
  return Refusal::None;
}

bool Gate::motion_fresh(std::size_t which, Time now) const noexcept {
  return young(heard_[which].motion, protocols_[which].motion, now);
}
bool Gate::state_fresh(std::size_t which, Time now) const noexcept {
  return young(heard_[which].state, protocols_[which].state, now);
}

Gate::Counts Gate::counts() const noexcept {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::uint64_t Gate::Counts::refused_total() const noexcept {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

}  // namespace roverd::gate
