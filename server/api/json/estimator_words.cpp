// How well the robot knows where it is, for GET /vehicle and the stream.

#include <algorithm>
#include <cmath>

#include "api/json/measured.hpp"
#include "api/json/words.hpp"
#include "base/angle.hpp"

namespace roverd::api {

namespace {

Json metres_json(base::EnuPoint p) {
  return {{"east_m", rounded(p.east_m, 1e3)}, {"north_m", rounded(p.north_m, 1e3)}};
}

/// What was measured last against what was expected, and its square in units of its variance.
void add_innovation(Json& out, const std::string& name, const std::string& unit,
                    const base::InputHealth& input, double scale) {
  const auto& i = input.innovation;
  out[name + unit] = i ? rounded(i->size * scale, 1e3) : Json(nullptr);
  out[name + "_nis"] = i ? rounded(i->nis, 1e2) : Json(nullptr);
}

Json innovations_json(const base::EstimatorHealth& e) {
  Json out = Json::object();
  add_innovation(out, "position", "_m", e.position, 1.0);
  add_innovation(out, "velocity", "_mps", e.velocity, 1.0);
  // A compass that reads too far clockwise has a smaller yaw than expected.
  add_innovation(out, "compass", "_deg", e.compass, -base::deg_from_rad(1.0));
  add_innovation(out, "heading", "_deg", e.heading, -base::deg_from_rad(1.0));
  return out;
}

Json rejected_json(const base::EstimatorHealth& e) {
  return {{"position", e.position.rejected}, {"velocity", e.velocity.rejected},
          {"compass", e.compass.rejected},   {"heading", e.heading.rejected},
          {"odometry", e.odometry.rejected}, {"inertial", e.inertial.rejected}};
}

Json refusals_json(const base::EstimatorHealth& e) {
  Json out = Json::object();
  for (std::size_t i = 0; i < base::kRefusals; ++i) {
    out[std::string(base::to_string(static_cast<base::Refusal>(i)))] = e.refusals[i];
  }
  return out;
}

Json reset_json(const std::optional<base::EstimateReset>& reset, base::Time now) {
  if (!reset) return nullptr;
  // The jump is old minus new, and yaw turns the other way round than a compass.
  return {{"what", reset->what},
          {"moved_m", rounded(std::hypot(reset->jump.east_m, reset->jump.north_m), 1e3)},
          {"turned_deg", rounded(base::deg_from_rad(reset->jump_rad), 1e2)},
          {"age_s", rounded(std::max(0.0, base::seconds(now - reset->stamp)), 1e2)}};
}

Json anchor_json(const std::optional<base::Anchor>& anchor, base::Time now) {
  if (!anchor) return nullptr;
  Json out = metres_json(anchor->offset);
  out["lat"] = rounded(anchor->at.lat, 1e9);
  out["lon"] = rounded(anchor->at.lon, 1e9);
  out["item"] = anchor->item ? Json(*anchor->item) : Json(nullptr);
  out["age_s"] = rounded(std::max(0.0, base::seconds(now - anchor->stamp)), 1e2);
  return out;
}

Json shift_json(const std::optional<base::BaseShift>& shift, base::Time now) {
  if (!shift) return nullptr;
  Json out = metres_json(shift->offset);
  out["age_s"] = rounded(std::max(0.0, base::seconds(now - shift->since)), 1e2);
  return out;
}

/// Clockwise positive, as headings are.
Json askew_json(const std::optional<base::Askew>& askew) {
  if (!askew) return nullptr;
  return {{"offset_deg", rounded(-base::deg_from_rad(askew->offset_rad), 1e2)},
          {"sigma_deg", rounded(base::deg_from_rad(askew->sigma_rad), 1e2)},
          {"way_m", rounded(askew->way_m, 1e1)}};
}

Json votes_json(const base::Votes& v, base::Time now) {
  Json out = Json::object();
  Json& sensors = out["sensors"] = Json::object();
  for (std::size_t i = 0; i < base::kSenses; ++i) {
    const base::SenseVote& vote = v.of[i];
    Json& one = sensors[std::string(base::to_string(static_cast<base::Sense>(i)))];
    one = {{"heard", vote.heard}, {"frozen", vote.frozen}, {"left_out", vote.left_out}};
    one["left_out_s"] =
        vote.since ? rounded(std::max(0.0, base::seconds(now - *vote.since)), 1e1) : Json(nullptr);
  }
  out["undecided"] = nullptr;
  if (v.undecided) {
    out["undecided"] = {base::to_string((*v.undecided)[0]), base::to_string((*v.undecided)[1])};
  }
  out["doubt_m"] = rounded(v.doubt_m, 1e2);
  out["doubt_deg"] = rounded(base::deg_from_rad(v.doubt_rad), 1e1);
  out["contradictions"] = v.accusations;
  return out;
}

}  // namespace

/// What was set, what was learned, and which of the two is used.
Json learned_json(const base::VehicleLearned& l) {
  const auto value = [](const std::optional<base::LearnedNumber>& n) {
    return n ? rounded(n->value, 1e3) : Json(nullptr);
  };
  const auto sigma = [](const std::optional<base::LearnedNumber>& n) {
    return n ? rounded(n->sigma, 1e3) : Json(nullptr);
  };
  return {{"delay_s", value(l.delay_s)},
          {"delay_sigma_s", sigma(l.delay_s)},
          {"delay_set_s", rounded(l.delay_set_s, 1e3)},
          {"delay_used_s", rounded(l.delay_used_s, 1e3)},
          {"braking_mps2", value(l.braking_mps2)},
          {"braking_sigma_mps2", sigma(l.braking_mps2)},
          {"braking_set_mps2", rounded(l.braking_set_mps2, 1e3)},
          {"braking_used_mps2", rounded(l.braking_used_mps2, 1e3)},
          {"braking_proved", l.braking_proved},
          {"acceleration_mps2", value(l.acceleration_mps2)},
          {"acceleration_set_mps2", rounded(l.acceleration_set_mps2, 1e3)},
          {"acceleration_used_mps2", rounded(l.acceleration_used_mps2, 1e3)},
          {"calibrated", l.kept}};
}

Json estimator_json(const base::Snapshot& s) {
  const base::EstimatorHealth& e = s.estimator;
  const bool compass = s.pose && e.compass_heard;
  return {{"alignment", base::to_string(e.alignment)},
          {"advice", e.advice.empty() ? Json(nullptr) : Json(e.advice)},
          {"gyro", e.gyro},
          {"gyro_bias_dps", e.gyro_bias_radps ? rounded(base::deg_from_rad(*e.gyro_bias_radps), 1e3)
                                              : Json(nullptr)},
          {"compass_bias_deg",
           compass ? rounded(-base::deg_from_rad(e.compass_bias_rad), 1e2) : Json(nullptr)},
          {"odometry_scale", s.pose ? rounded(e.odometry_scale, 1e4) : Json(nullptr)},
          {"pull_1pm", s.pose ? rounded(e.pull_1pm, 1e4) : Json(nullptr)},
          {"pivot_m", s.pose ? rounded(e.pivot_m, 1e3) : Json(nullptr)},
          {"side_slip", s.pose ? rounded(e.side_slip, 1e4) : Json(nullptr)},
          {"gnss_offset", e.gnss_offset ? metres_json(*e.gnss_offset) : Json(nullptr)},
          {"innovations", innovations_json(e)},
          {"rejected", rejected_json(e)},
          {"refusals", refusals_json(e)},
          {"without_gnss_m", s.pose ? rounded(e.free_m, 1e2) : Json(nullptr)},
          {"resets", e.resets},
          {"last_reset", reset_json(e.last_reset, s.now)},
          {"anchor", anchor_json(e.anchor, s.now)},
          {"base_shift", shift_json(e.base_shift, s.now)},
          {"antennas_askew", askew_json(e.antennas_askew)},
          {"antennas_offset_deg", rounded(-base::deg_from_rad(e.antennas_offset_rad), 1e2)},
          {"votes", votes_json(e.votes, s.now)}};
}

}  // namespace roverd::api
