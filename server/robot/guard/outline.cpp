#include "robot/guard/outline.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angle.hpp"
#include "base/geo.hpp"

namespace roverd::robot {
namespace {

using nav::sense::Footprint;
using nav::sense::Vec2;

constexpr double kCouplingTurns_rad = base::kPi / 3.0;
constexpr int kArc = 10;  // corners of the far side; with the others at most 16

}  // namespace

base::Result<void> check(const OutlineParams& p) {
  if ((p.length_m > 0.0) == (p.width_m > 0.0)) return {};
  const char* name = p.length_m > 0.0 ? "width_m" : "length_m";
  const std::string detail = "must be given as well: an outline has length_m and width_m";
  return base::fail(base::Code::Invalid, std::string(name) + " " + detail, {{name, detail}});
}

Footprint footprint_of(const nav::VehicleParams& v) noexcept {
  const double back_m = v.steered() ? 0.5 * (v.length_m - v.wheelbase_m) : 0.5 * v.length_m;
  return Footprint::box(v.length_m, v.width_m, std::max(0.01, back_m));
}

Footprint footprint_of(const nav::VehicleParams& vehicle, const nav::ToolParams& tool,
                       const OutlineParams& outline) {
  const Footprint body = footprint_of(vehicle);
  if (!outline.any() || tool.pulled()) return body;
  std::vector<Vec2> corners(body.corners().begin(), body.corners().end());
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      corners.push_back({tool.forward_m + x * outline.length_m, tool.left_m + y * outline.width_m});
    }
  }
  return Footprint::of(corners).value_or(body);
}

std::optional<Footprint> pulled_of(const nav::ToolParams& tool, const OutlineParams& outline) {
  if (!outline.any() || !tool.pulled()) return std::nullopt;
  const double far_m = tool.trailer_m + 0.5 * outline.length_m;
  const double near_m = tool.trailer_m - 0.5 * outline.length_m;
  const double side_m = 0.5 * outline.width_m;
  const auto place = [&tool](double behind_m, double left_m, double turn_rad) {
    const double c = std::cos(turn_rad);
    const double s = std::sin(turn_rad);
    return Vec2{-tool.hitch_m - behind_m * c - left_m * s, -behind_m * s + left_m * c};
  };
  std::vector<Vec2> corners{{-tool.hitch_m, 0.0}};
  for (const double turn : {-kCouplingTurns_rad, kCouplingTurns_rad}) {
    for (const double y : {-side_m, side_m}) corners.push_back(place(near_m, y, turn));
  }
  // Its far corners drive on a circle about the coupling: a chain of corners outside of it.
  const double most_rad = kCouplingTurns_rad + std::atan2(side_m, far_m);
  const double step_rad = 2.0 * most_rad / (kArc - 1);
  const double radius_m = std::hypot(far_m, side_m) / std::cos(0.5 * step_rad);
  for (int i = 0; i < kArc; ++i) {
    corners.push_back(place(radius_m, 0.0, -most_rad + i * step_rad));
  }
  const auto hull = Footprint::of(corners);
  return hull ? std::optional(*hull) : std::nullopt;
}

std::optional<nav::sense::Trailer> trailer_of(const nav::ToolParams& tool,
                                              const OutlineParams& outline) {
  if (!outline.any() || !tool.pulled()) return std::nullopt;
  std::vector<Vec2> corners{{0.0, 0.0}};
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      corners.push_back({-tool.trailer_m + x * outline.length_m, y * outline.width_m});
    }
  }
  const auto body = Footprint::of(corners);
  if (!body) return std::nullopt;
  return nav::sense::Trailer{*body, tool.hitch_m, tool.trailer_m};
}

}  // namespace roverd::robot
