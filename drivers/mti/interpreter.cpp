#include "mti/interpreter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::mti {
namespace {

using base::rad_from_deg;

constexpr unsigned kAccelClips = 8;
constexpr unsigned kRateClips = 11;
constexpr unsigned kFieldClips = 14;
constexpr double kLevelling_s = 2.0;
/// A counter that is further on than this began anew rather than lost so much.
constexpr int kMostLost = 1000;

/// R_BS: yaw, then pitch up, then roll.
Mat3 mounted(const Params& p) noexcept {
  return about_z(rad_from_deg(p.mount_yaw_deg)) *
         leaning(rad_from_deg(p.mount_roll_deg), rad_from_deg(p.mount_pitch_deg));
}

/// It belongs to a sample of its own time and says nothing of the unit itself.
bool of_receiver(const Sample& s) noexcept {
  return (s.pvt || s.satellites) &&
         !(s.rate_S || s.accel_S || s.field_S || s.R_ES || s.at || s.velocity_E);
}

bool due(std::optional<Time>& last, Time stamp, double hz) noexcept {
  // Half a millisecond early is in time: stamps are no exact multiples.
  if (last && stamp >= *last && base::seconds(stamp - *last) < 1.0 / hz - 5e-4) return false;
  last = stamp;
  return true;
}

}  // namespace

Interpreter::Interpreter(std::string name, const Params& params, Ears ears)
    : name_(std::move(name)),
      params_(params),
      ears_(std::move(ears)),
      R_BS_(mounted(params)),
      arm_B_{params.arm_forward_m, params.arm_left_m, params.arm_up_m} {}

void Interpreter::reset() {
  forget();
  clock_.reset();
  frozen_ = false;
  status_.reset();
}

void Interpreter::forget() {
  number_.reset();
  R_EB_.reset();
  rate_B_.reset();
  slow_accel_B_.reset();
  pvt_.reset();
  pvt_count_.reset();
}

bool Interpreter::take(Bytes payload, Time arrival) {
  const Data2 data = decode_data2(payload);
  if (!data.whole) {
    ears_.refused("MTData2 with a packet that runs past its end", 1);
    return false;
  }
  const Sample s = gather(data);
  const auto stamp = time_of(s, arrival);
  if (!stamp) return false;
  if (s.status) status_ = s.status;
  if (status_ && !status_->self_test_ok()) {
    ears_.refused("the unit's self-test failed", 1);
    return false;
  }
  count_lost(s);
  learn(s, *stamp);
  tell_inertial(s, *stamp);
  tell_attitude(s, *stamp);
  tell_heading(s, *stamp);
  if (params_.position == "filter") tell_filter(s, *stamp);
  if (s.pvt && params_.position == "gnss") tell_receiver(*s.pvt, *stamp);
  if (s.satellites) tell_satellites(*s.satellites, *stamp);
  return true;
}

/// Empty: not of now. A unit that does not tell its sample time is stamped by arrival.
std::optional<Time> Interpreter::time_of(const Sample& s, Time arrival) {
  latency_s_.reset();
  if (of_receiver(s)) return time_of_receiver(s, arrival);
  frozen_ = false;
  if (!s.count) return arrival;
  const SampleClock::Read read = clock_.read(*s.count, arrival);
  if (read.step == SampleClock::Step::Back) {
    ears_.refused("sample time going back", 1);
    number_.reset();
    pvt_count_.reset();
    return {};
  }
  latency_s_ = 0.0;
  // Slower items have messages of their own, with the time of the sample they belong to.
  if (read.step == SampleClock::Step::Same && (s.rate_S || s.accel_S)) {
    frozen_ = true;
    ears_.refused("sample time standing still", 1);
    return {};
  }
  return read.stamp;
}

/// By arrival while no inertial sample has told how the unit's time and ours go together.
std::optional<Time> Interpreter::time_of_receiver(const Sample& s, Time arrival) {
  if (!s.count || !clock_.known()) return arrival;
  const auto stamp = clock_.at(*s.count, arrival);
  if (!stamp) {
    ears_.refused("GNSS message of a sample that is long past", 1);
    return {};
  }
  if (s.pvt) {
    const bool on = !pvt_count_ || static_cast<std::int32_t>(*s.count - *pvt_count_) > 0;
    if (!on) {
      ears_.refused("GNSS sample time not going on", 1);
      return {};
    }
    pvt_count_ = s.count;
  }
  latency_s_ = 0.0;
  return stamp;
}

/// Numbers go on from message to message as they are sent, the receiver's included; those of a unit
/// that numbers by sample are behind the newest and say nothing of a loss.
void Interpreter::count_lost(const Sample& s) {
  if (!s.number) return;
  if (number_) {
    const int gap = static_cast<std::int16_t>(*s.number - *number_);
    if (gap > 1 && gap <= kMostLost) {
      ears_.noted("message lost on the way", static_cast<std::uint64_t>(gap - 1));
    }
    if (gap <= 0 && gap >= -kMostLost && of_receiver(s)) return;
  }
  number_ = s.number;
}

void Interpreter::learn(const Sample& s, Time stamp) {
  if (s.R_ES) R_EB_ = *s.R_ES * R_BS_.transposed();
  if (!oriented()) R_EB_.reset();
  if (s.rate_S) rate_B_ = R_BS_ * *s.rate_S;
  if (s.pvt) {
    pvt_ = s.pvt;
    pvt_at_ = stamp;
  }
  if (!s.accel_S) return;
  const Vec3 now_B = R_BS_ * *s.accel_S;
  if (!slow_accel_B_) slow_accel_B_ = now_B;
  const double dt_s = std::clamp(base::seconds(stamp - slow_at_), 0.0, kLevelling_s);
  const double share = 1.0 - std::exp(-dt_s / kLevelling_s);
  for (std::size_t i = 0; i < 3; ++i)
    (*slow_accel_B_)[i] += (now_B[i] - (*slow_accel_B_)[i]) * share;
  slow_at_ = stamp;
}

bool Interpreter::clipped(unsigned first_bit) const noexcept {
  return status_ &&
         (status_->bit(first_bit) || status_->bit(first_bit + 1) || status_->bit(first_bit + 2));
}

base::BodyVector Interpreter::body(const Vec3& v_S) const noexcept {
  const Vec3 v_B = R_BS_ * v_S;
  return {v_B[0], v_B[1], v_B[2]};
}

void Interpreter::tell_inertial(const Sample& s, Time stamp) {
  base::Inertial out{stamp, {}, {}};
  if (s.rate_S && clipped(kRateClips)) {
    ears_.refused("rate of turn beyond the gyro's range", 1);
  } else if (s.rate_S) {
    out.rate_radps = body(*s.rate_S);
  }
  if (s.accel_S && clipped(kAccelClips)) {
    ears_.refused("acceleration beyond the sensor's range", 1);
  } else if (s.accel_S) {
    Vec3 accel_B = R_BS_ * *s.accel_S;
    if (rate_B_) {
      // f_S = f_O + ω × (ω × p_OS) + ω' × p_OS
      const Vec3 centripetal = cross(*rate_B_, cross(*rate_B_, arm_B_));
      for (std::size_t i = 0; i < 3; ++i) accel_B[i] -= centripetal[i];
    }
    out.accel_mps2 = base::BodyVector{accel_B[0], accel_B[1], accel_B[2]};
  }
  if (out.rate_radps || out.accel_mps2) ears_.tell(out);
}

void Interpreter::tell_attitude(const Sample& s, Time stamp) {
  if (!s.R_ES || !R_EB_) return;
  const auto& up = R_EB_->row[2];  // how far each of the body's axes points up
  ears_.tell(
      base::Attitude{stamp, std::atan2(up[1], up[2]), std::asin(std::clamp(up[0], -1.0, 1.0))});
}

void Interpreter::tell_heading(const Sample& s, Time stamp) {
  std::optional<double> heading_deg;
  if (params_.heading == "field" && s.field_S) {
    if (heading_at_ && stamp >= *heading_at_ &&
        base::seconds(stamp - *heading_at_) < 1.0 / params_.heading_hz - 5e-4) {
      return;
    }
    if (clipped(kFieldClips)) return ears_.refused("field beyond the sensor's range", 1);
    heading_deg = magnetic_heading_deg(*s.field_S);
  } else if (params_.heading == "orientation" && s.R_ES && R_EB_) {
    heading_deg = base::heading_from_yaw(std::atan2(R_EB_->row[1][0], R_EB_->row[0][0]));
  }
  if (!heading_deg || !due(heading_at_, stamp, params_.heading_hz)) return;
  ears_.tell(base::Heading{stamp,
                           base::yaw_from_heading(*heading_deg + params_.declination_deg),
                           base::HeadingSource::Compass,
                           {}});
}

/// Clockwise from magnetic north to forward, seen from above.
std::optional<double> Interpreter::magnetic_heading_deg(const Vec3& field_S) {
  double roll = 0.0;
  double pitch = 0.0;
  if (R_EB_) {
    roll = std::atan2(R_EB_->row[2][1], R_EB_->row[2][2]);
    pitch = std::asin(std::clamp(R_EB_->row[2][0], -1.0, 1.0));
  } else if (slow_accel_B_) {
    const Vec3& a = *slow_accel_B_;
    roll = std::atan2(a[1], a[2]);
    pitch = std::atan2(a[0], std::hypot(a[1], a[2]));
  }
  const Vec3 field_H = leaning(roll, pitch) * (R_BS_ * field_S);
  const double flat = std::hypot(field_H[0], field_H[1]);
  const double whole = std::hypot(flat, field_H[2]);
  if (whole < kFieldMin || whole > kFieldMax || flat < kFlatFieldMin) {
    ears_.refused("magnetic field that is not the earth's", 1);
    return {};
  }
  return base::deg_from_rad(std::atan2(field_H[1], field_H[0]));
}

}  // namespace roverd::mti
