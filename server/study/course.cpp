// The mission that a course is.

#include <cmath>
#include <cstdint>

#include "base/angle.hpp"
#include "mission/edit/teach.hpp"
#include "study/study.hpp"

namespace roverd::study {
namespace {

constexpr double kSample_s = 0.2;  // of a teach-in

/// The same numbers everywhere. Source: Steele et al. 2014 (SplitMix).
class Noise {
 public:
  Noise(double sigma, std::uint64_t seed) : sigma_(sigma), state_(seed) {}

  base::EnuPoint next() {
    const double radius = sigma_ * std::sqrt(-2.0 * std::log(1.0 - part()));
    const double angle = 2.0 * base::kPi * part();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

 private:
  double part() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1.0p-53;
  }

  double sigma_;
  std::uint64_t state_;
};

/// Points so far apart along a polyline, its ends among them.
std::vector<base::EnuPoint> sampled(const Course& course, std::uint64_t seed) {
  Noise noise(course.noise_m, seed);
  std::vector<base::EnuPoint> out;
  double left_m = 0.0;  // until the next one
  for (std::size_t i = 0; i + 1 < course.points.size(); ++i) {
    const base::EnuPoint a = course.points[i];
    const base::EnuPoint d = course.points[i + 1] - a;
    const double length_m = std::hypot(d.east_m, d.north_m);
    double at_m = left_m;
    for (; at_m < length_m; at_m += course.every_m) {
      const double part = at_m / length_m;
      out.push_back(a + base::EnuPoint{part * d.east_m, part * d.north_m} + noise.next());
    }
    left_m = at_m - length_m;
  }
  out.push_back(course.points.back() + noise.next());
  return out;
}

std::vector<mission::TaughtPoint> taught(const std::vector<base::EnuPoint>& samples,
                                         const Course& course, const base::LocalFrame& frame) {
  mission::Sampler sampler{mission::TeachSettings{}};
  std::vector<mission::TaughtPoint> out;
  const auto keep = [&out](const std::vector<mission::TaughtPoint>& points) {
    out.insert(out.end(), points.begin(), points.end());
  };
  base::Time now{};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    // The gyro makes the heading smoother than the positions are: over a metre.
    const auto reach = static_cast<std::size_t>(std::ceil(0.5 / course.every_m));
    const base::EnuPoint way =
        samples[std::min(i + reach, samples.size() - 1)] - samples[i - std::min(i, reach)];
    keep(sampler.take({now, frame.to_global(samples[i]), std::atan2(way.north_m, way.east_m),
                       course.every_m / kSample_s, true}));
    now += std::chrono::milliseconds(200);
  }
  keep(sampler.finish());
  return out;
}

}  // namespace

mission::Plan plan_of(const Course& course, const base::LocalFrame& frame, std::uint64_t seed) {
  mission::Plan plan;
  if (course.plan) {
    plan = *course.plan;
  } else {
    const auto points = course.every_m > 0.0 ? sampled(course, seed) : course.points;
    for (const base::EnuPoint& p : points) {
      mission::Waypoint w;
      w.at = frame.to_global(p);
      w.turn = course.turn;
      w.reverse = course.reverse;
      plan.items.emplace_back(w);
    }
    if (course.taught) {
      const mission::TeachSettings settings;
      auto made =
          mission::mission_of(taught(points, course, frame), course.name, settings.tolerance_m);
      if (made) plan = std::move(*made);
    }
    plan.name = course.name;
  }
  if (!plan.settings.speed_mps) plan.settings.speed_mps = course.speed_mps;
  return plan;
}

}  // namespace roverd::study
