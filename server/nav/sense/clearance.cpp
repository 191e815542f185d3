// How far it is from every cell to the nearest that stands.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "nav/sense/grid.hpp"

namespace roverd::nav::sense {
namespace {

constexpr float kNever = 1e9F;  // squared cells, of what has nothing in its column

/// Squared cells to the nearest in the same column, by going down and up once. @param taken whether
/// a cell counts
template <class Taken>
void along_columns(std::size_t n, const Taken& taken, std::vector<float>& out) {
  constexpr float kNone = 1e4F;  // beyond any column
  std::vector<float> steps(n, kNone);
  const auto go = [&](std::size_t y, bool back) {
    float* row = out.data() + y * n;
    for (std::size_t x = 0; x < n; ++x) {
      steps[x] = taken(y * n + x) ? 0.0F : steps[x] + 1.0F;
      row[x] = back ? std::min(row[x], steps[x]) : steps[x];
    }
  };
  for (std::size_t y = 0; y < n; ++y) go(y, false);
  std::fill(steps.begin(), steps.end(), kNone);
  for (std::size_t y = n; y-- > 0;) go(y, true);
  for (float& v : out) v = v < kNone ? v * v : kNever;
}

/// The lower envelope of a row's parabolas. @param f squared distances, in cells.
struct Envelope {
  std::vector<float> f, z;
  std::vector<std::size_t> v;
  explicit Envelope(std::size_t n) : f(n), z(n + 1), v(n) {}

  /// @param most what is farther is left out. @return whether there is anything.
  bool lay(std::size_t n, float most) {
    const float endless = std::numeric_limits<float>::infinity();
    const auto where = [this](std::size_t q, std::size_t p) {
      const auto qf = static_cast<float>(q);
      const auto pf = static_cast<float>(p);
      return ((f[q] + qf * qf) - (f[p] + pf * pf)) / (2.0F * (qf - pf));
    };
    std::size_t size = 0;
    for (std::size_t q = 0; q < n; ++q) {
      if (f[q] > most) continue;
      float s = -endless;
      while (size > 0 && (s = where(q, v[size - 1])) <= z[size - 1]) --size;
      z[size] = size > 0 ? s : -endless;
      v[size] = q;
      z[++size] = endless;
    }
    return size > 0;
  }
  template <class Put>
  void run(std::size_t n, const Put& put) const {
    std::size_t k = 0;
    for (std::size_t q = 0; q < n; ++q) {
      while (z[k + 1] < static_cast<float>(q)) ++k;
      const float d = static_cast<float>(q) - static_cast<float>(v[k]);
      put(q, d * d + f[v[k]]);
    }
  }
};

}  // namespace

void clearance(const Patch& patch, bool unknown_too, float max_m, std::vector<float>& out) {
  const auto n = static_cast<std::size_t>(patch.side);
  out.resize(patch.cells.size());
  along_columns(
      n,
      [&](std::size_t i) {
        const Known k = patch.cells[i].known;
        return k == Known::Occupied || k == Known::Drop || (unknown_too && k == Known::Unknown);
      },
      out);
  const auto cell_m = static_cast<float>(patch.cell_m);
  const float most = std::min(max_m / cell_m + 1.0F, 3e4F);
  Envelope e(n);
  for (std::size_t y = 0; y < n; ++y) {
    float* row = out.data() + y * n;
    std::copy_n(row, n, e.f.begin());
    if (e.lay(n, most * most)) {
      e.run(n, [&](std::size_t x, float d2) { row[x] = std::min(max_m, std::sqrt(d2) * cell_m); });
    } else {
      std::fill_n(row, n, max_m);
    }
  }
}

}  // namespace roverd::nav::sense
