#include "nav/sense/grid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace roverd::nav::sense {

namespace {

constexpr float kFades_m = 0.005F;  // of a span, with each piece that meets its thing again
constexpr std::uint8_t kSureHits = 4;
constexpr float kUnsure_m = 0.40F;   // what few pieces met is gone when a ray passes so near
constexpr float kGrazes_m = 0.003F;  // a ray along an edge: more would take its thing away
constexpr float kRim_m = 0.02F;      // heights in O err by as much: the odometry's drift
constexpr std::uint32_t kAlong_ms = 150;
constexpr std::uint32_t kBeside_ms = 500;
constexpr std::uint32_t kApart_ms = 400;  // what rays say is not one and the same any more
// What is seen lower than this over the body's plane stands on the ground: its foot is there, too.
constexpr float kStands_m = 0.15F;
constexpr float kFoot_m = 0.05F;
// Higher than this over the body's plane an echo that was taken for ground, where something is
// known to stand, is that: so near that it hides the ground, a wall may be a slope as well.
constexpr float kNoGround_m = 0.25F;

/// What lies farther away than any robot drives, or is not a number, is where the count ends: a
/// quarter of it, so that sums of cells stay within.
std::int32_t floored(double v) noexcept {
  constexpr double kEnd = 536'870'912.0;
  if (!(v > -kEnd)) return static_cast<std::int32_t>(-kEnd);
  return v < kEnd ? static_cast<std::int32_t>(std::floor(v)) : static_cast<std::int32_t>(kEnd);
}

/// Pieces may come a little out of order.
std::uint32_t age_ms(std::uint32_t now, std::uint32_t then) noexcept {
  constexpr std::uint32_t kOutOfOrder = 10'000;
  const std::uint32_t age = now - then;
  return age > 0U - kOutOfOrder ? 0 : age;
}

}  // namespace

Grid::Grid(const GridParams& params) : p_(params) {
  const auto wanted = static_cast<std::uint32_t>(std::ceil(p_.size_m / p_.cell_m));
  side_ = static_cast<std::int32_t>(std::bit_ceil(std::clamp(wanted, 16U, 4096U)));
  mask_ = side_ - 1;
  stride_ = static_cast<std::size_t>(side_) + 8;
  cells_.resize(static_cast<std::size_t>(side_) * stride_);
  spans_.resize(cells_.size());
}

void Grid::forget() noexcept {
  std::fill(cells_.begin(), cells_.end(), Cell{});
  begun_ = false;
}

/// Goes round after 49.7 days: only differences mean something (age_ms).
std::uint32_t Grid::ms(base::Time t) const noexcept {
  const double s = std::max(base::seconds(t - begin_), 0.0);
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(s * 1e3));
}

Known Grid::known(const Cell& c, std::uint32_t now_ms) const noexcept {
  if (c.known == Known::Unknown) return Known::Unknown;
  const std::uint32_t age = age_ms(now_ms, c.ms);
  const double keep_s = c.known == Known::Free ? p_.keep_free_s : p_.keep_hit_s;
  if (c.known != Known::Free && keep_s <= 0.0) return c.known;
  return static_cast<double>(age) > keep_s * 1e3 ? Known::Unknown : c.known;
}

void Grid::move_to(const Pose2& body) {
  const std::int32_t x0 = floored(body.x_m / p_.cell_m) - side_ / 2;
  const std::int32_t y0 = floored(body.y_m / p_.cell_m) - side_ / 2;
  if (std::abs(x0 - x0_) >= side_ || std::abs(y0 - y0_) >= side_) {
    std::fill(cells_.begin(), cells_.end(), Cell{});
    x0_ = x0;
    y0_ = y0;
    return;
  }
  // Columns and rows that come in were others on the far side.
  const auto clear_columns = [this](std::int32_t from, std::int32_t to) {
    for (std::int32_t x = from; x < to; ++x) {
      for (std::int32_t y = 0; y < side_; ++y) cell(x, y) = {};
    }
  };
  const auto clear_rows = [this](std::int32_t from, std::int32_t to) {
    for (std::int32_t y = from; y < to; ++y) {
      for (std::int32_t x = 0; x < side_; ++x) cell(x, y) = {};
    }
  };
  if (x0 > x0_) clear_columns(x0_ + side_, x0 + side_);
  if (x0 < x0_) clear_columns(x0, x0_);
  if (y0 > y0_) clear_rows(y0_ + side_, y0 + side_);
  if (y0 < y0_) clear_rows(y0, y0_);
  x0_ = x0;
  y0_ = y0;
}

void Grid::take(const Reduced& in, const Sectors& sectors, std::uint8_t sensor,
                const Hills* hills) {
  if (!begun_) {
    begun_ = true;
    begin_ = in.stamp;
  }
  const std::uint32_t now = ms(in.stamp);
  move_to(in.pose);
  if (hills != nullptr) uncover(in, *hills);
  hit(in, sectors.thin, sensor, now);
  make_sure();
  see_through(in.pose, sectors, sensor, now);
}

void Grid::hit(const Reduced& in, bool thin, std::uint8_t sensor, std::uint32_t now_ms) {
  const double c = std::cos(in.pose.yaw_rad);
  const double s = std::sin(in.pose.yaw_rad);
  const auto up = up_in_body(in.lie);
  met_.clear();
  for (const Voxel& v : in.voxels) {
    const bool again = v.kind == Kind::Passing || (v.kind == Kind::Ground && v.z_m > kNoGround_m);
    if (v.kind != Kind::Obstacle && v.kind != Kind::Drop && !again) continue;
    const auto x = static_cast<double>(v.x_m);
    const auto y = static_cast<double>(v.y_m);
    const double u = (in.pose.x_m + c * x - s * y) / p_.cell_m;
    const double w = (in.pose.y_m + s * x + c * y) / p_.cell_m;
    const std::int32_t ix = floored(u);
    const std::int32_t iy = floored(w);
    if (!inside(ix, iy)) continue;
    if (again) {
      stay(ix, iy, sensor, now_ms);
      continue;
    }
    Cell& o = cell(ix, iy);
    const auto z =
        static_cast<float>(in.lie.z_m + up[0] * x + up[1] * y + up[2] * static_cast<double>(v.z_m));
    Span& span = spans_[index(ix, iy)];
    const bool first = o.hits == 0 || o.ms != now_ms;  // in this piece
    if (o.known != Known::Occupied) {
      span.low_m = span.top_m = z;
      span.top_body_m = v.z_m;
      span.stands = false;
      span.by_planes = thin;
    } else if (o.ms != now_ms) {
      const float fades = std::min(kFades_m, 0.5F * (span.top_m - span.low_m));
      span.low_m += fades;
      span.top_m -= fades;
      span.top_body_m -= fades;
    }
    const bool stands = v.z_m < kStands_m;
    const float low = z - (stands ? kFoot_m : 0.0F);
    span = {std::min(span.low_m, low),
            std::max(span.top_m, z),
            static_cast<float>(u - ix),
            static_cast<float>(w - iy),
            std::max(span.top_body_m, v.z_m),
            span.stands || stands,
            span.by_planes && thin,
            first ? low : std::min(span.now_low_m, low),
            first ? z : std::max(span.now_top_m, z),
            first ? v.z_m : std::max(span.now_body_m, v.z_m),
            now_ms};
    o.known = v.kind == Kind::Drop ? Known::Drop : Known::Occupied;
    if (first) {
      o.hits = static_cast<std::uint8_t>(std::min<int>(o.hits, kSureHits) + 1);
      met_.push_back({ix, iy});
    }
    o.misses = 0;
    o.sensor = sensor;
    o.ms = now_ms;
  }
}

void Grid::uncover(const Reduced& in, const Hills& hills) noexcept {
  const double c = std::cos(in.pose.yaw_rad);
  const double s = std::sin(in.pose.yaw_rad);
  for (const Voxel& v : in.voxels) {
    if (v.kind != Kind::Ground) continue;
    const auto vx = static_cast<double>(v.x_m);
    const auto vy = static_cast<double>(v.y_m);
    const std::int32_t ix = floored((in.pose.x_m + c * vx - s * vy) / p_.cell_m);
    const std::int32_t iy = floored((in.pose.y_m + s * vx + c * vy) / p_.cell_m);
    for (std::int32_t y = iy - 1; y <= iy + 1; ++y) {
      for (std::int32_t x = ix - 1; x <= ix + 1; ++x) {
        if (!inside(x, y)) continue;
        Cell& o = cell(x, y);
        const Span& span = spans_[index(x, y)];
        if (o.known != Known::Occupied || !span.by_planes) continue;
        const double at_x = (x + static_cast<double>(span.x)) * p_.cell_m;
        const double at_y = (y + static_cast<double>(span.y)) * p_.cell_m;
        if (hills.is_ground(at_x, at_y, span.top_m, in.stamp)) o = {};
      }
    }
  }
}

void Grid::make_sure() {
  for (const auto& [ix, iy] : met_) {
    Cell& o = cell(ix, iy);
    Span& span = spans_[index(ix, iy)];
    int sum = 0;
    for (std::int32_t y = iy - 1; y <= iy + 1; ++y) {
      for (std::int32_t x = ix - 1; x <= ix + 1; ++x) {
        if (!inside(x, y)) continue;
        const Cell& other = cell(x, y);
        sum += other.hits;
        // What noise throws into a cell of its own is of the thing beside it: seen through
        // where that is. Of this very piece, else a bar would have its post's heights.
        if (other.hits == 0 || other.ms != o.ms || other.known != o.known) continue;
        const Span& of = spans_[index(x, y)];
        span.low_m = std::min(span.low_m, of.now_low_m);
        span.top_m = std::max(span.top_m, of.now_top_m);
        span.top_body_m = std::max(span.top_body_m, of.now_body_m);
      }
    }
    if (sum >= kSureHits) o.hits = std::max(o.hits, kSureHits);
  }
}

void Grid::stay(std::int32_t ix, std::int32_t iy, std::uint8_t sensor,
                std::uint32_t now_ms) noexcept {
  for (std::int32_t y = iy - 1; y <= iy + 1; ++y) {
    for (std::int32_t x = ix - 1; x <= ix + 1; ++x) {
      if (!inside(x, y)) continue;
      Cell& o = cell(x, y);
      if (o.known != Known::Occupied && o.known != Known::Drop) continue;
      o.misses = 0;
      o.sensor = sensor;
      o.ms = now_ms;
    }
  }
}

void Grid::see_through(const Pose2& body, const Sectors& s, std::uint8_t sensor,
                       std::uint32_t now_ms) {
  const Pose2 eye = body * Pose2{static_cast<double>(s.x_m), static_cast<double>(s.y_m), 0.0};
  const double sector_rad = 2.0 * base::kPi / Sectors::kSectors;
  // Beyond this one line a sector would leave cells out.
  const auto wide = static_cast<std::size_t>(1.0 / sector_rad);
  const auto end = static_cast<std::size_t>(static_cast<double>(s.range_m) / p_.cell_m);
  // Directions are turned by the body's, and by a quarter of a sector, without a sine for each.
  static const auto kDirections = [] {
    std::array<std::array<double, 2>, Sectors::kSectors> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = {std::cos(bearing_rad(i)), std::sin(bearing_rad(i))};
    }
    return out;
  }();
  const double c = std::cos(body.yaw_rad);
  const double sn = std::sin(body.yaw_rad);
  const double beside = std::sin(0.25 * sector_rad);
  for (std::size_t i = 0; i < Sectors::kSectors; ++i) {
    const Sector& sector = s.of[i];
    if (sector.far_m <= 0.0F) continue;
    // The step of the sector in which the last ray ends was looked at as well.
    const float until_m = sector.hit_m > 0.0F
                              ? sector.hit_m
                              : sector.far_m + s.range_m / static_cast<float>(Sectors::kSteps);
    const std::size_t to =
        std::min(end, static_cast<std::size_t>(static_cast<double>(until_m) / p_.cell_m));
    const auto& b = kDirections[i];
    Line line{
        eye.x_m / p_.cell_m, eye.y_m / p_.cell_m, c * b[0] - sn * b[1], sn * b[0] + c * b[1], 0,
        std::min(to, wide)};
    look_along(line, i, s, sensor, now_ms);
    if (to <= wide) continue;
    line.from = wide;
    line.to = to;
    const double dx = line.dx;
    const double dy = line.dy;
    for (const double off : {-beside, beside}) {
      line.dx = dx - off * dy;
      line.dy = dy + off * dx;
      look_along(line, i, s, sensor, now_ms);
    }
  }
}

void Grid::look_along(const Line& line, std::size_t sector, const Sectors& s, std::uint8_t sensor,
                      std::uint32_t now_ms) noexcept {
  const double bits =
      static_cast<double>(Sectors::kSteps) * p_.cell_m / static_cast<double>(s.range_m);
  // Fixed point with 16 bits behind the comma: a step is two additions.
  constexpr double kOne = 65536.0;
  const double ox = std::floor(line.x);
  const double oy = std::floor(line.y);
  const auto base_x = static_cast<std::int32_t>(ox);
  const auto base_y = static_cast<std::int32_t>(oy);
  const auto step_x = static_cast<std::int32_t>(std::lround(line.dx * kOne));
  const auto step_y = static_cast<std::int32_t>(std::lround(line.dy * kOne));
  const auto f = static_cast<double>(line.from) + 0.5;
  auto px = static_cast<std::int32_t>((line.x - ox + line.dx * f) * kOne);
  auto py = static_cast<std::int32_t>((line.y - oy + line.dy * f) * kOne);
  const auto step_bit = static_cast<std::uint32_t>(bits * kOne);
  auto bit = static_cast<std::uint32_t>(f * bits * kOne);
  const std::uint64_t seen = s.of[sector].seen;
  // Not read again for every cell: what is written there might be anything to the compiler.
  Cell* const cells = cells_.data();
  const auto side = static_cast<std::uint32_t>(side_);
  const auto mask = static_cast<std::uint32_t>(mask_);
  const std::size_t stride = stride_;
  const std::int32_t x0 = x0_;
  const std::int32_t y0 = y0_;
  const std::size_t from = line.from;
  const std::size_t to = line.to;
  for (std::size_t n = from; n < to; ++n, px += step_x, py += step_y, bit += step_bit) {
    const std::uint32_t b = bit >> 16U;
    if (b >= Sectors::kSteps) return;
    const std::int32_t ix = base_x + (px >> 16);
    const std::int32_t iy = base_y + (py >> 16);
    if (static_cast<std::uint32_t>(ix - x0) >= side || static_cast<std::uint32_t>(iy - y0) >= side)
      return;
    const std::size_t i =
        (static_cast<std::uint32_t>(iy) & mask) * stride + (static_cast<std::uint32_t>(ix) & mask);
    Cell& c = cells[i];
    const bool looked = ((seen >> b) & 1U) != 0;
    if (c.known == Known::Occupied || c.known == Known::Drop) {
      const double u = ix + static_cast<double>(spans_[i].x) - line.x;
      const double w = iy + static_cast<double>(spans_[i].y) - line.y;
      const double d_m = (u * line.dx + w * line.dy) * p_.cell_m;
      if (!seen_through(i, d_m, std::uint64_t{1} << b, sector, s, sensor, now_ms)) continue;
      c = Cell{};  // gone; whether the ground is free is another ray's word
    }
    if (!looked) continue;
    c = {Known::Free, c.misses, sensor, c.hits, now_ms};
  }
}

/// Often enough by now, that is.
bool Grid::seen_through(std::size_t i, double d_m, std::uint64_t bit, std::size_t sector,
                        const Sectors& s, std::uint8_t sensor, std::uint32_t now_ms) noexcept {
  Cell& c = cells_[i];
  if (c.ms == now_ms) return false;  // hit in this very piece, or seen through already
  const Span& span = spans_[i];
  const bool sure = c.hits >= kSureHits;
  // What a plane met, that same plane always looks at in the same height over the body.
  const bool same = s.planar && c.sensor == sensor;
  const float top_body_m = sure && span.stands && !same
                               ? std::max(s.meets_m, span.top_body_m + kGrazes_m)
                               : std::numeric_limits<float>::infinity();
  using Pass = Sectors::Pass;
  Pass pass = Pass::None;
  if (c.known == Known::Drop) {
    if ((s.of[sector].low & bit) != 0) pass = Pass::Through;
  } else if (sure) {
    pass = s.passes(sector, static_cast<float>(d_m),
                    {span.low_m, span.top_m, kGrazes_m, kRim_m, top_body_m});
  } else {
    pass =
        s.passes(sector, static_cast<float>(d_m), {span.low_m - kUnsure_m, span.top_m + kUnsure_m});
  }
  return pass != Pass::None && long_enough(i, pass, now_ms);
}

/// Rays say that it left, and have done so for so long that it did.
bool Grid::long_enough(std::size_t i, Sectors::Pass pass, std::uint32_t now_ms) noexcept {
  Cell& c = cells_[i];
  Span& span = spans_[i];
  if (c.misses == 0 || age_ms(now_ms, c.ms) > kApart_ms) {
    c.misses = span.along = 0;
    span.beside_ms = now_ms;
  }
  c.ms = now_ms;
  const auto count = [](std::uint8_t& n) { n = static_cast<std::uint8_t>(std::min(n + 1, 255)); };
  count(c.misses);
  if (pass >= Sectors::Pass::Along) {
    if (span.along == 0) span.along_ms = now_ms;
    count(span.along);
  }
  if (c.misses < p_.clear_scans) return false;
  if (age_ms(now_ms, span.beside_ms) >= kBeside_ms) return true;
  if (span.along < p_.clear_scans) return false;  // one ray's word, whatever passed beside
  const bool lately = age_ms(span.along_ms, span.met_ms) < kBeside_ms;
  return pass == Sectors::Pass::Through || (lately && age_ms(now_ms, span.along_ms) >= kAlong_ms);
}

Known Grid::at(double x_m, double y_m, base::Time now) const noexcept {
  const std::int32_t ix = floored(x_m / p_.cell_m);
  const std::int32_t iy = floored(y_m / p_.cell_m);
  return begun_ && inside(ix, iy) ? known(cell(ix, iy), ms(now)) : Known::Unknown;
}

void Grid::patch(const Pose2& about, double reach_m, base::Time now, Patch& out,
                 std::span<const double> free_for_s) const {
  const std::int32_t reach = std::clamp(floored(reach_m / p_.cell_m), 1, side_ / 2);
  out.stamp = now;
  out.cell_m = p_.cell_m;
  out.x0 = floored(about.x_m / p_.cell_m) - reach;
  out.y0 = floored(about.y_m / p_.cell_m) - reach;
  out.side = 2 * reach;
  out.cells.assign(static_cast<std::size_t>(out.side) * static_cast<std::size_t>(out.side), {});
  if (!begun_) return;
  const std::uint32_t now_ms = ms(now);
  // The oldest that is still told: of what is free by its sensor, of what stands for all.
  constexpr std::uint32_t kAlways = std::numeric_limits<std::uint32_t>::max();
  const auto as_ms = [](double s) {
    return static_cast<std::uint32_t>(std::clamp(s, 0.0, 4e6) * 1e3);
  };
  const std::uint32_t hit_ms = p_.keep_hit_s > 0.0 ? as_ms(p_.keep_hit_s) : kAlways;
  std::array<std::uint32_t, 256> free_ms{};
  free_ms.fill(as_ms(p_.keep_free_s));
  for (std::size_t n = 0; n < std::min(free_for_s.size(), free_ms.size()); ++n) {
    free_ms[n] = std::min(free_ms[n], as_ms(free_for_s[n]));
  }
  const std::int32_t x_from = std::max(out.x0, x0_);
  const std::int32_t x_to = std::min(out.x0 + out.side, x0_ + side_);
  const std::int32_t out_x0 = out.x0;
  const std::int32_t mask = mask_;
  for (std::int32_t y = std::max(out.y0, y0_); y < std::min(out.y0 + out.side, y0_ + side_); ++y) {
    Patch::Cell* row = out.cells.data() +
                       static_cast<std::size_t>(y - out.y0) * static_cast<std::size_t>(out.side);
    const Cell* ours = cells_.data() + static_cast<std::size_t>(y & mask) * stride_;
    for (std::int32_t x = x_from; x < x_to; ++x) {
      const Cell c = ours[x & mask];
      if (c.known == Known::Unknown) continue;
      const std::uint32_t age = age_ms(now_ms, c.ms);
      if (age > (c.known == Known::Free ? free_ms[c.sensor] : hit_ms)) continue;
      row[x - out_x0] = {c.known, c.sensor,
                         static_cast<std::uint16_t>(std::min(age / 100U, 65535U))};
    }
  }
}

std::vector<std::uint8_t> run_lengths(const Patch& patch) {
  std::vector<std::uint8_t> out;
  std::size_t i = 0;
  while (i < patch.cells.size()) {
    const Known k = patch.cells[i].known;
    std::size_t n = 1;
    while (n < 64 && i + n < patch.cells.size() && patch.cells[i + n].known == k) ++n;
    out.push_back(static_cast<std::uint8_t>((static_cast<unsigned>(k) << 6U) | (n - 1)));
    i += n;
  }
  return out;
}

}  // namespace roverd::nav::sense
