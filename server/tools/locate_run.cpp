#include "tools/locate_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>
#include <utility>

#include <Eigen/LU>

#include "atlas/unpack.hpp"
#include "base/angle.hpp"
#include "base/time.hpp"

namespace roverd {

namespace {

using nav::sense::Pose2;

bool takes(WhichScans which, std::size_t index) noexcept {
  return which == WhichScans::All || (index % 2 == 1) == (which == WhichScans::Odd);
}

/// @param part 0 to 1. The values are reordered. 0 of none.
double share_of(std::vector<double>& values, double part) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// Of this thread's work alone, however busy the machine is.
double thread_s() noexcept {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Errors {
  Eigen::Matrix3d unsure = Eigen::Matrix3d::Zero();  // covariance of the poses compared with
  std::vector<double> m;
  std::vector<double> deg;
  double nees = 0.0;
  std::size_t within = 0;

  void add(const nav::place::Fix& fix, const Pose2& truth) {
    const Eigen::Vector3d e(fix.pose.x_m - truth.x_m, fix.pose.y_m - truth.y_m,
                            base::angle_diff_rad(truth.yaw_rad, fix.pose.yaw_rad));
    m.push_back(std::hypot(e(0), e(1)));
    deg.push_back(base::deg_from_rad(std::abs(e(2))));
    const Eigen::Matrix3d both = fix.covariance + unsure;
    const double n = e.dot(both.inverse() * e);
    nees += n;
    constexpr double kChi3_95 = 7.81;
    if (n < kChi3_95) ++within;
  }
};

void summarise(Errors& errors, std::vector<double>& ms, LocateFigures& f) {
  f.fixes = errors.m.size();
  for (std::size_t i = 0; i < f.fixes; ++i) {
    if (errors.m[i] > 1.0 || errors.deg[i] > 20.0) ++f.wrong;
  }
  f.median_m = share_of(errors.m, 0.5);
  f.p95_m = share_of(errors.m, 0.95);
  f.max_m = share_of(errors.m, 1.0);
  f.median_deg = share_of(errors.deg, 0.5);
  f.p95_deg = share_of(errors.deg, 0.95);
  const double n = static_cast<double>(std::max<std::size_t>(f.fixes, 1));
  f.nees = errors.nees / n;
  f.within_95 = static_cast<double>(errors.within) / n;
  f.match_p50_ms = share_of(ms, 0.5);
  f.match_p99_ms = share_of(ms, 0.99);
}

}  // namespace

base::Result<std::vector<atlas::CarmenScan>> scans_of_log(base::Bytes file) {
  std::vector<atlas::CarmenScan> scans;
  constexpr std::size_t kMost = 200'000;
  atlas::CarmenReader reader([&](const atlas::CarmenScan& s) {
    if (scans.size() < kMost) scans.push_back(s);
  });
  atlas::Unpacker unpacker([&](base::Bytes b) { reader.feed(b); });
  if (auto fed = unpacker.feed(file); !fed) return tl::unexpected<base::Error>(fed.error());
  if (auto done = unpacker.finish(); !done) return tl::unexpected<base::Error>(done.error());
  reader.finish();
  if (scans.empty()) {
    const std::string why = reader.refused() > 0 ? " (" + reader.first_refused() + ")" : "";
    return base::fail(base::Code::Malformed, "no scan (FLASER) in the log" + why);
  }
  return scans;
}

LocateFigures locate_log(std::shared_ptr<const nav::place::Field> field,
                         const std::vector<atlas::CarmenScan>& scans,
                         const LocateOptions& options) {
  using nav::place::Phase;
  LocateFigures f;
  f.scans = scans.size();
  nav::place::Tracker tracker(std::move(field), options.tracker);
  if (options.with_start && !scans.empty()) {
    // The start holds for the first scan that is used: the odometry carries it there.
    std::size_t first = 0;
    while (first + 1 < scans.size() && !takes(options.use, first)) ++first;
    const Pose2 step = inverse(scans[0].odometry) * scans[first].odometry;
    tracker.set_pose(scans[0].pose * step, 0.1, 0.05);
  }
  Errors errors;
  const double place = options.truth_m * options.truth_m;
  errors.unsure.diagonal() << place, place, options.truth_rad * options.truth_rad;
  std::vector<double> ms;
  bool was_lost = false;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (!takes(options.use, i)) continue;
    const auto stamp = base::Time{} + std::chrono::milliseconds(static_cast<std::int64_t>(i + 1));
    const nav::chart::Scan scan = atlas::scan_of(scans[i], stamp);
    const double begin_s = thread_s();
    const nav::place::Told told = tracker.feed(scan, scans[i].odometry);
    const double took_ms = 1000.0 * (thread_s() - begin_s);
    ++f.used;
    if (f.started_after == 0 && told.fix) f.started_after = f.used;
    const bool lost = told.phase == Phase::Lost;
    if (lost && !was_lost) ++f.lost;
    was_lost = lost;
    if (!lost && told.phase != Phase::Searching) ms.push_back(took_ms);
    if (!takes(options.score, i)) continue;
    ++f.scored;
    if (told.phase == Phase::Doubtful) ++f.doubtful;
    if (told.fix) errors.add(*told.fix, scans[i].pose);
  }
  summarise(errors, ms, f);
  return f;
}

StartFigures start_in_log(std::shared_ptr<const nav::place::Field> field,
                          const std::vector<atlas::CarmenScan>& scans, const LocateOptions& options,
                          std::size_t starts) {
  StartFigures f;
  const std::size_t stride = options.use == WhichScans::All ? 1 : 2;
  const std::size_t needs = stride * StartFigures::kMostScans;
  if (scans.size() <= needs) return f;
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> draw(0, scans.size() - needs - 1);
  std::vector<double> took_scans;
  std::vector<double> ms;
  for (; f.starts < starts; ++f.starts) {
    nav::place::Tracker tracker(field, options.tracker);
    const std::size_t from = draw(random);
    std::size_t used = 0;
    bool told_any = false;
    const double begin_s = thread_s();
    for (std::size_t i = from; i < from + needs && !told_any; ++i) {
      if (!takes(options.use, i)) continue;
      const auto stamp = base::Time{} + std::chrono::milliseconds(static_cast<std::int64_t>(i + 1));
      const nav::place::Told told =
          tracker.feed(atlas::scan_of(scans[i], stamp), scans[i].odometry);
      ++used;
      if (!told.fix) continue;
      told_any = true;
      Errors error;
      error.add(*told.fix, scans[i].pose);
      const bool wrong = error.m[0] > 1.0 || error.deg[0] > 20.0;
      ++(wrong ? f.wrong : used <= StartFigures::kScans ? f.right : f.later);
      took_scans.push_back(static_cast<double>(used));
    }
    if (!told_any) ++f.untold;
    ms.push_back(1000.0 * (thread_s() - begin_s));
  }
  f.median_scans = share_of(took_scans, 0.5);
  f.median_ms = share_of(ms, 0.5);
  return f;
}

std::string figures_text(const StartFigures& f) {
  char text[400];
  std::snprintf(text, sizeof text,
                "starts     %zu without a pose: right within %zu scans %zu, within %zu %zu more, "
                "not told %zu, a wrong place called right %zu\n"
                "one start  median %.0f scans, %.0f ms\n",
                f.starts, StartFigures::kScans, f.right, StartFigures::kMostScans, f.later,
                f.untold, f.wrong, f.median_scans, f.median_ms);
  return text;
}

std::string figures_text(const LocateFigures& f) {
  char text[1200];
  std::snprintf(text, sizeof text,
                "scans      %zu in the log, %zu used, %zu scored\n"
                "poses      %zu, %zu scans doubtful, lost %zu times, %zu poses off by over 1 m or "
                "20 deg\n"
                "first pose after %zu scans\n"
                "place      median %.4f m, 95 %% %.4f m, greatest %.3f m\n"
                "heading    median %.3f deg, 95 %% %.3f deg\n"
                "certainty  mean e' C^-1 e %.2f (3 is honest), %.1f %% within the 95 %% region\n"
                "one scan   median %.2f ms, 99 %% %.2f ms\n",
                f.scans, f.used, f.scored, f.fixes, f.doubtful, f.lost, f.wrong, f.started_after,
                f.median_m, f.p95_m, f.max_m, f.median_deg, f.p95_deg, f.nees, 100.0 * f.within_95,
                f.match_p50_ms, f.match_p99_ms);
  return text;
}

}  // namespace roverd
