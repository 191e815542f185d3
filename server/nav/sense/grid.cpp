#include "nav/sense/grid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace roverd::nav::sense {

namespace {

constexpr float kTop_m = 0.02F;

std::int32_t floored(double v) noexcept {
  return static_cast<std::int32_t>(std::floor(v));
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
  cells_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
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

void Grid::take(const Reduced& in, const Sectors& sectors, std::uint8_t sensor) {
  if (!begun_) {
    begun_ = true;
    begin_ = in.stamp;
  }
  const std::uint32_t now = ms(in.stamp);
  move_to(in.pose);
  hit(in, sensor, now);
  see_through(in.pose, sectors, sensor, now);
}

void Grid::hit(const Reduced& in, std::uint8_t sensor, std::uint32_t now_ms) {
  const double c = std::cos(in.pose.yaw_rad);
  const double s = std::sin(in.pose.yaw_rad);
  for (const Voxel& v : in.voxels) {
    const bool passing = v.kind == Kind::Passing;
    if (v.kind != Kind::Obstacle && v.kind != Kind::Drop && !passing) continue;
    const auto x = static_cast<double>(v.x_m);
    const auto y = static_cast<double>(v.y_m);
    const std::int32_t ix = floored((in.pose.x_m + c * x - s * y) / p_.cell_m);
    const std::int32_t iy = floored((in.pose.y_m + s * x + c * y) / p_.cell_m);
    if (!inside(ix, iy)) continue;
    if (passing) {
      stay(ix, iy, sensor, now_ms);
      continue;
    }
    Cell& o = cell(ix, iy);
    const auto top = static_cast<std::uint8_t>(std::clamp(v.z_m / kTop_m, 0.0F, 255.0F));
    const bool was = o.known == Known::Occupied || o.known == Known::Drop;
    o.top = was ? std::max(o.top, top) : top;
    o.known = v.kind == Kind::Drop ? Known::Drop : Known::Occupied;
    o.misses = 0;
    o.sensor = sensor;
    o.ms = now_ms;
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
  const double x = eye.x_m / p_.cell_m;
  const double y = eye.y_m / p_.cell_m;
  const double sector_rad = 2.0 * base::kPi / Sectors::kSectors;
  // Beyond this one line a sector would leave cells out.
  const auto wide = static_cast<std::size_t>(p_.cell_m / sector_rad / p_.cell_m);
  const auto end = static_cast<std::size_t>(static_cast<double>(s.range_m) / p_.cell_m);
  for (std::size_t i = 0; i < Sectors::kSectors; ++i) {
    const Sector& sector = s.of[i];
    if (sector.seen == 0) continue;
    const std::size_t to =
        sector.hit_m > 0.0F
            ? std::min(end, static_cast<std::size_t>(static_cast<double>(sector.hit_m) / p_.cell_m))
            : end;
    const double angle = body.yaw_rad + bearing_rad(i);
    look_along(x, y, std::cos(angle), std::sin(angle), 0, std::min(to, wide), sector, s, sensor,
               now_ms);
    if (to <= wide) continue;
    for (const double beside : {-0.25 * sector_rad, 0.25 * sector_rad}) {
      look_along(x, y, std::cos(angle + beside), std::sin(angle + beside), wide, to, sector, s,
                 sensor, now_ms);
    }
  }
}

void Grid::look_along(double x, double y, double dx, double dy, std::size_t from, std::size_t to,
                      const Sector& sector, const Sectors& s, std::uint8_t sensor,
                      std::uint32_t now_ms) noexcept {
  const double bits =
      static_cast<double>(Sectors::kSteps) * p_.cell_m / static_cast<double>(s.range_m);
  // Fixed point with 16 bits behind the comma: a step is two additions.
  constexpr double kOne = 65536.0;
  const double ox = std::floor(x);
  const double oy = std::floor(y);
  const auto base_x = static_cast<std::int32_t>(ox);
  const auto base_y = static_cast<std::int32_t>(oy);
  const auto step_x = static_cast<std::int32_t>(std::lround(dx * kOne));
  const auto step_y = static_cast<std::int32_t>(std::lround(dy * kOne));
  const auto f = static_cast<double>(from) + 0.5;
  auto px = static_cast<std::int32_t>((x - ox + dx * f) * kOne);
  auto py = static_cast<std::int32_t>((y - oy + dy * f) * kOne);
  const auto step_bit = static_cast<std::uint32_t>(bits * kOne);
  auto bit = static_cast<std::uint32_t>(f * bits * kOne);
  for (std::size_t i = from; i < to; ++i, px += step_x, py += step_y, bit += step_bit) {
    const std::uint32_t b = bit >> 16U;
    if (b >= Sectors::kSteps) return;
    if (((sector.seen >> b) & 1U) == 0) continue;
    const std::int32_t ix = base_x + (px >> 16);
    const std::int32_t iy = base_y + (py >> 16);
    if (!inside(ix, iy)) return;
    Cell& c = cell(ix, iy);
    if (c.known == Known::Occupied || c.known == Known::Drop) {
      if (c.ms == now_ms) continue;  // hit in this very piece, or seen through already
      const bool tall = static_cast<float>(c.top) * kTop_m >= s.tall_m;
      if ((((tall ? sector.tall : sector.low) >> b) & 1U) == 0) continue;
      c.ms = now_ms;
      if (++c.misses < p_.clear_scans) continue;
    }
    c.known = Known::Free;
    c.sensor = sensor;
    c.ms = now_ms;
  }
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
  std::array<std::uint32_t, 256> free_ms{};
  free_ms.fill(std::numeric_limits<std::uint32_t>::max());
  for (std::size_t n = 0; n < std::min(free_for_s.size(), free_ms.size()); ++n) {
    free_ms[n] = static_cast<std::uint32_t>(std::clamp(free_for_s[n], 0.0, 4e6) * 1e3);
  }
  std::size_t i = 0;
  for (std::int32_t y = out.y0; y < out.y0 + out.side; ++y) {
    for (std::int32_t x = out.x0; x < out.x0 + out.side; ++x, ++i) {
      if (!inside(x, y)) continue;
      const Cell& c = cell(x, y);
      if (c.known == Known::Unknown) continue;
      const std::uint32_t age = age_ms(now_ms, c.ms);
      const bool gone = c.known == Known::Free && age > free_ms[c.sensor];
      if (gone) continue;
      out.cells[i] = {known(c, now_ms), c.sensor,
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

namespace {

/// The lower envelope of parabolas, in place. @param f squared distances, in cells.
struct Envelope {
  std::vector<float> f, z;
  std::vector<std::size_t> v;
  explicit Envelope(std::size_t n) : f(n), z(n + 1), v(n) {}

  template <class Put>
  void run(std::size_t n, const Put& put) {
    const float endless = std::numeric_limits<float>::infinity();
    std::size_t k = 0;
    v[0] = 0;
    z[0] = -endless;
    z[1] = endless;
    const auto where = [this](std::size_t q, std::size_t p) {
      const auto qf = static_cast<float>(q);
      const auto pf = static_cast<float>(p);
      return ((f[q] + qf * qf) - (f[p] + pf * pf)) / (2.0F * (qf - pf));
    };
    for (std::size_t q = 1; q < n; ++q) {
      float s = where(q, v[k]);
      while (k > 0 && s <= z[k]) s = where(q, v[--k]);
      ++k;
      v[k] = q;
      z[k] = s;
      z[k + 1] = endless;
    }
    k = 0;
    for (std::size_t q = 0; q < n; ++q) {
      while (z[k + 1] < static_cast<float>(q)) ++k;
      const float d = static_cast<float>(q) - static_cast<float>(v[k]);
      put(q, d * d + f[v[k]]);
    }
  }
};

}  // namespace

void clearance(const Patch& patch, bool unknown_too, float max_m, std::vector<float>& out) {
  constexpr float kFar = 1e7F;  // squared cells; infinity would not subtract
  const auto n = static_cast<std::size_t>(patch.side);
  out.resize(patch.cells.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Known k = patch.cells[i].known;
    const bool taken =
        k == Known::Occupied || k == Known::Drop || (unknown_too && k == Known::Unknown);
    out[i] = taken ? 0.0F : kFar;
  }
  Envelope e(n);
  for (std::size_t x = 0; x < n; ++x) {
    for (std::size_t y = 0; y < n; ++y) e.f[y] = out[y * n + x];
    e.run(n, [&](std::size_t y, float d2) { out[y * n + x] = d2; });
  }
  for (std::size_t y = 0; y < n; ++y) {
    for (std::size_t x = 0; x < n; ++x) e.f[x] = out[y * n + x];
    e.run(n, [&](std::size_t x, float d2) {
      out[y * n + x] = std::min(max_m, std::sqrt(d2) * static_cast<float>(patch.cell_m));
    });
  }
}

}  // namespace roverd::nav::sense
