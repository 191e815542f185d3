// What the Bunker driver hears: which frames count, which protocol they are of, what they mean.

#include <algorithm>
#include <type_traits>

#include "bunker/driver.hpp"
#include "bunker/plausible.hpp"

namespace roverd::bunker {

using base::ControlMode;

namespace {

constexpr bool is_command(std::uint32_t frame_id) noexcept {
  return frame_id == id::kMotionCommand || frame_id == id::kLightCommand ||
         frame_id == id::kControlMode || frame_id == id::kClearErrors ||
         frame_id == v1::id::kCommand || frame_id == v1::id::kLightCommand;
}

constexpr bool is_motion_command(std::uint32_t frame_id) noexcept {
  return frame_id == id::kMotionCommand || frame_id == v1::id::kCommand;
}

}  // namespace

// Asked of the codecs and the gate, so that no second list forgets one.
std::vector<std::uint32_t> Driver::own_ids() const {
  std::vector<std::uint32_t> ids;
  CanFrame frame;
  frame.len = 8;
  for (frame.id = 0; frame.id < 0x800; ++frame.id) {
    const bool read = decode(frame).verdict != Verdict::Foreign || v1::is_known(frame.id);
    if (gate_.lists(frame.id) || read) ids.push_back(frame.id);
  }
  return ids;
}

void Driver::on_frame(const CanFrame& frame, Time stamp) {
  if (frame.error) return tally_.add(Cause::ErrorFrame);
  if (frame.remote) return tally_.add(Cause::Remote);
  if (frame.extended) return tally_.add(Cause::Extended);
  if (v1::is_known(frame.id)) {
    on_v1(frame, stamp);
  } else {
    on_v2(frame, stamp);
  }
}

template <class Decoded>
bool Driver::refuse(const CanFrame& frame, const Decoded& decoded) {
  switch (decoded.verdict) {
    case Verdict::Decoded:
      if (is_command(frame.id)) return false;
      if (const auto bad = impossible(decoded.message, params_.odometer_max_mps)) {
        ++refused_;
        tally_.add(Cause::Impossible, frame.id, *bad);
        return true;
      }
      return false;
    case Verdict::Foreign:
      tally_.add(Cause::UnknownId, frame.id);
      return true;
    case Verdict::TooShort:
      ++refused_;
      tally_.add(Cause::TooShort, frame.id);
      return true;
    case Verdict::BadValue:
      ++refused_;
      tally_.add(Cause::BadValue, frame.id);
      return true;
    case Verdict::BadChecksum:
      ++refused_;
      tally_.add(Cause::BadChecksum, frame.id);
      return true;
  }
  return true;
}

void Driver::on_v2(const CanFrame& frame, Time stamp) {
  const Decoded decoded = decode(frame, left_stick_);
  if (refuse(frame, decoded)) return;
  if (is_command(frame.id)) return foreign_command(frame.id, stamp);
  const bool marks = frame.id == id::kMotionState || frame.id == id::kRadioState;
  if (marks && two_protocols(false, stamp)) return;
  // In V1 this id is the answer to a setting.
  if (v1_seen_ && frame.id == id::kSystemState) {
    return tally_.add(Cause::NotThisProtocol, frame.id);
  }
  heard(frame, stamp);
  if (frame.id == id::kMotionState || frame.id == id::kSystemState) feedback(stamp);
  gate_.saw(frame, stamp);
  watch(decoded.message, stamp);
  if (const auto* s = std::get_if<SystemState>(&decoded.message)) {
    mode_.store(s->control_mode(), std::memory_order_release);
  }
  if (const auto* o = std::get_if<Odometer>(&decoded.message)) {
    const auto travel = odometry_.add(*o, stamp);
    if (!travel) return;
    turn_.travel(travel->left_m, travel->right_m, stamp);
    on_measurement_(base::WheelTravel{stamp, travel->left_m, travel->right_m});
  } else {
    interpreter_.take(decoded.message, stamp);
  }
}

void Driver::on_v1(const CanFrame& frame, Time stamp) {
  const v1::Decoded decoded = v1::decode(frame);
  if (refuse(frame, decoded)) return;
  if (is_command(frame.id)) return foreign_command(frame.id, stamp);
  const auto* state = std::get_if<v1::SystemState>(&decoded.message);
  if (state != nullptr && two_protocols(true, stamp)) return;
  if (!v1_seen_) return tally_.add(Cause::NotThisProtocol, frame.id);
  heard(frame, stamp);
  if (state != nullptr || frame.id == v1::id::kMotionState) feedback(stamp);
  gate_.saw(frame, stamp);
  ControlMode mode = ControlMode::Unknown;
  if (state != nullptr) {
    if (state_count_.add(state->count, stamp)) tally_.add(Cause::Frozen, frame.id);
    mode = v1_mode(*state, stamp);
    mode_.store(mode, std::memory_order_release);
  }
  interpreter_.take(decoded.message, mode, stamp);
}

void Driver::heard(const CanFrame& frame, Time stamp) {
  port_.received(stamp);
  rates_.add(frame.id);
}

void Driver::foreign_command(std::uint32_t frame_id, Time stamp) {
  tally_.add(Cause::ForeignCommand, frame_id);
  if (!is_motion_command(frame_id)) return;
  foreign_motion_ = stamp;
  tell_news(stamp);
}

bool Driver::two_protocols(bool v1, Time stamp) {
  (v1 ? v1_seen_ : v2_seen_) = true;
  if (!v1_seen_ || !v2_seen_) {
    speaks_v1_.store(v1, std::memory_order_release);
    return false;
  }
  ++refused_;
  port_.fail("speaks protocols V1 (0x151) and V2 (0x221, 0x241) at once: will not drive it", stamp);
  up_from_ = stamp;  // counted from the next opening
  port_.say(stamp);
  return true;
}

void Driver::feedback(Time stamp) {
  port_.alive(stamp);
  if (port_.is_up()) return;
  if (up_from_ && stamp < *up_from_) return;
  up_from_.reset();
  gate_.permit(true);
  up_.store(true, std::memory_order_release);
  port_.heard(stamp);
}

void Driver::watch(const Message& message, Time stamp) {
  if (const auto* s = std::get_if<SystemState>(&message)) {
    if (state_count_.add(s->count, stamp)) tally_.add(Cause::Frozen, id::kSystemState);
  } else if (const auto* r = std::get_if<RadioFrame>(&message)) {
    // No hazard: the robot looks at this counter itself.
    if (radio_count_.add(r->count, stamp)) tally_.add(Cause::Frozen, id::kRadioState);
  } else if (const auto* m = std::get_if<MotionState>(&message)) {
    turn_.motion(m->angular_radps, stamp);
  }
}

ControlMode Driver::v1_mode(const v1::SystemState& s, Time stamp) noexcept {
  const bool taken =
      v1_mode_raw_ == 1 && s.control_mode_raw == 0 && ours_.load(std::memory_order_relaxed);
  v1_mode_raw_ = s.control_mode_raw;
  if (taken) radio_took_ = stamp;
  if (s.control_mode_raw != 0) radio_took_.reset();
  if (s.control_mode() != ControlMode::Radio) return s.control_mode();
  const bool radio = radio_took_ && stamp - *radio_took_ < kRadioPause;
  return radio ? ControlMode::Radio : ControlMode::Standby;
}

}  // namespace roverd::bunker
