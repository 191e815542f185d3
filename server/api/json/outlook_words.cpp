// What the sensors see, in the words of the interface: on the map where the robot's own pose is
// known, and about the robot in any case.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/measured.hpp"
#include "api/json/words.hpp"
#include "base/angle.hpp"

namespace roverd::api {
namespace {

using robot::Outlook;

constexpr double kSame_m = 0.3;  // what the guard found belongs to the thing that is so near

struct Plane {
  double x = 0.0;
  double y = 0.0;
  double yaw_rad = 0.0;
};

/// X_AC = X_AB X_BC.
Plane operator*(const Plane& ab, const Plane& bc) noexcept {
  const double c = std::cos(ab.yaw_rad);
  const double s = std::sin(ab.yaw_rad);
  return {ab.x + c * bc.x - s * bc.y, ab.y + s * bc.x + c * bc.y, ab.yaw_rad + bc.yaw_rad};
}

Plane inverse_of(const Plane& ab) noexcept {
  const double c = std::cos(ab.yaw_rad);
  const double s = std::sin(ab.yaw_rad);
  return {-c * ab.x - s * ab.y, s * ab.x - c * ab.y, -ab.yaw_rad};
}

Plane plane_of(const base::OdometryPlace& at) noexcept {
  return {at.x_m, at.y_m, at.yaw_rad};
}

/// From O of the odometry to the map and to the body as it stands now.
class Places {
 public:
  explicit Places(const base::Snapshot& s) {
    if (!s.odometry) return;
    now_ = inverse_of(plane_of(*s.odometry));
    if (!s.pose || !s.frame || !s.pose->heading_known) return;
    map_ = Plane{s.pose->at.east_m, s.pose->at.north_m, s.pose->yaw_rad} * now_;
    frame_ = s.frame;
  }

  /// Where it is, and where its x axis points; null: the robot does not know where it is.
  Json on_map(const Plane& in_o) const {
    if (!frame_) return nullptr;
    const Plane at = map_ * in_o;
    const base::LatLon global = frame_->to_global({at.x, at.y});
    return {{"lat", rounded(global.lat, kPlaces8)},
            {"lon", rounded(global.lon, kPlaces8)},
            {"heading_deg", rounded(base::heading_from_yaw(at.yaw_rad), kPlaces2)}};
  }
  Plane on_body(const Plane& in_o) const noexcept { return now_ * in_o; }

 private:
  Plane now_{};  // X_BO
  Plane map_{};  // X_EO
  std::optional<base::LocalFrame> frame_;
};

Json age_json(const Outlook& seen, base::Time now) {
  return rounded(std::max(0.0, base::seconds(now - seen.stamp)), kPlaces2);
}

std::string stamp_json(const Outlook& seen, base::Time now) {
  const auto age = std::chrono::duration_cast<std::chrono::milliseconds>(now - seen.stamp);
  return base::to_rfc3339(base::wall_now() - age);
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = (three << 8U) | (k < left ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= left ? kDigits[(three >> (18U - 6U * k)) & 63U] : '=';
    }
  }
  return out;
}

/// The thing of which the guard says that it is in the way; the number of them: none is.
std::size_t in_the_way(const Outlook& seen, const Places& places, const base::Snapshot& s) {
  const bool stands = s.obstacle && (s.obstacle->what == "obstacle" || s.obstacle->what == "drop");
  if (!stands) return seen.things.size();
  std::size_t found = seen.things.size();
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < seen.things.size(); ++i) {
    const Outlook::Thing& t = seen.things[i];
    if (t.drop != (s.obstacle->what == "drop")) continue;
    const Plane at = places.on_body(plane_of(seen.at) * Plane{t.ahead_m, t.left_m, 0.0});
    const double away_m = std::hypot(at.x - s.obstacle->ahead_m, at.y - s.obstacle->left_m);
    if (away_m > std::max(kSame_m, t.size_m) || away_m >= nearest_m) continue;
    nearest_m = away_m;
    found = i;
  }
  return found;
}

Json thing_json(const Outlook& seen, const Outlook::Thing& t, const Places& places, base::Time now,
                bool blocks) {
  const Plane in_o = plane_of(seen.at) * Plane{t.ahead_m, t.left_m, 0.0};
  const Plane at = places.on_body(in_o);
  const Json place = places.on_map(in_o);
  const double age_s = t.age_s + std::max(0.0, base::seconds(now - seen.stamp));
  return {{"what", t.drop ? "drop" : "obstacle"},
          {"lat", place.is_null() ? Json(nullptr) : place["lat"]},
          {"lon", place.is_null() ? Json(nullptr) : place["lon"]},
          {"distance_m", rounded(std::hypot(at.x, at.y), kPlaces2)},
          // Bearings on the body count clockwise.
          {"bearing_deg", degrees(-std::atan2(at.y, at.x))},
          {"clearance_m", rounded(t.clearance_m, kPlaces2)},
          {"size_m", rounded(t.size_m, kPlaces2)},
          {"age_s", rounded(age_s, kPlaces2)},
          {"sensor", t.sensor.empty() ? Json(nullptr) : Json(t.sensor)},
          {"on_way", t.on_way || blocks}};
}

int centimetres(double m) noexcept {
  return static_cast<int>(std::lround(m * 100.0));
}

Json dots_json(const Outlook::Scan& scan, base::Time now) {
  std::array<Json, 4> dots{Json::array(), Json::array(), Json::array(), Json::array()};
  for (const Outlook::Spot& spot : scan.spots) {
    Json& list = dots[static_cast<std::size_t>(spot.dot)];
    list.push_back(centimetres(double(spot.ahead_m)));
    list.push_back(centimetres(double(spot.left_m)));
  }
  return {{"sensor", scan.sensor},
          {"age_s", rounded(std::max(0.0, base::seconds(now - scan.seen)), kPlaces2)},
          {"obstacle_cm", std::move(dots[0])},
          {"overhang_cm", std::move(dots[1])},
          {"drop_cm", std::move(dots[2])},
          {"passing_cm", std::move(dots[3])}};
}

}  // namespace

Json obstacles_json(const Outlook* seen, const base::Snapshot& s, base::Time now) {
  Json items = Json::array();
  if (seen == nullptr) return {{"age_s", nullptr}, {"complete", true}, {"items", std::move(items)}};
  const Places places(s);
  const std::size_t blocks = in_the_way(*seen, places, s);
  for (std::size_t i = 0; i < seen->things.size(); ++i) {
    items.push_back(thing_json(*seen, seen->things[i], places, now, i == blocks));
  }
  return {{"age_s", age_json(*seen, now)},
          {"complete", seen->things.size() < Outlook::kMostThings},
          {"items", std::move(items)}};
}

Json scan_json(const Outlook& seen, const base::Snapshot& s, base::Time now) {
  Json hit_cm = Json::array();
  Json free_cm = Json::array();
  for (const Outlook::Ray& ray : seen.rays) {
    hit_cm.push_back(centimetres(double(ray.hit_m)));
    free_cm.push_back(centimetres(double(ray.free_m)));
  }
  Json ranges_m = Json::array();
  for (const Outlook::Ray& ray : seen.rays) {
    ranges_m.push_back(ray.hit_m > 0.0F ? rounded(double(ray.hit_m), kPlaces2) : Json(nullptr));
  }
  Json sensors = Json::array();
  for (const Outlook::Scan& scan : seen.scans) sensors.push_back(dots_json(scan, now));
  return {{"age_s", age_json(seen, now)},
          {"sensor", "all"},
          {"stamp", stamp_json(seen, now)},
          {"angle_min_deg", -180},
          {"angle_step_deg", 1},
          {"ranges_m", std::move(ranges_m)},
          {"at", Places(s).on_map(plane_of(seen.at))},
          {"begin_deg", -180},
          {"step_deg", 1},
          {"hit_cm", std::move(hit_cm)},
          {"free_cm", std::move(free_cm)},
          {"sensors", std::move(sensors)}};
}

Json grid_json(const Outlook& seen, const base::Snapshot& s, base::Time now) {
  const Places places(s);
  const Plane corner{seen.grid.x_m, seen.grid.y_m, 0.0};
  const Plane from_body = places.on_body(corner);
  return {{"age_s", age_json(seen, now)},
          {"at", places.on_map(corner)},
          {"from_robot",
           {{"ahead_m", rounded(from_body.x, kPlaces3)},
            {"left_m", rounded(from_body.y, kPlaces3)},
            {"turn_deg", degrees(base::wrap_rad(from_body.yaw_rad))}}},
          {"cell_m", rounded(seen.grid.cell_m, kPlaces3)},
          {"columns", seen.grid.side},
          {"rows", seen.grid.side},
          {"runs", base64(seen.grid.runs)}};
}

}  // namespace roverd::api
