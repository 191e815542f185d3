#include "sim/imu.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::sim {
namespace {

using mti::Axes;
using mti::Kind;
using mti::Vec3;

constexpr std::uint16_t kWithEvery = 0xFFFF;
constexpr double kGravity_mps2 = 9.81;
constexpr double kFullRate_radps = 7.85;  // 450 deg/s, as the MTi's gyros
constexpr double kFullAccel_mps2 = 50.0;
constexpr double kDip_deg = 72.0;  // of the field, in the Baltic countries
constexpr double kWanderTau_s = 300.0;
constexpr int kStepsPerSecond = 200;
/// A turn or a way that no step makes: somebody put the robot elsewhere.
constexpr double kPlaced_rad = 0.5;

std::vector<mti::Output> stored_outputs() {
  return {{mti::xdi_of(Kind::PacketCounter), kWithEvery},
          {mti::xdi_of(Kind::SampleTimeFine), kWithEvery},
          {mti::xdi_of(Kind::StatusWord), kWithEvery},
          {mti::xdi_of(Kind::Quaternion, Axes::Ned), kWithEvery},
          {mti::xdi_of(Kind::Acceleration), kWithEvery},
          {mti::xdi_of(Kind::RateOfTurn), kWithEvery},
          {mti::xdi_of(Kind::MagneticField), kWithEvery}};
}

bool offered(std::uint16_t xdi) {
  const auto all = stored_outputs();
  return std::ranges::any_of(
      all, [xdi](const mti::Output& o) { return (o.xdi & 0xFFF0U) == (xdi & 0xFFF0U); });
}

int steps_per_sample(const ImuParams& p) {
  return std::max(1, static_cast<int>(std::lround(kStepsPerSecond / p.rate_hz)));
}

/// @return whether it had to be cut.
bool cut(Vec3& v, double most) {
  bool was = false;
  for (double& x : v) {
    was = was || std::abs(x) > most;
    x = std::clamp(x, -most, most);
  }
  return was;
}

}  // namespace

Imu::Imu(std::uint64_t seed)
    : outputs_(stored_outputs()),
      gyro_(seed, Stream::Gyro),
      accel_(seed, Stream::Accelerometer),
      compass_(seed, Stream::ImuCompass),
      gyro_wander_(seed, Stream::GyroWander) {}

void Imu::power_cycle() {
  outputs_ = stored_outputs();
  measuring_ = true;
  framer_.forget();
  pending_.clear();
  answers_ = mti::encode(mti::mid::kWakeUp, {});
}

void Imu::receive(base::Bytes bytes) {
  framer_.feed(bytes, [this](const mti::Message& m) { answer(m); });
}

void Imu::answer(const mti::Message& message) {
  constexpr std::array<std::uint8_t, 4> kDevice{0x05, 0x1D, 0x00, 0x01};
  constexpr std::string_view kProduct = "MTi-SIM-2A8G4     ";
  constexpr std::array<std::uint8_t, 3> kFirmware{1, 0, 0};
  const auto say = [this](std::uint8_t mid, base::Bytes payload) {
    const auto out = mti::encode(mid, payload);
    answers_.insert(answers_.end(), out.begin(), out.end());
  };
  const auto acknowledge = static_cast<std::uint8_t>(message.mid + 1U);
  switch (message.mid) {
    case mti::mid::kGoToConfig:
      measuring_ = false;
      return say(acknowledge, {});
    case mti::mid::kGoToMeasurement:
      measuring_ = true;
      return say(acknowledge, {});
    case mti::mid::kReqDid:
      return say(acknowledge, kDevice);
    case mti::mid::kProductCode - 1:
      return say(acknowledge,
                 {reinterpret_cast<const std::uint8_t*>(kProduct.data()), kProduct.size()});
    case mti::mid::kFirmware - 1:
      return say(acknowledge, kFirmware);
    default:
      break;
  }
  constexpr std::uint8_t kNotUnderstood = 4;
  if (message.mid != mti::mid::kSetOutput || measuring_) {
    return say(mti::mid::kError, std::array{kNotUnderstood});
  }
  std::vector<mti::Output> given = mti::outputs_of(message.payload);
  for (mti::Output& o : given) {
    if (!offered(o.xdi)) o.rate_hz = 0;
  }
  if (!given.empty()) {
    outputs_.clear();
    std::ranges::copy_if(given, std::back_inserter(outputs_),
                         [](const mti::Output& o) { return o.rate_hz > 0; });
  }
  auto list =
      mti::encode(given.empty() ? outputs_ : given);  // as a request; the number is one more
  const base::Bytes payload =
      base::Bytes(list).subspan(4, list.size() - 5);  // at most 32 entries: the short form
  say(acknowledge, payload);
}

Imu::Packets Imu::step(const Params& p, const Faults& faults, const BodyState& now,
                       double motor_difference_a) {
  if (!began_) began_ = now.time;
  const double dt_s = last_step_ ? base::seconds(now.time - *last_step_) : 0.0;
  last_step_ = now.time;
  kick_.step(p.compass, motor_difference_a, dt_s);
  const bool sample = p.imu.fitted && steps_++ % steps_per_sample(p.imu) == 0;
  if (sample) {
    // The streams advance at every sample, told or not: a fault does not shift what comes after.
    const Measured m = measure(p, faults, now, last_ ? base::seconds(now.time - last_->time) : 0.0);
    last_ = now;
    if (measuring_) {
      ++samples_;
      pending_.push_back(
          {now.time + base::from_seconds(p.imu.latency_s), data(m, faults, now.time - *began_)});
    }
  }
  Packets out = std::move(answers_);
  answers_.clear();
  while (!pending_.empty() && pending_.front().due <= now.time) {
    const Packets& bytes = pending_.front().bytes;
    out.insert(out.end(), bytes.begin(), bytes.end());
    pending_.pop_front();
  }
  if (!p.imu.fitted || faults.imu_silent) out.clear();
  return out;
}

Imu::Measured Imu::measure(const Params& p, const Faults& faults, const BodyState& now,
                           double dt_s) {
  Measured m;
  double turn_rad = now.yaw_rate_radps * dt_s;
  double ahead_mps2 = 0.0;
  double left_mps2 = 0.0;
  double up_mps2 = 0.0;
  Vec3 leaning_radps{};
  if (last_ && dt_s > 0.0) {
    const double turned = base::angle_diff_rad(last_->yaw_rad, now.yaw_rad);
    if (std::abs(turned) < kPlaced_rad) turn_rad = turned;
    // E: ENU, B: body. f_B = R_BE · a_E, with the yaw of the middle.
    const double east = (now.east_mps - last_->east_mps) / dt_s;
    const double north = (now.north_mps - last_->north_mps) / dt_s;
    const double yaw = now.yaw_rad - turn_rad / 2.0;
    ahead_mps2 = std::cos(yaw) * east + std::sin(yaw) * north;
    left_mps2 = -std::sin(yaw) * east + std::cos(yaw) * north;
    up_mps2 = (now.up_mps - last_->up_mps) / dt_s;
    const double roll_radps = (now.roll_rad - last_->roll_rad) / dt_s;
    const double pitch_radps = (now.pitch_rad - last_->pitch_rad) / dt_s;
    leaning_radps = {roll_radps, -pitch_radps * std::cos(now.roll_rad),
                     pitch_radps * std::sin(now.roll_rad)};
  }
  const mti::Mat3 R_HB = mti::leaning(base::rad_from_deg(p.imu.roll_deg) + now.roll_rad,
                                      base::rad_from_deg(p.imu.pitch_deg) + now.pitch_rad);
  const mti::Mat3 R_BH = R_HB.transposed();
  const double rate_radps = dt_s > 0.0 ? turn_rad / dt_s : now.yaw_rate_radps;
  ramp_dps_ = faults.imu_gyro_ramp_dps2 == 0.0 ? 0.0 : ramp_dps_ + faults.imu_gyro_ramp_dps2 * dt_s;
  const double bias = p.imu.gyro_bias_dps + faults.imu_gyro_extra_dps + ramp_dps_ +
                      p.imu.gyro_wander_dps * gyro_wander_.step(dt_s, kWanderTau_s);
  m.rate = R_BH * Vec3{0.0, 0.0, rate_radps};
  m.accel = R_BH * Vec3{ahead_mps2, left_mps2, kGravity_mps2 + up_mps2};
  for (std::size_t i = 0; i < 3; ++i) {
    m.rate[i] +=
        leaning_radps[i] + base::rad_from_deg(bias + gyro_.normal() * p.imu.gyro_noise_dps);
    m.accel[i] += p.imu.accel_bias_mps2 + accel_.normal() * p.imu.accel_noise_mps2;
  }
  if (now.gyro_radps) m.rate = {0.0, 0.0, *now.gyro_radps};
  const bool rate_cut = cut(m.rate, kFullRate_radps);
  m.clipped = cut(m.accel, kFullAccel_mps2) || rate_cut;
  if (faults.imu_gyro_frozen && rate_told_) m.rate = *rate_told_;
  rate_told_ = m.rate;

  double slow_deg = p.compass.bias_deg + faults.compass_extra_deg + kick_.error_deg(p.compass) -
                    p.compass.declination_deg;
  double noise_deg = compass_.normal() * p.compass.noise_deg;
  const double true_deg = base::heading_from_yaw(now.yaw_rad);
  if (now.compass_deg) {
    slow_deg = *now.compass_deg - true_deg - p.compass.declination_deg;
    noise_deg = 0.0;
  }
  if (faults.compass_frozen && compass_shown_deg_) {
    slow_deg = *compass_shown_deg_ - true_deg;
    noise_deg = 0.0;
  }
  compass_shown_deg_ = true_deg + slow_deg + noise_deg;
  const double seen_rad = base::rad_from_deg(*compass_shown_deg_);
  const double dip = base::rad_from_deg(kDip_deg);
  m.field = R_BH * Vec3{std::cos(dip) * std::cos(seen_rad), std::cos(dip) * std::sin(seen_rad),
                        -std::sin(dip)};
  const double yaw = now.yaw_rad - base::rad_from_deg(slow_deg);
  m.R_NS = mti::to_enu(Axes::Ned).transposed() * mti::about_z(yaw) * R_HB;
  return m;
}

Imu::Packets Imu::data(const Measured& m, const Faults& faults, base::Duration since) {
  if (faults.imu_freeze && !frozen_.empty()) return frozen_;
  constexpr std::uint32_t kGood = 0x0000'0003;  // self-test, orientation
  constexpr std::uint32_t kClipped = 0x0008'3F00;
  mti::Data2Builder out;
  for (const mti::Output& o : outputs_) {
    const Kind kind = static_cast<Kind>(o.xdi & 0xFFF0U);
    if (kind == Kind::StatusWord) {
      out.integer(o.xdi, m.clipped ? kGood | kClipped : kGood, 4);
      continue;
    }
    if (kind == Kind::MagneticField && faults.compass_off) continue;
    put(out, o.xdi, m, since);
  }
  frozen_ = mti::encode(mti::mid::kMtData2, out.payload());
  return frozen_;
}

void Imu::put(mti::Data2Builder& out, std::uint16_t xdi, const Measured& m, base::Duration since) {
  constexpr std::int64_t kTick_ns = 100'000;
  switch (static_cast<Kind>(xdi & 0xFFF0U)) {
    case Kind::PacketCounter:
      out.integer(xdi, static_cast<std::uint16_t>(samples_), 2);
      return;
    case Kind::SampleTimeFine:
      out.integer(xdi, static_cast<std::uint32_t>(since.count() / kTick_ns), 4);
      return;
    case Kind::Quaternion: {
      const auto q = mti::to_quaternion(m.R_NS);
      out.numbers(xdi, {q[0], q[1], q[2], q[3]});
      return;
    }
    case Kind::Acceleration:
      out.numbers(xdi, {m.accel[0], m.accel[1], m.accel[2]});
      return;
    case Kind::RateOfTurn:
      out.numbers(xdi, {m.rate[0], m.rate[1], m.rate[2]});
      return;
    case Kind::MagneticField:
      out.numbers(xdi, {m.field[0], m.field[1], m.field[2]});
      return;
    default:
      return;
  }
}

}  // namespace roverd::sim
