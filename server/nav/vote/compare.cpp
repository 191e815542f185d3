#include "nav/vote/compare.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/vote/stretch.hpp"

namespace roverd::nav {
namespace {

using base::EnuPoint;
using base::rad_from_deg;
using base::seconds;

constexpr std::array kTurnWindows_s{1.5, 4.0, 8.0, 11.0, 16.0};
constexpr std::array kWayWindows_s{1.0, 1.8, 2.5, 3.3, 5.0, 7.0, 10.0};
constexpr std::array kApartWindows_s{1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0};
constexpr double kTrackWindow_s = 5.6;  // longer, slip and bends add up
constexpr double kChordReach_s = 1.2;   // half a chord of positions, and one of them
constexpr double kMean_s = 1.0;         // directions are averaged at both ends of a window
const double kTurnFloor_rad = rad_from_deg(2.0);
constexpr double kWayFloor_m = 0.10;
constexpr double kWayFloorRtk_m = 0.05;
constexpr double kTrackWayFloor_m = 0.15;
constexpr double kApartFloor_m = 0.03;

const double kGyro_rad = rad_from_deg(0.5);
constexpr double kGyroShare = 0.005;
constexpr double kTracksLeast = 0.25;
constexpr double kTracksMost = 1.25;
constexpr double kPull_1pm = 0.2;
const double kTracks_rad = rad_from_deg(3.0);
const double kCourse_rad = rad_from_deg(1.0);
const double kVague_rad = rad_from_deg(15.0);  // less sure, a direction tells nothing of turns
const double kCompass_rad = rad_from_deg(8.0);
constexpr double kPivotMemory_s = 6.0;
const double kHeading_rad = rad_from_deg(12.0);  // by which a vehicle drives beside its heading

constexpr double kScaleKnown = 0.03;
constexpr double kSpinShare = 0.4;
constexpr double kSpinWindow_s = 1.0;
constexpr double kSpinLeast_m = 0.15;
constexpr double kSlide = 0.1;  // of its speed, at most
constexpr double kSlip = 0.08;  // of dead reckoning, from one moment to the next

double norm(EnuPoint p) noexcept {
  return std::hypot(p.east_m, p.north_m);
}

base::Duration span(double s) noexcept {
  return base::from_seconds(s);
}

/// What one of them makes of a turn, against the reference: between `low` and `high`, give or take.
struct Turned {
  double low_rad = 0.0;
  double high_rad = 0.0;
  double sigma_rad = 0.0;
};

/// Signed way from one interval to the other; 0 where they meet. Directions know no whole turns.
double gap(const Turned& a, const Turned& b) noexcept {
  double least = 1e9;
  for (const double whole : {0.0, -2.0 * base::kPi, 2.0 * base::kPi}) {
    const double above = a.low_rad - b.high_rad + whole;
    const double below = a.high_rad - b.low_rad + whole;
    const double off = above > 0.0 ? above : below < 0.0 ? below : 0.0;
    if (std::abs(off) < std::abs(least)) least = off;
  }
  return least;
}

class Comparer {
 public:
  Comparer(const Facts& facts, double sigmas) noexcept : f_(facts), sigmas_(sigmas) {}

  Table run() noexcept {
    if (f_.curve.empty()) return table_;
    table_.spins = spins();
    for (const double w : kTurnWindows_s) turns(w);
    for (const double w : kWayWindows_s) ways(w);
    if (f_.rtk && heard(Sense::Position) && heard(Sense::Velocity)) runs_apart();
    headings();
    return table_;
  }

 private:
  bool heard(Sense s) const noexcept { return f_.heard[index_of(s)]; }
  bool covers(Sense s, Time begin) const noexcept {
    const auto& from = f_.from[index_of(s)];
    return !from || begin >= *from;
  }

  /// How far before its time a direction was begun to be measured.
  static base::Duration reach(Sense s) noexcept {
    return span(s == Sense::Position ? kChordReach_s : 0.0);
  }

  void put(Sense a, Sense b, Difference off, double limit, double window_way_m) noexcept {
    Finding x;
    x.judged = true;
    x.off = off;
    x.limit = limit;
    const double size = std::abs(off.size);
    x.way_off_m = off.of == Difference::Of::Way ? size : std::min(size, 1.0) * window_way_m * 0.5;
    x.heading_off_rad = off.of == Difference::Of::Way ? 0.0 : size;
    table_.put(a, b, x);
  }

  /// The tracks told all of their way between the two, and did not spin.
  bool counted(const Moment& from, const Moment& to) const noexcept {
    if (from.track_run != to.track_run || !f_.tracks_at) return false;
    if (seconds(to.t - *f_.tracks_at) > kTracksLate_s) return false;
    return !table_.spins && (!f_.spun || from.t > *f_.spun);
  }

  // ---- turns -----------------------------------------------------------------------------------

  void turns(double w) noexcept {
    const Time end = f_.curve.newest().t;
    for (std::size_t i = 0; i < kSenses; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const Sense a = static_cast<Sense>(k);
        const Sense b = static_cast<Sense>(i);
        if (heard(a) && heard(b)) turn_pair(a, b, std::min({end, last(a), last(b)}), w);
      }
    }
  }

  /// When it spoke last.
  Time last(Sense s) const noexcept {
    if (s == Sense::Tracks || s == Sense::Gyro) return f_.curve.newest().t;
    const Bearings& b = f_.bearings[index_of(s)];
    return b.empty() ? Time{} : b.newest().t;
  }

  /// Where a window begins and ends, and the middles of what is averaged there.
  struct Ends {
    Time end{};
    double window_s = 0.0;
    std::array<std::optional<Moment>, 4> moments{};
  };

  /// Most pairs ask for the same one.
  const Ends& ends(Time end, double w) noexcept {
    if (ends_.window_s != w || ends_.end != end) {
      const auto& curve = f_.curve;
      ends_ = {end,
               w,
               {curve.at(end - span(w + kMean_s)), curve.at(end - span(w + 0.5 * kMean_s)),
                curve.at(end - span(0.5 * kMean_s)), curve.at(end)}};
    }
    return ends_;
  }

  void turn_pair(Sense a, Sense b, Time end, double w) noexcept {
    const Time begin = end - span(w + kMean_s);
    if (!covers(a, begin - reach(a)) || !covers(b, begin - reach(b))) return;
    const Ends& at = ends(end, w);
    const auto& [first, from, to, newest] = at.moments;
    if (!from || !to || !first || !newest || first->ref_run != newest->ref_run) return;
    auto one = turned(a, *from, *to, end, w);
    const auto two = turned(b, *from, *to, end, w);
    if (!one || !two) return;
    if (is_course(a) != is_course(b)) {
      const double slid_rad = slid(*from, *to);
      one->low_rad -= slid_rad;
      one->high_rad += slid_rad;
    }
    const double limit = sigmas_ * std::hypot(one->sigma_rad, two->sigma_rad) + kTurnFloor_rad;
    put(a, b, {Difference::Of::Turn, gap(*one, *two), w}, limit, to->path_m - from->path_m);
  }

  static bool is_course(Sense s) noexcept { return s == Sense::Position || s == Sense::Velocity; }

  /// On a slope a vehicle slides beside its heading: after a turn, or backwards, to the other side.
  static double slid(const Moment& from, const Moment& to) noexcept {
    const double path_m = to.path_m - from.path_m;
    if (std::abs(to.ahead_m - from.ahead_m) < 0.9 * path_m) return 2.0 * kSlide;
    const double turn_rad =
        std::min(std::abs(to.ref_rad - from.ref_rad), std::abs(to.turn_rad - from.turn_rad));
    return 2.0 * kSlide * std::sin(0.5 * std::min(turn_rad, base::kPi));
  }

  std::optional<Turned> turned(Sense s, const Moment& from, const Moment& to, Time end,
                               double w) const noexcept {
    const double ref_rad = to.ref_rad - from.ref_rad;
    if (s == Sense::Gyro) {
      if (from.gyro_run != to.gyro_run) return std::nullopt;
      const double turn_rad = to.gyro_rad - from.gyro_rad;
      const double sigma =
          kGyro_rad + kGyroShare * std::abs(turn_rad) + f_.gyro_bias_sigma_radps * w;
      return Turned{turn_rad - ref_rad, turn_rad - ref_rad, sigma};
    }
    if (s == Sense::Tracks) {
      if (!counted(from, to)) return std::nullopt;
      const double turn_rad = to.turn_rad - from.turn_rad;
      const double less = std::min(kTracksLeast * turn_rad, kTracksMost * turn_rad);
      const double more = std::max(kTracksLeast * turn_rad, kTracksMost * turn_rad);
      // Learned before the window, so that a lie within it was not learned along.
      const double pull_rad = from.pull_1pm * (to.ahead_m - from.ahead_m);
      const double room =
          (kPull_1pm + from.pull_sigma_1pm) * (to.path_m - from.path_m) + kTracks_rad;
      return Turned{less + pull_rad - room - ref_rad, more + pull_rad + room - ref_rad, 0.0};
    }
    if (s == Sense::Compass && f_.pivoted &&
        seconds(end - *f_.pivoted) < w + kMean_s + kPivotMemory_s) {
      return std::nullopt;
    }
    const auto now = mean(s, end - span(kMean_s), end);
    const auto then = mean(s, end - span(w + kMean_s), end - span(w));
    if (!now || !then) return std::nullopt;
    const double off = now->off_rad - then->off_rad;
    double sigma = std::hypot(now->sigma_rad, then->sigma_rad);
    if (s == Sense::Compass) sigma = std::hypot(sigma, kCompass_rad);
    if (is_course(s)) sigma = std::hypot(sigma, kCourse_rad);
    if (sigma > kVague_rad) return std::nullopt;
    return Turned{off, off, sigma};
  }

  /// The mean of what it told between two times.
  std::optional<Bearing> mean(Sense s, Time from, Time to) const noexcept {
    const Bearings& all = f_.bearings[index_of(s)];
    double sum = 0.0;
    double noise = 0.0;
    double bias = 0.0;
    int n = 0;
    for (std::size_t i = all.not_after(to); i < all.size() && all[i].t > from; ++i, ++n) {
      const double off = all[i].off_rad - all.newest().off_rad;
      sum += off;
      noise = std::max(noise, all[i].sigma_rad);
      bias = std::max(bias, all[i].bias_rad);
    }
    if (n == 0) return std::nullopt;
    const double middle = sum / n;
    // Chords of positions overlap: more of them tell hardly more.
    const double count = s == Sense::Position ? 1.0 : n;
    const double sigma = std::hypot(noise / std::sqrt(count), bias);
    return Bearing{to, all.newest().off_rad + middle, sigma, 0.0};
  }

  // ---- ways ------------------------------------------------------------------------------------

  void ways(double w) noexcept {
    if (heard(Sense::Position) && !f_.spots.empty()) {
      const Time end = f_.spots.newest().t;
      if (const auto begin = spot_before(f_, end - span(w))) position_ways(*begin, end);
    }
    if (heard(Sense::Velocity) && !f_.paces.empty()) {
      const Time end = f_.paces.newest().t;
      velocity_way(end - span(w), end);
    }
  }

  void position_ways(Time begin, Time end) noexcept {
    const auto spots = by_position(f_, begin, end);
    if (!spots || !covers(Sense::Position, begin)) return;
    const double w = seconds(end - begin);
    const auto paces = heard(Sense::Velocity) && covers(Sense::Velocity, begin)
                           ? by_velocity(f_, begin, end)
                           : std::nullopt;
    if (paces) {
      const double off = norm(without_lag(spots->m - paces->m, paces->faster_mps));
      const double limit = sigmas_ * std::hypot(spots->sigma_m, paces->sigma_m) +
                           (f_.rtk ? kWayFloorRtk_m : kWayFloor_m);
      put(Sense::Position, Sense::Velocity, {Difference::Of::Way, off, w}, limit, 0.0);
      if (off > limit) ask_dead_reckoning(begin, end, spots->m, paces->m);
    }
    const bool both_stand = paces && stands(paces->m, begin, end) && stands(spots->m, begin, end);
    if (!both_stand) track_way(Sense::Position, *spots, begin, end);
  }

  /// Positions that run away from the velocity, slower than two of them could show.
  void runs_apart() noexcept {
    RunApart apart(f_);
    for (const double w : kApartWindows_s) {
      const auto rise = apart.over(w);
      if (!rise) continue;
      const Difference off{Difference::Of::Way, norm(rise->m), apart.window_s()};
      const double limit = sigmas_ * rise->sigma_m + kApartFloor_m;
      table_.apart = std::max(table_.apart.value_or(0.0), off.size / limit);
      table_.runs_apart = table_.runs_apart || (off.size > limit && !apart.a_step());
      put(Sense::Position, Sense::Velocity, off, limit, 0.0);
    }
  }

  void velocity_way(Time begin, Time end) noexcept {
    const auto paces = by_velocity(f_, begin, end);
    if (!paces || !covers(Sense::Velocity, begin)) return;
    const auto from = spot_before(f_, begin);
    const auto spots = from && heard(Sense::Position) && !f_.spots.empty()
                           ? by_position(f_, *from, f_.spots.newest().t)
                           : std::nullopt;
    const bool both_stand =
        stands(paces->m, begin, end) && (!spots || stands(spots->m, begin, end));
    if (!both_stand) track_way(Sense::Velocity, *paces, begin, end);
  }

  bool spins() const noexcept {
    if (!heard(Sense::Velocity) || f_.paces.empty()) return false;
    const Time end = f_.paces.newest().t;
    const Time begin = end - span(kSpinWindow_s);
    const auto from = f_.curve.at(begin);
    const auto to = f_.curve.at(end);
    const auto paces = by_velocity(f_, begin, end);
    if (!from || !to || !paces || std::abs(to->ahead_m - from->ahead_m) < kSpinLeast_m)
      return false;
    if (!stands(paces->m, begin, end)) return false;
    if (!heard(Sense::Position) || f_.spots.empty()) return true;
    const auto spot = spot_before(f_, f_.spots.newest().t - span(kSpinWindow_s));
    const auto spots = spot ? by_position(f_, *spot, f_.spots.newest().t) : std::nullopt;
    return !spots || stands(spots->m, *spot, f_.spots.newest().t);
  }

  /// Far less than the tracks say.
  bool stands(EnuPoint way, Time begin, Time end) const noexcept {
    const auto from = f_.curve.at(begin);
    const auto to = f_.curve.at(end);
    return from && to && norm(way) < kSpinShare * std::abs(to->ahead_m - from->ahead_m);
  }

  /// Length of the way against what the tracks allow.
  void track_way(Sense s, const Stretch& stretch, Time begin, Time end) noexcept {
    const double w = seconds(end - begin);
    if (w > kTrackWindow_s || !heard(Sense::Tracks) || !covers(Sense::Tracks, begin)) return;
    const auto from = f_.curve.at(begin);
    const auto to = f_.curve.at(end);
    if (!from || !to || !counted(*from, *to)) return;
    const bool known = from->scale_sigma < kScaleKnown;
    const double least = known ? 0.65 * from->scale : 0.45;
    const double most = known ? 1.4 * from->scale : 1.3;
    const double turn_rad =
        std::max(std::abs(to->ref_rad - from->ref_rad), std::abs(to->turn_rad - from->turn_rad));
    const double half = 0.5 * turn_rad;
    const double chord = half < 1e-3 ? 1.0 : half > 1.05 ? 0.0 : std::sin(half) / half;
    const double arm_m = f_.arm_m * std::min(2.0, turn_rad);
    const double low_m = least * chord * std::abs(to->ahead_m - from->ahead_m) - arm_m;
    const double high_m = most * (to->path_m - from->path_m) + arm_m;
    const double way_m = norm(stretch.m);
    const double off = way_m < low_m ? way_m - low_m : way_m > high_m ? way_m - high_m : 0.0;
    put(s, Sense::Tracks, {Difference::Of::Way, off, w},
        sigmas_ * stretch.sigma_m + kTrackWayFloor_m, 0.0);
  }

  /// Tracks, laid out from the heading that was believed when the window began.
  void ask_dead_reckoning(Time begin, Time end, EnuPoint spots, EnuPoint paces) noexcept {
    const auto from = f_.curve.at(begin);
    const auto to = f_.curve.at(end);
    if (!from || !to || from->ref_run != to->ref_run || !heard(Sense::Tracks)) return;
    if (!counted(*from, *to)) return;
    const double turn = from->yaw_rad - from->ref_rad;
    const double x = from->scale * (to->x_m - from->x_m);
    const double y = from->scale * (to->y_m - from->y_m);
    const EnuPoint reckoned{std::cos(turn) * x - std::sin(turn) * y,
                            std::sin(turn) * x + std::cos(turn) * y};
    const double path_m = to->path_m - from->path_m;
    const double arm_m = f_.arm_m * std::min(2.0, std::abs(to->ref_rad - from->ref_rad));
    const double sigma =
        std::hypot(path_m * kSlip, path_m * std::min(from->yaw_sigma_rad, 1.0), arm_m);
    const double spots_off = norm(spots - reckoned);
    const double paces_off = norm(paces - reckoned);
    const double apart = norm(spots - paces);
    // It must clearly be nearer, in its own size and in what the reckoning is worth. The other way
    // round proves nothing: positions that run away slowly have drawn the reckoning with them.
    table_.for_velocity = table_.for_velocity ||
                          (paces_off < 0.5 * spots_off && spots_off > 2.0 * sigma + 0.5 * apart);
  }

  // ---- headings --------------------------------------------------------------------------------

  void headings() noexcept {
    if (!heard(Sense::Antennas)) return;
    for (const Sense course : {Sense::Position, Sense::Velocity}) {
      if (!heard(course)) continue;
      const Time end = std::min(last(Sense::Antennas), last(course));
      const Time begin = end - span(2.0);
      if (!covers(Sense::Antennas, begin) || !covers(course, begin - reach(course))) continue;
      const auto newest = f_.curve.at(end);
      const auto first = f_.curve.at(begin);
      if (!newest || !first || newest->ref_run != first->ref_run) continue;
      const auto antennas = mean(Sense::Antennas, begin, end);
      const auto way = mean(course, begin, end);
      if (!antennas || !way) continue;
      const double off = base::wrap_rad(antennas->off_rad - way->off_rad);
      const double limit = sigmas_ * std::hypot(antennas->sigma_rad, way->sigma_rad) + kHeading_rad;
      put(Sense::Antennas, course, {Difference::Of::Heading, off, 2.0}, limit,
          newest->path_m - first->path_m);
    }
  }

  const Facts& f_;
  double sigmas_;
  Table table_;
  Ends ends_;
};

}  // namespace

double Finding::ratio() const noexcept {
  return std::abs(off.size) / limit;
}

void Table::put(Sense a, Sense b, const Finding& finding) noexcept {
  Finding& known = of[index_of(a)][index_of(b)];
  if (known.judged && known.ratio() >= finding.ratio()) return;
  known = finding;
  Finding& other = of[index_of(b)][index_of(a)];
  other = finding;
  if (finding.off.of != Difference::Of::Way) other.off.size = -finding.off.size;
}

Table compare(const Facts& facts, double sigmas) noexcept {
  return Comparer(facts, sigmas).run();
}

}  // namespace roverd::nav
