#include "nav/rows/search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "base/angle.hpp"

namespace roverd::nav::rows {
namespace {

constexpr double kSearchStep_deg = 2.0;
constexpr double kLane_m = 0.10;   // width of a lane in which plants are counted
constexpr double kAlong_m = 0.25;  // of it is one piece
constexpr std::size_t kLanes = 100;
constexpr std::size_t kAlongs = 64;
constexpr double kLeastPart = 0.3;  // of the pieces ahead must have plants, to be a side
constexpr std::size_t kLeastPieces = 5;
constexpr double kBesides_m = 0.6;  // from the middle to the robot

using Counts = std::array<std::uint64_t, kLanes>;  // a bit a piece
static_assert(kAlongs == 64);

struct Found {
  double score = 0.0;
  double left_m = 0.0;
  double right_m = 0.0;
  bool any = false;
};

/// Plants of three neighbouring lanes, each piece once.
std::size_t stands(const Counts& lanes, std::size_t i) {
  std::uint64_t all = lanes[i];
  if (i > 0) all |= lanes[i - 1];
  if (i + 1 < kLanes) all |= lanes[i + 1];
  return static_cast<std::size_t>(std::popcount(all));
}

/// From the robot outwards: the first lane in which enough stands, and of its neighbours the
/// fullest.
std::optional<std::size_t> side_from(const Counts& lanes, std::size_t from, int step,
                                     std::size_t least) {
  for (auto i = static_cast<long>(from); i >= 0 && i < static_cast<long>(kLanes); i += step) {
    if (stands(lanes, static_cast<std::size_t>(i)) < least) continue;
    auto best = static_cast<std::size_t>(i);
    for (int k = 1; k <= 2; ++k) {
      const long next = i + k * step;
      if (next < 0 || next >= static_cast<long>(kLanes)) break;
      const auto n = static_cast<std::size_t>(next);
      if (stands(lanes, n) > stands(lanes, best)) best = n;
    }
    return best;
  }
  return std::nullopt;
}

double lane_m(std::size_t i) {
  return (double(i) + 0.5 - double(kLanes) / 2.0) * kLane_m;
}

Found look_along(const std::vector<Mark>& marks, const Pose2& frame, const RowOrder& order,
                 const RowParams& params) {
  Counts lanes{};
  const Pose2 in = sense::inverse(frame);
  const double c = std::cos(in.yaw_rad);
  const double s = std::sin(in.yaw_rad);
  double far_m = 0.0;
  double near_m = params.ahead_m;
  for (const Mark& m : marks) {
    const double x = in.x_m + c * m.x_m - s * m.y_m;
    const double y = in.y_m + s * m.x_m + c * m.y_m;
    if (x < -1.0 || x >= params.ahead_m) continue;
    const double lane = y / kLane_m + double(kLanes) / 2.0;
    if (lane < 0.0 || lane >= double(kLanes)) continue;
    const auto along = std::min(kAlongs - 1, static_cast<std::size_t>((x + 1.0) / kAlong_m));
    lanes[static_cast<std::size_t>(lane)] |= std::uint64_t{1} << along;
    far_m = std::max(far_m, x);
    near_m = std::min(near_m, x);
  }
  const double pieces = std::max(0.0, far_m - near_m) / kAlong_m;
  const auto least = std::max(kLeastPieces, static_cast<std::size_t>(kLeastPart * pieces));
  Found out;
  const auto middle = kLanes / 2;
  const auto left = side_from(lanes, middle, 1, least);
  const auto right = side_from(lanes, middle - 1, -1, least);
  if ((order.sides != Sides::Right && !left) || (order.sides != Sides::Left && !right)) return out;
  // The sharper the sides stand out of what is beside them, the better the direction.
  const auto sharp = [&](std::size_t i) {
    return double(stands(lanes, i)) + 0.5 * double(std::popcount(lanes[i]));
  };
  if (left && order.sides != Sides::Right) {
    out.left_m = lane_m(*left);
    out.score += sharp(*left);
  }
  if (right && order.sides != Sides::Left) {
    out.right_m = lane_m(*right);
    out.score += sharp(*right);
  }
  out.any = true;
  return out;
}

}  // namespace

std::optional<Line> search_line(const std::vector<Mark>& marks, const Pose2& body,
                                const RowOrder& order, const RowParams& params) {
  std::optional<Line> best;
  double score = 0.0;
  const auto steps = static_cast<int>(params.search_deg / kSearchStep_deg);
  for (int k = -steps; k <= steps; ++k) {
    const double turned_rad = base::rad_from_deg(kSearchStep_deg * k);
    const Pose2 frame = body * Pose2{0.0, 0.0, turned_rad};
    const Found found = look_along(marks, frame, order, params);
    // Of equally good ones the straightest ahead.
    const double worth = found.score - 0.02 * std::abs(k);
    if (!found.any || worth <= score) continue;
    Line line;
    double shift_m = 0.0;
    if (order.sides == Sides::Both) {
      line.width_m = found.left_m - found.right_m;
      shift_m = 0.5 * (found.left_m + found.right_m);
      if (line.width_m < params.width_min_m || line.width_m > params.width_max_m) continue;
      if (std::abs(shift_m) > kBesides_m) continue;
    } else {
      line.width_m = 2.0 * order.gap_m;
      shift_m =
          order.sides == Sides::Left ? found.left_m - order.gap_m : found.right_m + order.gap_m;
      if (std::abs(shift_m) > 2.0 * kBesides_m) continue;
    }
    line.at = frame * Pose2{0.0, shift_m, 0.0};
    score = worth;
    best = line;
  }
  return best;
}

}  // namespace roverd::nav::rows
