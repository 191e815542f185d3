#include "cloud/driver.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace roverd::cloud {
namespace {

/// A stamp that is so far off the arrivals was set.
constexpr double kJump_s = 0.5;
/// No frame takes so long.
constexpr double kPatience_s = 5.0;
/// An image does not wait for longer.
constexpr double kOld_s = 1.0;
/// A sequence that goes on by more began anew.
constexpr std::uint32_t kMostLost = 1000;

/// The lowest that a sensor may stand above the ground.
constexpr float kLeastHeight_m = 0.02F;

std::string shape_of(const Frame& frame) {
  if (const auto* depth = std::get_if<Depth>(&frame.body)) {
    return "depth image " + std::to_string(depth->width) + "x" + std::to_string(depth->height);
  }
  if (const auto* cloud = std::get_if<Cloud>(&frame.body)) {
    return "cloud of " + std::to_string(cloud->count);
  }
  return "ranges: " + std::to_string(std::get<Ranges>(frame.body).count);
}

}  // namespace

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement, base::OnSight on_sight)
    : params_(params),
      on_sight_(std::move(on_sight)),
      decoder_(static_cast<std::uint32_t>(params.max_points)),
      eye_(params),
      delay_(kJump_s),
      port_(
          {std::move(name), "waiting for a frame", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](Bytes b, Time t) { on_bytes(b, t); },
          [this] {
            // Not a frame that is still coming in: it is not over because it takes long.
            if (!port_.is_open()) decoder_.forget();
            delay_.forget();
            last_ns_.reset();
            last_sequence_.reset();
          },
          std::move(on_measurement)) {
  port_.on_opening(
      [this](link::ByteLink& link, Time) { link.on_peer = [this] { decoder_.forget(); }; });
}

void Driver::start(Time now) {
  port_.start(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::tick(Time now) {
  const double silent_s = base::seconds(now - port_.last_heard());
  // Where a peer goes in the middle of a frame and its link does not tell.
  if (base::seconds(now - std::max(port_.last_heard(), forgot_)) > kPatience_s) {
    decoder_.forget();
    forgot_ = now;
  }
  if (port_.is_open() && params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    port_.fail("no frame", now);
  } else if (port_.is_up() && silent_s > params_.silent_after_s) {
    port_.lose("no frame", now);
  }
  port_.tick(now);
}

void Driver::on_bytes(Bytes bytes, Time stamp) {
  decoder_.feed(bytes, [&](const Frame& frame) { on_frame(frame, stamp); });
  count_refused();
}

/// @return false: this frame was told already. Keeps the count.
bool Driver::follows(const Header& header) {
  const std::uint32_t on = last_sequence_ ? header.sequence - *last_sequence_ : 1;
  if (on == 0 && last_ns_ == header.stamp_ns) {
    port_.twice("a frame twice");
    return false;
  }
  last_sequence_ = header.sequence;
  if (on > 1 && on <= kMostLost) {
    port_.lost("frames lost", on - 1);
    count_ += on - 1;
  }
  return true;
}

Time Driver::measured_at(const Header& header, Time arrival) {
  if (last_ns_ && header.stamp_ns <= *last_ns_) {
    port_.note("stamps that go back", 1);
    delay_.forget();
  }
  last_ns_ = header.stamp_ns;
  const Time told{base::Duration{header.stamp_ns}};
  if (params_.same_clock && told <= arrival && base::seconds(arrival - told) < kOld_s) {
    return told - base::from_seconds(params_.latency_s);
  }
  return delay_.at(base::Duration{header.stamp_ns}, arrival) -
         base::from_seconds(params_.latency_s);
}

/// A pose that the sender tells, on the mount that the profile tells.
bool Driver::in_ground(const Header& header) const noexcept {
  if (!header.pose) return false;
  const Stand mount = stand_of(params_.mount);
  const Vec3 at = stand_of(header.pose).at;
  const float height_m = mount.at[2] + mount.x[2] * at[0] + mount.y[2] * at[1] + mount.z[2] * at[2];
  return height_m < kLeastHeight_m;
}

void Driver::on_frame(const Frame& frame, Time arrival) {
  if (in_ground(frame.header)) {
    return port_.refused("a pose that puts the camera into the ground");
  }
  port_.received(arrival);
  if (!follows(frame.header)) return;
  auto sight = std::make_shared<base::Sight>();
  sight->sensor = port_.name();
  sight->stamp = measured_at(frame.header, arrival);
  sight->count = count_++;
  const Eye::Seen seen = eye_.look(frame, *sight);
  tell_health(frame, seen);
  port_.heard(arrival);
  on_sight_(std::move(sight));
}

void Driver::tell_health(const Frame& frame, const Eye::Seen& seen) {
  const double share = seen.directions == 0 ? 1.0
                                            : static_cast<double>(seen.missing) /
                                                  static_cast<double>(seen.directions);
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", 100.0 * share);
  port_.fact("missing_pct", text);
  port_.fact("frame", shape_of(frame));
  port_.fact("good", frame.header.good ? "yes" : "no, says the camera");
}

void Driver::count_refused() {
  for (const auto& [cause, n] : decoder_.refused()) {
    std::uint64_t& told = refused_[cause];
    if (cause == Decoder::kStray) {
      port_.stray(cause, n - told);
    } else if (n > told) {
      port_.count(cause, n - told);
    }
    told = n;
  }
}

}  // namespace roverd::cloud
