#include "sick/sight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roverd::sick {
namespace {

using base::Echo;
using base::SightPoint;

constexpr double kRadPerE4deg = std::numbers::pi / 180.0 * 1e-4;
constexpr double kFullTurn_e4deg = 3'600'000.0;
constexpr std::int32_t kFarthest_e4deg = 7'200'000;
constexpr std::uint16_t kFirstDistance = 16;  // raw values below are codes

bool is_distance(const Channel& c) noexcept {
  return c.name.starts_with("DIST");
}
bool is_remission(const Channel& c) noexcept {
  return c.name.starts_with("RSSI");
}
bool same_beams(const Channel& a, const Channel& b) noexcept {
  return a.values.size() == b.values.size() && a.start_e4deg == b.start_e4deg &&
         a.step_e4deg == b.step_e4deg;
}

/// One echo of all beams, and its remission where it is told.
struct EchoOf {
  const Channel* distance = nullptr;
  const Channel* remission = nullptr;
};

/// Those that have the beams of the first.
std::vector<EchoOf> echoes_of(const Scan& scan) {
  std::vector<EchoOf> out;
  for (const Channel& c : scan.channels) {
    if (!is_distance(c) || (!out.empty() && !same_beams(*out[0].distance, c))) continue;
    EchoOf echo{&c, nullptr};
    for (const Channel& r : scan.channels) {
      if (is_remission(r) && r.name.substr(4) == c.name.substr(4) && same_beams(r, c)) {
        echo.remission = &r;
      }
    }
    out.push_back(echo);
  }
  return out;
}

std::uint16_t intensity(const EchoOf& echo, std::size_t i) noexcept {
  if (echo.remission == nullptr) return 0;
  const Channel& r = *echo.remission;
  const float value = static_cast<float>(r.values[i]) * r.scale + r.offset;
  return static_cast<std::uint16_t>(std::clamp(value, 0.0F, 65535.0F));
}

struct Ray {
  double x;  ///< of unit length, in S
  double y;
  float after_s;

  SightPoint at(double range_m, Echo echo, std::uint16_t intensity) const noexcept {
    return {.x_m = static_cast<float>(x * range_m),
            .y_m = static_cast<float>(y * range_m),
            .z_m = 0.0F,
            .after_s = after_s,
            .intensity = intensity,
            .ring = 0,
            .echo = echo};
  }
};

void add_beam(base::Sight& out, const std::vector<EchoOf>& echoes, std::size_t i, const Ray& ray) {
  double last_m = 0.0;
  for (const EchoOf& echo : echoes) {
    const Channel& c = *echo.distance;
    if (c.values[i] < kFirstDistance) continue;
    const double range_m = (static_cast<double>(c.values[i]) * c.scale + c.offset) * 1e-3;
    if (range_m <= 0.0 || range_m == last_m) continue;
    out.points.push_back(ray.at(range_m, Echo::Hit, intensity(echo, i)));
    last_m = range_m;
  }
  if (last_m > 0.0) return;
  if (echoes[0].distance->values[i] == 0 && out.clear_to_m > 0.0F) {
    out.points.push_back(ray.at(out.clear_to_m, Echo::Clear, 0));
  } else {
    out.points.push_back(ray.at(1.0, Echo::Unknown, intensity(echoes[0], i)));
  }
}

base::Result<Beams> checked_beams(const Scan& scan) {
  const auto no = [](const char* why) { return base::fail(base::Code::Invalid, why); };
  const auto beams = beams_of(scan);
  if (!beams || beams->count == 0) return no("scan without distances");
  if (std::abs(static_cast<double>(beams->start_e4deg)) > kFarthest_e4deg) {
    return no("scan with an impossible start angle");
  }
  if (beams->count > 1 && beams->step_e4deg == 0) return no("scan without an angle step");
  if (static_cast<double>(beams->count - 1) * beams->step_e4deg > kFullTurn_e4deg) {
    return no("scan over more than a full turn");
  }
  if (beams->frequency_chz < 10 || beams->frequency_chz > 100'000) {
    return no("scan with an impossible frequency");
  }
  return *beams;
}

}  // namespace

std::optional<Beams> beams_of(const Scan& scan) noexcept {
  const auto found = std::find_if(scan.channels.begin(), scan.channels.end(), is_distance);
  if (found == scan.channels.end()) return {};
  return Beams{found->start_e4deg, found->step_e4deg, found->values.size(),
               scan.scan_frequency_chz};
}

double duration_s(const Beams& beams) noexcept {
  if (beams.count < 2 || beams.frequency_chz == 0) return 0.0;
  const double turn = static_cast<double>(beams.count - 1) * beams.step_e4deg / kFullTurn_e4deg;
  return turn * 100.0 / beams.frequency_chz;
}

base::Result<base::Sight> to_sight(const Scan& scan, const SightRules& rules) {
  const auto beams = checked_beams(scan);
  if (!beams) return tl::unexpected<base::Error>(beams.error());
  const Status status = status_of(scan);
  base::Sight out;
  out.half_step_rad = static_cast<float>(beams->step_e4deg * kRadPerE4deg / 2.0);
  out.clear_to_m = static_cast<float>(rules.clear_to_m);
  out.good = status.good;
  out.window = status.blocked ? base::Window::Blocked
               : status.dirty ? base::Window::Dirty
                              : base::Window::Clean;
  const auto echoes = echoes_of(scan);
  const double step_s = beams->step_e4deg / kFullTurn_e4deg * 100.0 / beams->frequency_chz;
  out.points.reserve(beams->count);
  for (std::size_t i = 0; i < beams->count; ++i) {
    const auto n = static_cast<double>(i);
    const double angle_rad =
        (beams->start_e4deg + n * beams->step_e4deg - rules.ahead_deg * 1e4) * kRadPerE4deg;
    add_beam(out, echoes, i,
             {std::cos(angle_rad), std::sin(angle_rad), static_cast<float>(n * step_s)});
  }
  return out;
}

double missing_share(const base::Sight& sight) noexcept {
  if (sight.points.empty()) return 1.0;
  const auto hits = std::count_if(sight.points.begin(), sight.points.end(),
                                  [](const SightPoint& p) { return p.echo == Echo::Hit; });
  return 1.0 - static_cast<double>(hits) / static_cast<double>(sight.points.size());
}

}  // namespace roverd::sick
