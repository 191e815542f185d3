#include "nav/estimate/gnss_quality.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {
namespace {

using base::FixType;
using base::Refusal;

struct Row {
  double least_m;
  double typical_m;
  double tau_s;  ///< 0: white
  double velocity_mps;
};

std::optional<Row> row_of(FixType fix) noexcept {
  switch (fix) {
    case FixType::RtkFixed:
      return Row{0.015, 0.015, 0.0, 0.05};
    case FixType::RtkFloat:
      return Row{0.1, 0.35, 60.0, 0.05};
    case FixType::Differential:
      return Row{0.3, 0.8, 100.0, 0.05};
    case FixType::Single:
      return Row{0.5, 1.2, 400.0, 0.055};
    case FixType::None:
    case FixType::Unknown:
    case FixType::Estimated:
      return std::nullopt;
  }
  return std::nullopt;
}

constexpr double kWhitePart = 0.25;
constexpr double kSlowPart = 0.968;  // the squares of both add up to one
constexpr double kUnsettled_m = 0.10;
/// RTK's error is taken as white, but neighbouring epochs err alike: together they tell less.
constexpr double kAlike = 1.5;

std::optional<double> usable(std::optional<double> sigma_m) noexcept {
  return sigma_m && std::isfinite(*sigma_m) && *sigma_m > 0.0 ? sigma_m : std::nullopt;
}

NoQuality problem_of(const base::GnssFix& fix, const GnssLimits& limits) noexcept {
  const base::LatLon& at = *fix.position;
  if (!std::isfinite(at.lat) || !std::isfinite(at.lon)) return Refusal::NotFinite;
  if (!base::is_valid(at)) return Refusal::Impossible;
  if (at.lat == 0.0 && at.lon == 0.0) return Refusal::Zero;
  if (fix.satellites && *fix.satellites < limits.satellites_min) return Refusal::Satellites;
  if (fix.hdop && !(*fix.hdop <= limits.hdop_max)) return Refusal::Dilution;
  for (const auto& sigma_m : {fix.sigma_east_m, fix.sigma_north_m}) {
    if (sigma_m && !(*sigma_m <= limits.sigma_max_m)) return Refusal::Accuracy;
  }
  return std::nullopt;
}

}  // namespace

tl::expected<GnssQuality, NoQuality> gnss_quality(const base::GnssFix& fix, bool settled,
                                                  const GnssLimits& limits) noexcept {
  const auto row = row_of(fix.fix);
  if (!row || !fix.position) return tl::unexpected<NoQuality>(std::nullopt);
  if (const NoQuality why = problem_of(fix, limits)) return tl::unexpected<NoQuality>(why);
  const double spread = fix.hdop ? std::clamp(*fix.hdop, 1.0, 20.0) : 1.0;
  double least_m = row->least_m;
  if (fix.fix == FixType::RtkFixed && !settled) least_m = kUnsettled_m;
  const auto whole_m = [&](std::optional<double> reported_m) {
    return std::max(least_m, usable(reported_m).value_or(row->typical_m * spread));
  };
  const double east_m = whole_m(fix.sigma_east_m);
  const double north_m = whole_m(fix.sigma_north_m);
  GnssQuality q;
  q.sigma_east_m = east_m;
  q.sigma_north_m = north_m;
  if (fix.fix == FixType::RtkFixed && settled) {
    q.sigma_east_m *= kAlike;
    q.sigma_north_m *= kAlike;
  }
  if (row->tau_s > 0.0) {
    q.sigma_east_m *= kWhitePart;
    q.sigma_north_m *= kWhitePart;
    q.drift = {std::max(east_m, north_m) * kSlowPart * limits.drift_scale, row->tau_s};
  }
  return q;
}

double velocity_sigma_mps(FixType fix, std::optional<double> reported_mps) noexcept {
  const auto row = row_of(fix);
  const double by_class = row ? row->velocity_mps : 0.3;
  if (!reported_mps || !std::isfinite(*reported_mps) || *reported_mps <= 0.0) return by_class;
  return std::max(0.05, *reported_mps);
}

}  // namespace roverd::nav
