#include "nav/estimate/gnss_quality.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {
namespace {

using base::FixType;

struct Row {
  double floor_m;
  Drift drift;
  double velocity_mps;
};

std::optional<Row> row_of(FixType fix) noexcept {
  switch (fix) {
    case FixType::RtkFixed:
      return Row{0.015, {0.0, 60.0}, 0.05};
    case FixType::RtkFloat:
      return Row{0.25, {0.3, 60.0}, 0.10};
    case FixType::Differential:
      return Row{0.5, {0.6, 100.0}, 0.10};
    case FixType::Single:
      return Row{1.0, {1.2, 90.0}, 0.15};
    case FixType::None:
    case FixType::Unknown:
    case FixType::Estimated:
      return std::nullopt;
  }
  return std::nullopt;
}

double white_sigma_m(double floor_m, std::optional<double> reported_m) noexcept {
  const bool usable = reported_m && std::isfinite(*reported_m) && *reported_m > 0.0;
  return usable ? std::max(floor_m, *reported_m) : floor_m;
}

constexpr double kUnsettled_m = 0.10;

}  // namespace

std::optional<GnssQuality> gnss_quality(const base::GnssFix& fix, bool settled,
                                        double drift_scale) noexcept {
  const auto row = row_of(fix.fix);
  if (!row || !fix.position || !base::is_valid(*fix.position)) return std::nullopt;
  double floor_m = row->floor_m;
  if (fix.hdop && std::isfinite(*fix.hdop)) floor_m *= std::clamp(*fix.hdop, 1.0, 20.0);
  if (fix.fix == FixType::RtkFixed && !settled) floor_m = std::max(floor_m, kUnsettled_m);
  GnssQuality q;
  q.sigma_east_m = white_sigma_m(floor_m, fix.sigma_east_m);
  q.sigma_north_m = white_sigma_m(floor_m, fix.sigma_north_m);
  q.drift = {row->drift.sigma_m * drift_scale, row->drift.tau_s};
  q.velocity_sigma_mps = row->velocity_mps;
  return q;
}

double velocity_sigma_mps(FixType fix, std::optional<double> reported_mps) noexcept {
  const auto row = row_of(fix);
  const double by_class = row ? row->velocity_mps : 0.3;
  if (!reported_mps || !std::isfinite(*reported_mps) || *reported_mps <= 0.0) return by_class;
  return std::max(0.05, *reported_mps);
}

}  // namespace roverd::nav
