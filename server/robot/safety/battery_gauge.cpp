#include "robot/safety/battery_gauge.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace roverd::robot {
namespace {

constexpr double kMost_v = 1000.0;

std::string_view without_blanks(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::optional<double> whole_number(std::string_view text) noexcept {
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::optional<CurvePoint> curve_point(std::string_view text) noexcept {
  const auto gap = text.find(' ');
  if (gap == std::string_view::npos) return {};
  const auto voltage_v = whole_number(text.substr(0, gap));
  const auto charge = whole_number(without_blanks(text.substr(gap)));
  if (!voltage_v || !charge) return {};
  if (*voltage_v < 0.0 || *voltage_v > kMost_v || *charge < 0.0 || *charge > 100.0) return {};
  return CurvePoint{*voltage_v, *charge};
}

tl::unexpected<base::Error> bad(std::string_view part, const char* why) {
  const std::string text = "\"" + std::string(part) + "\" " + why;
  return base::fail(base::Code::Invalid, "curve: " + text, {{"curve", text}});
}

}  // namespace

base::Result<std::vector<CurvePoint>> battery_curve(std::string_view text) {
  std::vector<CurvePoint> points;
  std::string_view left = without_blanks(text);
  while (!left.empty()) {
    const auto comma = left.find(',');
    const std::string_view part = without_blanks(left.substr(0, comma));
    const auto point = curve_point(part);
    if (!point) return bad(part, "must be a voltage (0 to 1000) and a charge (0 to 100)");
    if (!points.empty() && (point->voltage_v <= points.back().voltage_v ||
                            point->charge_pct <= points.back().charge_pct)) {
      return bad(part, "must lie above the point before it, in voltage and in charge");
    }
    points.push_back(*point);
    if (comma == std::string_view::npos) break;
    left = without_blanks(left.substr(comma + 1));
    if (left.empty()) return bad(text, "ends in a comma");
  }
  if (points.size() == 1) return bad(text, "needs at least two points");
  return points;
}

double charge_pct(const std::vector<CurvePoint>& curve, double voltage_v) noexcept {
  const auto above = std::find_if(curve.begin(), curve.end(), [voltage_v](const CurvePoint& p) {
    return p.voltage_v >= voltage_v;
  });
  if (above == curve.begin()) return above->charge_pct;
  if (above == curve.end()) return curve.back().charge_pct;
  const CurvePoint& a = *(above - 1);
  const double part = (voltage_v - a.voltage_v) / (above->voltage_v - a.voltage_v);
  return std::lerp(a.charge_pct, above->charge_pct, part);
}

std::optional<base::BatteryState> BatteryGauge::step(const base::BaseStatus& base) {
  if (params_->curve != read_) {
    read_ = params_->curve;
    curve_ = battery_curve(read_).value_or(std::vector<CurvePoint>{});
  }
  if (curve_.empty() || !base.battery_v || !std::isfinite(*base.battery_v)) return std::nullopt;
  const double dt_s = std::clamp(base::seconds(base.stamp - at_), 0.0, kSmooth_s);
  const double from_v = smooth_v_.value_or(*base.battery_v);
  smooth_v_ = from_v + (*base.battery_v - from_v) * (dt_s / kSmooth_s);
  at_ = base.stamp;
  return base::BatteryState{base.stamp, charge_pct(curve_, *smooth_v_), *base.battery_v, {}, {},
                            {}};
}

}  // namespace roverd::robot
