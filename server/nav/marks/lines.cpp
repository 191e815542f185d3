#include "nav/marks/lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

namespace roverd::nav::marks {
namespace {

using Points = std::span<const Vec2>;

/// A scanner's own noise: residuals below this are no outliers.
constexpr double kNoise_m = 0.01;
constexpr double kOutlier = 2.5;

double beside(const Fit& fit, Vec2 p) noexcept {
  return sense::cross(fit.along, p - fit.centre);
}

Moments moments_of(Points points) noexcept {
  Moments m;
  m.origin = points[points.size() / 2];
  for (const Vec2 p : points) m.add(p);
  return m;
}

/// The trimmed fit of a piece; empty: too few points are left.
std::optional<Line> line_of(Points points, Vec2 eye, const WallParams& params) {
  Moments m = moments_of(points);
  Fit fit = fit_of(m);
  for (int round = 0; round < 2; ++round) {
    const double bound_m = kOutlier * std::max(fit.rms_m, kNoise_m);
    Moments kept;
    kept.origin = m.origin;
    for (const Vec2 p : points) {
      if (std::abs(beside(fit, p)) <= bound_m) kept.add(p);
    }
    if (kept.n < params.min_points) return std::nullopt;
    m = kept;
    fit = fit_of(m);
  }
  const auto at = [&](Vec2 p) {
    return fit.centre + sense::dot(fit.along, p - fit.centre) * fit.along;
  };
  Line line;
  line.from = at(points.front());
  line.to = at(points.back());
  line.normal = {-fit.along.y, fit.along.x};
  if (sense::dot(line.normal, eye - line.from) < 0.0) line.normal = -1.0 * line.normal;
  line.rms_m = fit.rms_m;
  line.points = static_cast<std::size_t>(m.n);
  const double noise_m = std::max(fit.rms_m, 0.5 * kNoise_m) / std::sqrt(m.n);
  line.sigma_m = noise_m;
  line.sigma_rad = std::min(1.0, noise_m / std::max(fit.spread_m, 1e-3));
  line.moments = m;
  if (line.length_m() < params.min_length_m || line.rms_m > params.max_rms_m) return std::nullopt;
  return line;
}

/// Where a run lies farthest from the line between its ends; 0: nowhere farther than split_m.
std::size_t corner_of(Points points, double split_m) noexcept {
  const Vec2 ahead = points.back() - points.front();
  const double whole = length(ahead);
  std::size_t at = 0;
  double farthest_m = split_m;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 off = points[i] - points.front();
    const double off_m = whole > 1e-6 ? std::abs(sense::cross(ahead, off)) / whole : length(off);
    if (off_m > farthest_m) {
      farthest_m = off_m;
      at = i;
    }
  }
  return at;
}

void split(Points run, Vec2 eye, const WallParams& params, std::vector<Line>& out) {
  // By a list of what is left: a foreign scan must not decide how deep the stack grows.
  std::vector<Points> left{run};
  while (!left.empty()) {
    const Points piece = left.back();
    left.pop_back();
    if (static_cast<double>(piece.size()) < params.min_points) continue;
    if (const std::size_t at = corner_of(piece, params.split_m); at > 0) {
      left.push_back(piece.subspan(at));
      left.push_back(piece.first(at + 1));
      continue;
    }
    if (auto line = line_of(piece, eye, params)) out.push_back(std::move(*line));
  }
}

/// Two neighbours that are one line: noise had split them.
bool one_line(const Line& a, const Line& b, const WallParams& params) noexcept {
  if (length(b.from - a.to) > params.jump_m) return false;
  Moments both = a.moments;
  both.add(b.moments);
  const double worse_m = std::max({a.rms_m, b.rms_m, kNoise_m});
  return fit_of(both).rms_m < 1.3 * worse_m;
}

Line joined(const Line& a, const Line& b, Vec2 eye) noexcept {
  Line line = a;
  line.moments.add(b.moments);
  const Fit fit = fit_of(line.moments);
  const auto at = [&](Vec2 p) {
    return fit.centre + sense::dot(fit.along, p - fit.centre) * fit.along;
  };
  line.from = at(a.from);
  line.to = at(b.to);
  line.to_open = b.to_open;
  line.normal = {-fit.along.y, fit.along.x};
  if (sense::dot(line.normal, eye - line.from) < 0.0) line.normal = -1.0 * line.normal;
  line.rms_m = fit.rms_m;
  line.points = a.points + b.points;
  line.sigma_m = std::max(fit.rms_m, 0.5 * kNoise_m) / std::sqrt(line.moments.n);
  line.sigma_rad = std::min(1.0, line.sigma_m / std::max(fit.spread_m, 1e-3));
  return line;
}

}  // namespace

void Moments::add(Vec2 p) noexcept {
  const Vec2 d = p - origin;
  n += 1.0;
  x += d.x;
  y += d.y;
  xx += d.x * d.x;
  xy += d.x * d.y;
  yy += d.y * d.y;
}

void Moments::add(const Moments& o) noexcept {
  if (n == 0.0) {
    *this = o;
    return;
  }
  const Vec2 d = o.origin - origin;
  xx += o.xx + 2.0 * d.x * o.x + o.n * d.x * d.x;
  xy += o.xy + d.x * o.y + d.y * o.x + o.n * d.x * d.y;
  yy += o.yy + 2.0 * d.y * o.y + o.n * d.y * d.y;
  x += o.x + o.n * d.x;
  y += o.y + o.n * d.y;
  n += o.n;
}

void Moments::fade(double by) noexcept {
  for (double* sum : {&n, &x, &y, &xx, &xy, &yy}) *sum *= by;
}

Fit fit_of(const Moments& m) noexcept {
  Fit fit;
  if (m.n <= 0.0) return fit;
  const double cx = m.x / m.n;
  const double cy = m.y / m.n;
  const double sxx = m.xx / m.n - cx * cx;
  const double sxy = m.xy / m.n - cx * cy;
  const double syy = m.yy / m.n - cy * cy;
  const double turn_rad = 0.5 * std::atan2(2.0 * sxy, sxx - syy);
  const double middle = 0.5 * (sxx + syy);
  const double half = std::hypot(0.5 * (sxx - syy), sxy);
  fit.centre = m.origin + Vec2{cx, cy};
  fit.along = {std::cos(turn_rad), std::sin(turn_rad)};
  fit.rms_m = std::sqrt(std::max(0.0, middle - half));
  fit.spread_m = std::sqrt(std::max(0.0, middle + half));
  return fit;
}

double Line::length_m() const noexcept {
  return length(to - from);
}

std::vector<Line> lines_of(const PlanarScan& scan, const WallParams& params) {
  std::vector<Line> out;
  std::vector<Vec2> run;
  const auto end_run = [&] {
    if (!run.empty()) split(run, scan.eye, params, out);
    run.clear();
  };
  for (const Beam& beam : scan.beams) {
    if (!beam.hit) continue;  // a lost echo within a wall is no gap
    if (!run.empty() && length(beam.at - run.back()) > params.jump_m) end_run();
    run.push_back(beam.at);
  }
  end_run();
  // Beyond its first and its last beam the scanner did not look.
  const bool meets = !scan.beams.empty() && !out.empty();
  if (meets && scan.beams.front().hit) {
    out.front().from_open = length(out.front().from - scan.beams.front().at) < params.jump_m;
  }
  if (meets && scan.beams.back().hit) {
    out.back().to_open = length(out.back().to - scan.beams.back().at) < params.jump_m;
  }
  std::vector<Line> lines;
  for (Line& line : out) {
    if (!lines.empty() && one_line(lines.back(), line, params)) {
      lines.back() = joined(lines.back(), line, scan.eye);
    } else {
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

}  // namespace roverd::nav::marks
