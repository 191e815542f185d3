#include "mission/survey/strips.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace roverd::mission::survey {
namespace {

constexpr std::size_t kNoChain = std::numeric_limits<std::size_t>::max();
constexpr double kFar = std::numeric_limits<double>::infinity();

/// Where the boundary passes a line.
struct Crossing {
  double at_m = 0.0;
  std::size_t line = 0;
  std::size_t interval = 0;  ///< of its line, once sorted
};

/// A stretch of the boundary within one strip, from one crossing to the next.
struct Chain {
  std::size_t strip = 0;
  std::size_t begin = kNoChain;  ///< crossing; none: the whole ring lies in the strip
  std::size_t end = kNoChain;
  Box box{{kFar, kFar}, {-kFar, -kFar}};
};

void reach(Box& box, const Box& other) noexcept {
  box.low = {std::min(box.low.east_m, other.low.east_m),
             std::min(box.low.north_m, other.low.north_m)};
  box.high = {std::max(box.high.east_m, other.high.east_m),
              std::max(box.high.north_m, other.high.north_m)};
}
void reach(Box& box, EnuPoint p) noexcept {
  reach(box, Box{p, p});
}
void reach(Component& c, const Box& box) noexcept {
  c.from_m = std::min(c.from_m, box.low.east_m);
  c.to_m = std::max(c.to_m, box.high.east_m);
  c.low_m = std::min(c.low_m, box.low.north_m);
  c.high_m = std::max(c.high_m, box.high.north_m);
}
Component component_of(const Box& box) {
  return {box.low.east_m, box.high.east_m, box.low.north_m, box.high.north_m, {}, {}};
}

class Cutter {
 public:
  Cutter(double low_m, double width_m, std::size_t count, std::size_t most)
      : low_m_(low_m), width_m_(width_m), count_(count), most_(most) {}

  /// @return false: too many crossings.
  bool walk(const Ring& ring) {
    const std::size_t first = chains_.size();
    Chain chain{.strip = strip_of(ring.back().north_m)};
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      if (!step(ring[j], ring[i], chain)) return false;
    }
    const bool crosses = chains_.size() > first;
    if (!crosses) {
      // A hole that lies in one strip alone matters to nobody.
      if (square_m2(ring) > 0.0) chains_.push_back(chain);
      return true;
    }
    // The walk began in the middle of a chain: its beginning and its end are one.
    chains_[first].begin = chain.begin;
    reach(chains_[first].box, chain.box);
    return true;
  }

  Strips result() {
    Strips out;
    out.lines.resize(count_ + 1);
    out.strips.resize(count_);
    pair_up(out);
    std::vector<std::vector<std::size_t>> of_strip(count_);
    for (std::size_t i = 0; i < chains_.size(); ++i) of_strip[chains_[i].strip].push_back(i);
    for (std::size_t s = 0; s < count_; ++s) connect(s, of_strip[s], out);
    return out;
  }

 private:
  std::size_t strip_of(double across_m) const noexcept {
    const double k = std::floor((across_m - low_m_) / width_m_);
    return static_cast<std::size_t>(std::clamp(k, 0.0, static_cast<double>(count_ - 1)));
  }

  double line_m(std::size_t line) const noexcept {
    return low_m_ + width_m_ * static_cast<double>(line);
  }

  bool step(EnuPoint a, EnuPoint b, Chain& chain) {
    const std::size_t to = strip_of(b.north_m);
    reach(chain.box, a);
    while (chain.strip != to) {
      if (crossings_.size() >= most_) return false;
      const bool up = to > chain.strip;
      const std::size_t line = up ? chain.strip + 1 : chain.strip;
      const double at = line_m(line);
      const double share = std::clamp((at - a.north_m) / (b.north_m - a.north_m), 0.0, 1.0);
      const double along_m = a.east_m + share * (b.east_m - a.east_m);
      crossings_.push_back({along_m, line, 0});
      reach(chain.box, EnuPoint{along_m, at});
      chain.end = crossings_.size() - 1;
      const std::size_t next = up ? chain.strip + 1 : chain.strip - 1;
      const std::size_t here = chain.end;
      chains_.push_back(chain);
      chain = Chain{.strip = next, .begin = here};
      reach(chain.box, EnuPoint{along_m, at});
    }
    reach(chain.box, b);
    return true;
  }

  /// Crossings of a line, sorted, are by turns the beginning and the end of an interval.
  void pair_up(Strips& out) {
    std::vector<std::size_t> order(crossings_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
      const Crossing& x = crossings_[a];
      const Crossing& y = crossings_[b];
      return x.line != y.line ? x.line < y.line : x.at_m < y.at_m;
    });
    std::vector<std::size_t> seen(count_ + 1, 0);
    for (const std::size_t i : order) {
      Crossing& c = crossings_[i];
      const std::size_t place = seen[c.line]++;
      c.interval = place / 2;
      if (place % 2 == 0) {
        out.lines[c.line].push_back({c.at_m, c.at_m});
      } else {
        out.lines[c.line].back().to_m = c.at_m;
      }
    }
  }

  /// Nodes are the intervals of the lower line, then those of the upper one.
  void connect(std::size_t s, const std::vector<std::size_t>& chains, Strips& out) {
    const auto& lower = out.lines[s];
    const auto& upper = out.lines[s + 1];
    std::vector<std::size_t> root(lower.size() + upper.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&root](std::size_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    const auto node = [&](std::size_t crossing) {
      const Crossing& c = crossings_[crossing];
      return c.line == s ? c.interval : lower.size() + c.interval;
    };
    for (const std::size_t i : chains) {
      if (chains_[i].begin != kNoChain)
        root[find(node(chains_[i].begin))] = find(node(chains_[i].end));
    }
    std::vector<std::size_t> component(root.size(), kNoChain);
    auto& made = out.strips[s];
    for (std::size_t i = 0; i < root.size(); ++i) {
      std::size_t& at = component[find(i)];
      const Interval& interval = i < lower.size() ? lower[i] : upper[i - lower.size()];
      const double across_m = line_m(i < lower.size() ? s : s + 1);
      const Box box{{interval.from_m, across_m}, {interval.to_m, across_m}};
      if (at == kNoChain) {
        at = made.size();
        made.push_back(component_of(box));
      }
      Component& c = made[at];
      reach(c, box);
      if (i < lower.size()) {
        c.below.push_back(i);
      } else {
        c.above.push_back(i - lower.size());
      }
    }
    for (const std::size_t i : chains) {
      const Chain& chain = chains_[i];
      if (chain.begin == kNoChain) {
        made.push_back(component_of(chain.box));
        continue;
      }
      reach(made[component[find(node(chain.begin))]], chain.box);
    }
  }

  const double low_m_;
  const double width_m_;
  const std::size_t count_;
  const std::size_t most_;
  std::vector<Crossing> crossings_;
  std::vector<Chain> chains_;
};

}  // namespace

Strips cut(const Area& area, double low_m, double width_m, std::size_t count,
           std::size_t most_crossings) {
  Cutter cutter(low_m, width_m, count, most_crossings);
  for (const Ring& ring : area) {
    if (ring.size() >= 3 && !cutter.walk(ring)) return {};
  }
  return cutter.result();
}

}  // namespace roverd::mission::survey
