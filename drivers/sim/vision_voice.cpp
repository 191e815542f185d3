#include "sim/vision_voice.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <span>
#include <string>

#include "vision/codec.hpp"

namespace roverd::sim {
namespace {

constexpr std::size_t kFewest = 12;   // shots of a plane
constexpr int kMostSplits = 16;       // one in another
constexpr double kSplit_m = 0.1;      // shots farther beside a straight piece make a corner of it
constexpr double kImage = 307'200.0;  // points of the camera's own image, 640 by 480
constexpr double kMissed = 0.05;
constexpr double kMisnamed = 0.02;
constexpr double kFalse = 0.1;
constexpr double kPlaceSigma_m = 0.03;
constexpr double kFalseSize = 9000.0;
/// What a datagram may hold of each.
constexpr std::size_t kMost = 200;

/// A shot in S, seen from above.
struct Seen {
  double ahead_m = 0.0;
  double left_m = 0.0;
  double up_m = 0.0;
};

Seen place_of(const world::Shot& shot) noexcept {
  const double level_m = double(shot.range_m) * std::cos(double(shot.elevation_rad));
  return {level_m * std::cos(double(shot.bearing_rad)),
          level_m * std::sin(double(shot.bearing_rad)),
          double(shot.range_m) * std::sin(double(shot.elevation_rad))};
}

vision::Point in_camera(double ahead_m, double left_m, double up_m) noexcept {
  return {-left_m, -up_m, ahead_m};
}

/// The shot farthest beside the line from the first to the last; their number if none is too far.
std::size_t corner_of(std::span<const Seen> s) noexcept {
  const double dx = s.back().ahead_m - s.front().ahead_m;
  const double dy = s.back().left_m - s.front().left_m;
  const double long_m = std::hypot(dx, dy);
  std::size_t worst = s.size();
  double most_m = kSplit_m;
  for (std::size_t i = 1; long_m > 1e-6 && i + 1 < s.size(); ++i) {
    const double off_m =
        std::abs(dx * (s[i].left_m - s.front().left_m) - dy * (s[i].ahead_m - s.front().ahead_m)) /
        long_m;
    if (off_m > most_m) {
      most_m = off_m;
      worst = i;
    }
  }
  return worst;
}

class Program {
 public:
  Program(const world::Sweep& sweep, const world::World& world, std::uint64_t seed)
      : sweep_(sweep), world_(world), draw_((seed ^ (sweep.count * 0x9e3779b97f4a7c15ULL)) + 1) {
    out_.names = {"cone", "pole", "box"};
  }

  vision::Datagram look() {
    std::map<int, std::vector<Seen>> by_thing;
    for (const world::Shot& shot : sweep_.shots) {
      if (shot.range_m > 0.0F && shot.thing >= 0) by_thing[shot.thing].push_back(place_of(shot));
    }
    for (auto& [number, seen] : by_thing) recognise(number, seen);
    if (uniform() < kFalse) invent();
    return std::move(out_);
  }
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(draw_); }

 private:
  void recognise(int number, std::vector<Seen>& seen) {
    if (static_cast<std::size_t>(number) >= world_.things.size()) return;
    const world::Thing& thing = world_.things[static_cast<std::size_t>(number)];
    // Its shots lie where it is wide, mostly: two thirds of its radius, about.
    if (thing.kind == world::Kind::Cone) return landmark(0, thing.radius_m / 1.5, seen);
    if (thing.kind == world::Kind::Pole) return landmark(1, thing.radius_m, seen);
    if (thing.kind == world::Kind::Wall) {
      std::ranges::sort(seen, {}, [](const Seen& s) { return std::atan2(s.left_m, s.ahead_m); });
      return planes(seen);
    }
    const auto nearest = std::ranges::min_element(seen, {}, &Seen::ahead_m);
    if (out_.obstacles.size() < kMost) {
      out_.obstacles.push_back(in_camera(nearest->ahead_m, nearest->left_m, nearest->up_m));
    }
  }

  /// What is seen of it is its near side.
  void landmark(std::size_t name, double radius_m, const std::vector<Seen>& seen) {
    if (uniform() < kMissed || out_.landmarks.size() >= kMost) return;
    Seen mean;
    for (const Seen& s : seen) {
      mean.ahead_m += s.ahead_m / double(seen.size());
      mean.left_m += s.left_m / double(seen.size());
      mean.up_m += s.up_m / double(seen.size());
    }
    const double far_m = std::max(0.1, std::hypot(mean.ahead_m, mean.left_m));
    const double grow = (far_m + 0.785 * radius_m) / far_m;
    if (uniform() < kMisnamed) name = (name + 1) % out_.names.size();
    out_.landmarks.push_back(
        {name, in_camera(grow * mean.ahead_m + kPlaceSigma_m * normal(),
                         grow * mean.left_m + kPlaceSigma_m * normal(), mean.up_m)});
  }

  void planes(std::span<const Seen> seen, int splits = 0) {
    if (seen.size() < kFewest || out_.planes.size() >= kMost) return;
    const std::size_t at = splits < kMostSplits ? corner_of(seen) : seen.size();
    if (at < seen.size()) {
      planes(seen.first(at), splits + 1);
      return planes(seen.subspan(at), splits + 1);
    }
    double x = 0.0, y = 0.0, z = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
    const double n = double(seen.size());
    for (const Seen& s : seen) {
      x += s.ahead_m / n;
      y += s.left_m / n;
      z += s.up_m / n;
    }
    for (const Seen& s : seen) {
      xx += (s.ahead_m - x) * (s.ahead_m - x);
      yy += (s.left_m - y) * (s.left_m - y);
      xy += (s.ahead_m - x) * (s.left_m - y);
    }
    // Across the direction in which it is longest.
    const double along_rad = 0.5 * std::atan2(2.0 * xy, xx - yy);
    const double share = n / double(std::max<std::size_t>(1, sweep_.shots.size()));
    out_.planes.push_back({in_camera(x, y, z),
                           in_camera(-std::sin(along_rad), std::cos(along_rad), 0.0),
                           std::round(kImage * share)});
  }

  void invent() {
    if (uniform() < 0.5) {
      const double ahead_m = 1.0 + 4.0 * uniform();
      out_.landmarks.push_back({0, in_camera(ahead_m, ahead_m * (uniform() - 0.5), 0.0)});
    } else {
      out_.planes.push_back({in_camera(-1.0, 0.4, 0.0), in_camera(0.0, 1.0, 0.0), kFalseSize});
    }
  }
  double normal() { return std::normal_distribution<double>()(draw_); }

  const world::Sweep& sweep_;
  const world::World& world_;
  std::mt19937_64 draw_;
  vision::Datagram out_;
};

/// One of the ways in which programs get it wrong.
void spoil(std::string& text, double how) {
  if (how < 0.4) {
    text.resize(text.size() / 2);
  } else if (how < 0.7) {
    text += ": nan";
  } else {
    std::ranges::replace(text, ' ', ',');
  }
}

}  // namespace

std::vector<std::uint8_t> vision_datagram(const world::Sweep& sweep, const world::World& world,
                                          double malformed, std::uint64_t seed) {
  Program program(sweep, world, seed);
  std::string text = vision::encode(program.look());
  if (program.uniform() < malformed) spoil(text, program.uniform());
  return {text.begin(), text.end()};
}

}  // namespace roverd::sim
