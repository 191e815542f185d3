#include "gate/gate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace roverd::gate {

namespace {

bool is_plain(const CanFrame& f) noexcept {
  return !f.extended && !f.remote && !f.error;
}

/// How far `to` lies beyond `from`, away from zero. A change of sign counts from zero.
double growth(double from, double to) noexcept {
  const bool same_side = (from < 0.0) == (to < 0.0);  // mutant <: zero belongs to both sides
  return std::abs(to) - (same_side ? std::abs(from) : 0.0);
}

bool young(const std::optional<Time>& seen, double max_age_s, Time now) noexcept {
  return seen && base::seconds(now - *seen) <= max_age_s;
}

bool all_zero(base::Bytes bytes) noexcept {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b == 0; });
}

}  // namespace

Gate::Side::Side(const Table& table)
    : motion(table.motion), asked{{.min_period_s = table.motion.min_period_s}} {
  for (const Request& r : table.requests) requests.push_back({r});
  for (const Feedback& f : table.feedback) {
    heard.push_back({f});
    if (f.state) state = f.state;
  }
}

Gate::Gate(const std::vector<Table>& tables) {
  for (const Table& t : tables) sides_.emplace_back(t);
}

void Gate::saw(const CanFrame& frame, Time now) noexcept {
  if (!is_plain(frame)) return;
  const std::lock_guard lock(mutex_);
  for (Side& side : sides_) take(side, {frame.id, frame.bytes()}, now);
}

void Gate::saw(Time now) noexcept {
  const std::lock_guard lock(mutex_);
  for (Side& side : sides_) take(side, {}, now);
}

void Gate::take(Side& side, const Wire& wire, Time now) noexcept {
  for (Heard& heard : side.heard) {
    const Feedback& f = heard.rule;
    if (f.id != wire.id || wire.bytes.size() < f.len || !sealed(f.check, wire)) continue;
    heard.at = now;
    heard.once = true;
    if (f.state) side.told = {wire.bytes[0], wire.bytes[1]};
  }
}

bool Gate::allows(const CanFrame& frame, Time now) noexcept {
  const std::lock_guard lock(mutex_);
  return judged(is_plain(frame) ? check({frame.id, frame.bytes()}, now) : Refusal::NotListed);
}

bool Gate::allows(base::Bytes message, Time now) noexcept {
  const std::lock_guard lock(mutex_);
  return judged(check({0, message}, now));
}

bool Gate::judged(Refusal refusal) noexcept {
  ++(refusal == Refusal::None ? counts_.allowed
                              : counts_.refused[static_cast<std::size_t>(refusal)]);
  return refusal == Refusal::None;
}

void Gate::permit(bool on) noexcept {
  const std::lock_guard lock(mutex_);
  permitted_ = on;
  if (on) return;
  for (Side& side : sides_) {
    for (Heard& heard : side.heard) heard.at.reset();
    side.told.reset();
  }
}

void Gate::renew() noexcept {
  const std::lock_guard lock(mutex_);
  for (Side& side : sides_) {
    for (Heard& heard : side.heard) heard.once = false;
  }
}

bool Gate::lists(std::uint32_t id) const noexcept {
  const std::lock_guard lock(mutex_);
  return std::any_of(sides_.begin(), sides_.end(), [&](const Side& side) {
    return side.motion.id == id ||
           std::any_of(side.requests.begin(), side.requests.end(),
                       [&](const Asked& request) { return request.rule.id == id; });
  });
}

Refusal Gate::check(const Wire& wire, Time now) noexcept {
  for (Side& side : sides_) {
    if (side.motion.id == wire.id) return check_motion(side, wire, now);
    for (Asked& request : side.requests) {
      if (request.rule.id == wire.id) return check_request(side, request, wire, now);
    }
  }
  return Refusal::NotListed;
}

Refusal Gate::check_motion(Side& side, const Wire& wire, Time now) noexcept {
  const Motion& motion = side.motion;
  if (!right_length(motion, wire.bytes)) return Refusal::WrongLength;
  const std::optional<Said> said = read(motion, wire);
  if (!said) return Refusal::WrongContent;
  if (!said->stands && (!said->drives || said->asks)) return Refusal::WrongContent;
  if (said->beyond) return Refusal::TooLarge;
  const bool zero_asks = motion.mode && motion.mode->zero_asks;
  const bool to_drive = said->drives && !side.drives();
  Refusal refusal = Refusal::None;
  if (!said->stands || (said->drives && !zero_asks)) {
    refusal = check_speeds(side, *said, now);
  } else if (said->asks || to_drive) {
    refusal = check_asking(side, side.asked, to_drive, now);
  }
  if (refusal != Refusal::None) return refusal;
  last_side_ = &side;
  last_at_ = now;
  last_values_ = said->values;
  return Refusal::None;
}

Refusal Gate::check_request(const Side& side, Asked& asked, const Wire& wire, Time now) noexcept {
  const Request& rule = asked.rule;
  if (wire.bytes.size() != rule.bytes.size) return Refusal::WrongLength;
  if (!fits(rule.bytes, wire)) return Refusal::WrongContent;
  if (rule.zero_stops && all_zero(wire.bytes)) return Refusal::None;
  return check_asking(side, asked, rule.to_drive, now);
}

Refusal Gate::check_asking(const Side& side, Asked& asked, bool to_drive, Time now) noexcept {
  if (!permitted_) return Refusal::NotPermitted;
  if (to_drive && !side.stands_by()) return Refusal::NotReady;
  if (asked.at && base::seconds(now - *asked.at) < asked.rule.min_period_s) {
    return Refusal::TooOften;
  }
  asked.at = now;
  return Refusal::None;
}

Refusal Gate::check_speeds(const Side& side, const Said& said, Time now) const noexcept {
  if (!permitted_) return Refusal::NotPermitted;
  for (const Side& other : sides_) {
    if (&other == &side) continue;
    for (const Heard& heard : other.heard) {
      if (young(heard.at, heard.rule.max_age_s, now)) return Refusal::TwoProtocols;
    }
  }
  for (const Heard& heard : side.heard) {
    const bool needed = heard.rule.need == Need::Always || heard.once;
    if (needed && !young(heard.at, heard.rule.max_age_s, now)) return Refusal::Stale;
  }
  if (side.state && !(side.is_normal() && side.drives())) return Refusal::NotReady;
  return check_steps(side.motion, last_side_ == &side, said, now);
}

Refusal Gate::check_steps(const Motion& motion, bool same_side, const Said& said,
                          Time now) const noexcept {
  const bool running = same_side && base::seconds(now - last_at_) < motion.forgets_s;
  for (std::size_t i = 0; i < said.values.size(); ++i) {
    const Value& rule = motion.values[i];
    const double value = said.values[i];
    if (std::abs(value) > rule.max) return Refusal::TooLarge;
    const double from = running || rule.holds ? last_values_[i] : 0.0;
    const double step = rule.holds ? std::abs(value - from) : growth(from, value);
    if (step > rule.max_step) return Refusal::TooSudden;
  }
  return Refusal::None;
}

Gate::Counts Gate::counts() const noexcept {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::uint64_t Gate::Counts::refused_total() const noexcept {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

}  // namespace roverd::gate
