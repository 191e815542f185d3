#include "robot/safety/estimate_watch.hpp"

#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::robot {
namespace {

using base::Severity;

std::string cause_of(base::Refusal why) {
  switch (why) {
    case base::Refusal::NotFinite:
      return "they are not numbers";
    case base::Refusal::Impossible:
      return "they cannot be";
    case base::Refusal::Stamp:
      return "they are doubled, out of order or too old";
    case base::Refusal::Zero:
      return "latitude and longitude are exactly zero";
    case base::Refusal::Date:
      return "their date lies before such receivers were made";
    case base::Refusal::Satellites:
      return "too few satellites";
    case base::Refusal::Dilution:
      return "the satellites stand badly";
    case base::Refusal::Accuracy:
      return "the receiver itself is not sure enough";
    case base::Refusal::Disturbed:
      return "a turn on the spot disturbs them";
    case base::Refusal::Jump:
      return "they contradict what the robot did";
    case base::Refusal::Receivers:
      return "two receivers say different places";
    case base::Refusal::Outvoted:
      return "the other sensors contradict them";
  }
  return {};
}

}  // namespace

std::string tenths_of(double value) {
  const long rounded = std::lround(std::abs(value) * 10.0);
  return std::to_string(rounded / 10) + "." + std::to_string(rounded % 10);
}

const std::vector<EstimateWatch::News>& EstimateWatch::step(const base::EstimatorHealth& health,
                                                            base::FixType fix, Time now) {
  news_.clear();
  watch_resets(health);
  if (health.gyro != gyro_) {
    gyro_ = health.gyro;
    gyro_known_ = gyro_known_ || gyro_;
    tell(gyro_ ? Severity::Info : Severity::Warning, gyro_ ? "gyro_back" : "gyro_lost",
         gyro_ ? "turns are measured by the gyro"
               : "the gyro is silent: turns are measured by the tracks");
  }
  if (health.alignment != alignment_) {
    const bool found = health.alignment == base::Alignment::Aligned;
    if (found) tell(Severity::Info, "heading_found", "the heading is known");
    if (alignment_ == base::Alignment::Aligned) {
      tell(Severity::Warning, "heading_lost", "the heading is not certain any more");
    }
    alignment_ = health.alignment;
  }
  anchor_lost_ = anchored_ && !health.anchor;
  if (anchor_lost_) {
    anchored_ = false;
    tell(Severity::Warning, "anchor_dropped", "the anchor was dropped: the fix class changed");
  }
  watch_refusals(health, now);
  watch_fix(fix, now);
  return news_;
}

void EstimateWatch::watch_resets(const base::EstimatorHealth& health) {
  if (health.resets == resets_) return;
  resets_ = health.resets;
  const auto& reset = health.last_reset;
  const bool map = reset && reset->what == "map";
  std::string detail = map ? "its place in the map is not where it was believed to be: "
                           : "the sensors contradicted the estimate for too long: ";
  if (reset) {
    detail += std::string(map ? "the estimate" : reset->what) + " set anew, moved by " +
              tenths_of(std::hypot(reset->jump.east_m, reset->jump.north_m)) + " m, turned by " +
              tenths_of(base::deg_from_rad(reset->jump_rad)) + " deg";
  }
  tell(Severity::Warning, "estimate_reset", std::move(detail));
}

void EstimateWatch::watch_refusals(const base::EstimatorHealth& health, Time now) {
  struct Watched {
    const base::InputHealth& input;
    const char* what;
  };
  const std::array<Watched, 4> inputs{{{health.position, "positions of the receiver"},
                                       {health.velocity, "velocities of the receiver"},
                                       {health.heading, "headings of the antennas"},
                                       {health.odometry, "distances of the base"}}};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto& since = inputs[i].input.refused_since;
    const bool lasts = since && now - *since >= kRefusedLasts;
    if (lasts == refusal_told_[i]) continue;
    refusal_told_[i] = lasts;
    if (lasts) {
      tell(Severity::Warning, "input_refused",
           std::string(inputs[i].what) + " are not used: " + cause_of(inputs[i].input.why));
    } else {
      tell(Severity::Info, "input_used", std::string(inputs[i].what) + " are used again");
    }
  }
}

void EstimateWatch::watch_fix(base::FixType fix, Time now) {
  if (fix != fix_seen_) {
    fix_seen_ = fix;
    fix_since_ = now;
  }
  if (fix_seen_ == fix_told_ || now - fix_since_ < kFixLasts) return;
  const bool worse = fix_seen_ < fix_told_;
  fix_told_ = fix_seen_;
  tell(worse ? Severity::Warning : Severity::Info, "gnss_fix",
       "GNSS fix is " + std::string(base::to_string(fix_seen_)));
}

}  // namespace roverd::robot
