#include "ranges/fan.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace roverd::ranges {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kLeastFov_deg = 1.0;
constexpr double kMostFov_deg = 120.0;

struct Limits {
  double min;
  double max;
};

/// @return one number for each range; empty: it is no such list.
std::optional<std::vector<double>> list_of(std::string_view text, int count, Limits limits) {
  std::vector<double> out;
  for (;;) {
    const auto from = text.find_first_not_of(" ,");
    if (from == std::string_view::npos) break;
    text.remove_prefix(from);
    double value = 0.0;
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (ec != std::errc{} || !(value >= limits.min && value <= limits.max)) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && text.front() != ' ' && text.front() != ',') return {};
    out.push_back(value);
  }
  const auto wanted = static_cast<std::size_t>(count);
  if (out.size() == 1) out.resize(wanted, out[0]);
  if (out.size() != wanted) return {};
  return out;
}

struct Lists {
  std::optional<std::vector<double>> bearings_deg;
  std::optional<std::vector<double>> fov_deg;
  std::optional<std::vector<double>> x_m;
  std::optional<std::vector<double>> y_m;
};
Lists lists_of(const Params& p) {
  return {list_of(p.bearings_deg, p.count, {-180.0, 180.0}),
          list_of(p.fov_deg, p.count, {kLeastFov_deg, kMostFov_deg}),
          list_of(p.x_m, p.count, {-10.0, 10.0}), list_of(p.y_m, p.count, {-10.0, 10.0})};
}

base::Result<void> refuse_list(const char* name, int count, const char* range) {
  const std::string detail = "must be 1 or " + std::to_string(count) + " numbers within " + range;
  return base::fail(base::Code::Invalid, std::string(name) + " " + detail, {{name, detail}});
}

}  // namespace

std::optional<double> metres_of(const std::string& unit) {
  if (unit == "m") return 1.0;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  return {};
}

base::Result<void> validate(const Params& p) {
  if (!metres_of(p.unit)) {
    return base::fail(base::Code::Invalid, "unit must be m, cm or mm",
                      {{"unit", "must be m, cm or mm"}});
  }
  const Lists lists = lists_of(p);
  if (!lists.bearings_deg) return refuse_list("bearings_deg", p.count, "-180 .. 180");
  if (!lists.fov_deg) return refuse_list("fov_deg", p.count, "1 .. 120");
  if (!lists.x_m) return refuse_list("x_m", p.count, "-10 .. 10");
  if (!lists.y_m) return refuse_list("y_m", p.count, "-10 .. 10");
  return {};
}

Fans::Fans(const Params& params)
    : max_range_m_(static_cast<float>(params.max_range_m)),
      clear_to_m_(static_cast<float>(params.clear_to_m)) {
  const auto count = static_cast<std::size_t>(params.count);
  const Lists lists = lists_of(params);
  const auto bearings = lists.bearings_deg.value_or(std::vector<double>(count, 0.0));
  const auto fov = lists.fov_deg.value_or(std::vector<double>(count, kMostFov_deg));
  const auto x = lists.x_m.value_or(std::vector<double>(count, 0.0));
  const auto y = lists.y_m.value_or(std::vector<double>(count, 0.0));
  double widest_deg = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double steps = std::max(1.0, std::ceil(fov[i] / params.fan_step_deg - 1e-9));
    widest_deg = std::max(widest_deg, fov[i] / steps);
    Fan fan{static_cast<float>(x[i]), static_cast<float>(y[i])};
    for (int k = 0; k <= static_cast<int>(steps); ++k) {
      const double angle_rad = (bearings[i] + fov[i] * (k / steps - 0.5)) * kRadPerDeg;
      fan.cos.push_back(static_cast<float>(std::cos(angle_rad)));
      fan.sin.push_back(static_cast<float>(std::sin(angle_rad)));
    }
    fans_.push_back(std::move(fan));
  }
  half_step_rad_ = static_cast<float>(widest_deg / 2.0 * kRadPerDeg);
}

void Fans::spread(const std::vector<Reading>& readings, base::Sight& sight) const {
  sight.half_step_rad = half_step_rad_;
  sight.clear_to_m = clear_to_m_;
  for (std::size_t i = 0; i < std::min(readings.size(), fans_.size()); ++i) {
    const Reading& r = readings[i];
    auto range_m = static_cast<float>(r.range_m);
    base::Echo echo = base::Echo::Hit;
    if (r.outcome == Outcome::Refused) {
      echo = base::Echo::Unknown;
      range_m = 1.0F;
    } else if (r.outcome == Outcome::Nothing || range_m > max_range_m_) {
      echo = clear_to_m_ > 0.0F ? base::Echo::Clear : base::Echo::Unknown;
      range_m = clear_to_m_ > 0.0F ? clear_to_m_ : 1.0F;
    }
    const Fan& fan = fans_[i];
    for (std::size_t k = 0; k < fan.cos.size(); ++k) {
      base::SightPoint p;
      p.x_m = fan.x_m + range_m * fan.cos[k];
      p.y_m = fan.y_m + range_m * fan.sin[k];
      p.echo = echo;
      sight.points.push_back(p);
    }
  }
}

}  // namespace roverd::ranges
