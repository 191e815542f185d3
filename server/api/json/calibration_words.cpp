// A calibration drive in the words of the public interface: angles in degrees, headings clockwise.

#include "api/json/measured.hpp"
#include "api/json/words.hpp"
#include "base/angle.hpp"

namespace roverd::api {

namespace {

using base::Quantity;

/// What it is told in, and how much of that one of its own is.
struct Unit {
  const char* name;
  double factor;
};

Unit unit_of(Quantity q) noexcept {
  const double deg = base::deg_from_rad(1.0);
  switch (q) {
    case Quantity::SteeringDelay:
    case Quantity::DriveDelay:
      return {"s", 1.0};
    case Quantity::Braking:
    case Quantity::Acceleration:
      return {"m/s²", 1.0};
    case Quantity::SpeedScale:
    case Quantity::TurnScale:
      return {"", 1.0};
    case Quantity::SideBias:
      return {"1/m", 1.0};
    case Quantity::SteeringZero:
    case Quantity::CompassSpread:
      return {"deg", deg};
    case Quantity::CompassOffset:
    case Quantity::AntennasOffset:
      return {"deg", -deg};  // a heading counts clockwise
  }
  return {"", 1.0};
}

Json value_json(const base::CalibrationValue& v) {
  const Unit unit = unit_of(v.of);
  const auto told = [&](const std::optional<double>& x) {
    return x ? rounded(unit.factor * *x, 1e4) : Json(nullptr);
  };
  const bool turned = unit.factor < 0.0;
  return {{"quantity", base::to_string(v.of)},
          {"unit", unit.name},
          {"before", told(v.before)},
          {"after", told(v.after)},
          {"sigma", v.after ? rounded(std::abs(unit.factor) * v.sigma, 1e4) : Json(nullptr)},
          {"least", told(turned ? v.most : v.least)},
          {"most", told(turned ? v.least : v.most)},
          {"inside", v.inside()},
          {"at_least", v.at_least},
          {"keeps", v.keeps}};
}

Json space_json(const base::CalibrationSpace& s) {
  return {{"ahead_m", rounded(s.ahead_m, 1e1)},
          {"behind_m", rounded(s.behind_m, 1e1)},
          {"left_m", rounded(s.left_m, 1e1)},
          {"right_m", rounded(s.right_m, 1e1)}};
}

}  // namespace

Json calibration_json(const base::Snapshot& snapshot) {
  const base::CalibrationState& c = snapshot.calibration;
  const bool any = c.phase != base::CalibrationPhase::None;
  const bool running = c.phase == base::CalibrationPhase::Running;
  Json values = Json::array();
  for (std::size_t i = 0; any && i < c.count; ++i) values.push_back(value_json(c.values[i]));
  return {{"id", c.id},
          {"state", base::to_string(c.phase)},
          {"kind", any ? Json(base::to_string(c.kind)) : Json(nullptr)},
          {"reason", any ? c.reason : std::string()},
          {"step", running ? Json(c.step) : Json(nullptr)},
          {"steps_done", any ? c.steps_done : 0},
          {"steps", any ? c.steps : 0},
          {"share", rounded(any ? c.share : 0.0, 1e3)},
          {"left_s", running ? rounded(c.left_s, 1e0) : Json(nullptr)},
          {"values", std::move(values)},
          {"kept", snapshot.learned.kept}};
}

Json calibration_preview_json(const robot::CalibrationPreview& preview) {
  Json corners = Json::array();
  for (const base::LatLon& at : preview.corners) {
    corners.push_back({{"lat", at.lat}, {"lon", at.lon}});
  }
  return {{"kind", base::to_string(preview.kind)},
          {"possible", preview.possible},
          {"reason", preview.reason},
          {"space", space_json(preview.space)},
          {"seconds", rounded(preview.seconds, 1e0)},
          {"corners", std::move(corners)}};
}

}  // namespace roverd::api
