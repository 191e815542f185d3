#include "velodyne/revolutions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace roverd::velodyne {
namespace {

constexpr double kRadPerCdeg = std::numbers::pi / 18'000.0;
/// A fall of the azimuth by less is a head that trembles, no new turn.
constexpr int kTremble_cdeg = 500;
/// The fastest head takes 50 ms: azimuths that fall back more often are none.
constexpr double kShortestTurn_s = 0.02;

struct Channel {
  float part = 0.0F;     ///< of the block's step
  float after_s = 0.0F;  ///< its block
};
constexpr std::array<Channel, kChannels> kChannelTable = [] {
  std::array<Channel, kChannels> out{};
  for (std::size_t c = 0; c < kChannels; ++c) {
    out[c] = {static_cast<float>(firing_us(c) / kBlock_us),
              static_cast<float>(firing_us(c) * 1e-6)};
  }
  return out;
}();

base::Duration micros(std::uint64_t us) noexcept {
  return std::chrono::microseconds(static_cast<std::int64_t>(us));
}

}  // namespace

Revolutions::Revolutions(std::string sensor, const Params& params, OnTurn on_turn)
    : sensor_(std::move(sensor)), params_(params), on_turn_(std::move(on_turn)) {}

void Revolutions::forget() {
  known_ = false;
  delay_.forget();
  sight_.reset();
}

void Revolutions::finish() {
  if (sight_) tell(false, static_cast<double>(total_us_) + period_us_);
}

void Revolutions::choose(Product product) {
  product_ = product;
  for (std::size_t i = 0; i < kLasers; ++i) {
    const double w_rad = elevation_deg(product, i) * std::numbers::pi / 180.0;
    const double height = params_.vertical_offsets ? height_m(product, i) : 0.0;
    lasers_[i] = {static_cast<float>(std::cos(w_rad)), static_cast<float>(std::sin(w_rad)),
                  static_cast<float>(height), ring_of(i)};
  }
}

/// Keeps the sensor's clock. @return false: the packet tells what is known, or comes too late.
bool Revolutions::follows(const Packet& packet, Time arrival) {
  constexpr auto kJump_us = static_cast<std::int64_t>(kJump_s * 1e6);
  std::int64_t on_us = 0;
  if (known_) {
    on_us = static_cast<std::int64_t>(packet.stamp_us) - static_cast<std::int64_t>(last_us_);
    if (on_us < -static_cast<std::int64_t>(kHour_us) / 2) on_us += kHour_us;
    if (on_us > static_cast<std::int64_t>(kHour_us) / 2) on_us -= kHour_us;
    // A silence is none of the clock's: as much time has passed here.
    const auto here_us = std::chrono::duration_cast<std::chrono::microseconds>(arrival - arrived_);
    const bool silence = on_us > kJump_us && std::abs(on_us - here_us.count()) < kJump_us;
    if (!silence && std::abs(on_us) > kJump_us) {
      ++counts_.jumps;
      finish();
      known_ = false;
      delay_.forget();
    } else if (on_us == 0) {
      ++counts_.duplicates;
      return false;
    } else if (on_us < 0) {
      ++counts_.late;
      return false;
    }
  }
  if (known_) {
    const auto missing = std::llround(static_cast<double>(on_us) / period_us_) - 1;
    if (missing > 0) counts_.lost += static_cast<std::uint64_t>(missing);
    total_us_ += static_cast<std::uint64_t>(on_us);
  } else {
    total_us_ = packet.stamp_us;
  }
  known_ = true;
  last_us_ = packet.stamp_us;
  return true;
}

void Revolutions::add(const Packet& packet, Time arrival) {
  if (!follows(packet, arrival)) return;
  period_us_ = packet.period_us();
  // It leaves the sensor when its last firing is done.
  first_firing_ = delay_.at(micros(total_us_), arrival - base::from_seconds(period_us_ * 1e-6));
  arrived_ = arrival;
  if (product_ != packet.product) {
    finish();
    choose(packet.product);
  }
  ++counts_.packets;
  const Steps steps = steps_of(packet, step_cdeg_);
  if (steps.gap) ++counts_.gaps;
  const std::size_t together = packet.together();
  for (std::size_t b = 0; b < kBlocks; b += together) {
    const double at_us =
        static_cast<double>(total_us_) + static_cast<double>(b / together) * kBlock_us;
    const int fall = azimuth_cdeg_ - static_cast<int>(packet.blocks[b].azimuth_cdeg);
    const bool wrapped = sight_ && fall > kTremble_cdeg &&
                         (!from_start_ || at_us - began_us_ > kShortestTurn_s * 1e6);
    const bool too_long = sight_ && at_us - began_us_ > kLongestTurn_s * 1e6;
    if (wrapped || too_long) {
      tell(wrapped && from_start_ && !too_long, at_us);
      from_start_ = wrapped;
    } else if (!sight_) {
      from_start_ = false;
    }
    if (!sight_) begin(at_us);
    azimuth_cdeg_ = packet.blocks[b].azimuth_cdeg;
    take_blocks(packet, steps, b, at_us);
  }
  if (!steps.gap) step_cdeg_ = steps.cdeg[0];
}

void Revolutions::begin(double at_us) {
  sight_ = std::make_shared<base::Sight>();
  sight_->sensor = sensor_;
  sight_->points.reserve(expected_);
  began_us_ = at_us;
  sight_->stamp =
      first_firing_ + base::from_seconds((at_us - static_cast<double>(total_us_)) * 1e-6);
  sight_->clear_to_m = static_cast<float>(params_.clear_to_m);
  missing_ = firings_ = 0;
}

void Revolutions::take_blocks(const Packet& packet, const Steps& steps, std::size_t b,
                              double block_us) {
  const Block& even = packet.blocks[b];
  const Block* odd = packet.mode == ReturnMode::Dual ? &packet.blocks[b + 1] : nullptr;
  const double azimuth_rad = even.azimuth_cdeg * kRadPerCdeg;
  const auto sin_0 = static_cast<float>(std::sin(azimuth_rad));
  const auto cos_0 = static_cast<float>(std::cos(azimuth_rad));
  const auto step_rad = static_cast<float>(steps.cdeg[b] * kRadPerCdeg);
  const auto block_s = static_cast<float>((block_us - began_us_) * 1e-6);
  for (std::size_t c = 0; c < kChannels; ++c) {
    // On by part of a step, 0.087 rad at most: the series are exact to 2e-8.
    const float d = kChannelTable[c].part * step_rad;
    const float d2 = d * d;
    const float sin_d = d * (1.0F - d2 * (1.0F / 6.0F - d2 / 120.0F));
    const float cos_d = 1.0F - d2 * (0.5F - d2 / 24.0F);
    const float sin_a = sin_0 * cos_d + cos_0 * sin_d;
    const float cos_a = cos_0 * cos_d - sin_0 * sin_d;
    const float after_s = block_s + kChannelTable[c].after_s;
    const Laser& laser = lasers_[c % kLasers];
    const Return last = even.channels[c];
    const Return other = odd != nullptr ? odd->channels[c] : Return{};
    ++firings_;
    if (last.distance == 0 && other.distance == 0) {
      add_missing(laser, sin_a, cos_a, after_s);
      continue;
    }
    if (last.distance != 0) add_return(last, laser, sin_a, cos_a, after_s);
    if (other.distance != 0 && other.distance != last.distance) {
      add_return(other, laser, sin_a, cos_a, after_s);
    }
  }
}

base::SightPoint& Revolutions::put(const Laser& laser, float sin_a, float cos_a, float range_m) {
  const float level_m = range_m * laser.cos_w;
  base::SightPoint& p = sight_->points.emplace_back();
  p.x_m = level_m * cos_a;
  p.y_m = -level_m * sin_a;
  p.z_m = range_m * laser.sin_w;
  p.ring = laser.ring;
  return p;
}

void Revolutions::add_return(Return r, const Laser& laser, float sin_a, float cos_a,
                             float after_s) {
  const float range_m = static_cast<float>(r.distance) * static_cast<float>(kUnit_m);
  if (range_m > static_cast<float>(params_.max_range_m)) {
    return add_missing(laser, sin_a, cos_a, after_s);
  }
  const bool near = range_m < static_cast<float>(params_.min_range_m);
  if (near) ++missing_;
  base::SightPoint& p = put(laser, sin_a, cos_a, near ? 1.0F : range_m);
  if (!near) p.z_m += laser.height_m;
  p.after_s = after_s;
  p.intensity = r.reflectivity;
  p.echo = near ? base::Echo::Unknown : base::Echo::Hit;
}

void Revolutions::add_missing(const Laser& laser, float sin_a, float cos_a, float after_s) {
  ++missing_;
  const bool clear = params_.clear_to_m > 0.0;
  base::SightPoint& p =
      put(laser, sin_a, cos_a, clear ? static_cast<float>(params_.clear_to_m) : 1.0F);
  p.after_s = after_s;
  p.echo = clear ? base::Echo::Clear : base::Echo::Unknown;
}

void Revolutions::tell(bool whole, double end_us) {
  Turn turn;
  turn.whole = whole;
  turn.duration_s = (end_us - began_us_) * 1e-6;
  turn.missing = missing_;
  turn.firings = firings_;
  sight_->count = count_++;
  sight_->half_step_rad = static_cast<float>(step_cdeg_ * kRadPerCdeg / 4.0);
  expected_ = std::max(expected_, sight_->points.size() + sight_->points.size() / 16);
  turn.sight = std::move(sight_);
  sight_.reset();
  on_turn_(turn);
}

}  // namespace roverd::velodyne
