#pragma once
// Randomness by number: what is drawn depends on the key alone, not on what was drawn elsewhere
// before, so each ray of each sensor and each plant of each row has draws of its own.

#include <cmath>
#include <cstdint>
#include <string_view>

namespace roverd::sim::world {

/// Spreads neighbouring numbers apart. Source: Steele, Lea, Flood 2014 (SplitMix64).
constexpr std::uint64_t spread(std::uint64_t z) noexcept {
  z += 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}
constexpr double share_of(std::uint64_t spread_number) noexcept {
  return static_cast<double>(spread_number >> 11) * 0x1.0p-53;
}
/// A text as a key. FNV-1a.
constexpr std::uint64_t key_of(std::string_view text) noexcept {
  std::uint64_t key = 0xCBF29CE484222325u;
  for (const char c : text) key = (key ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return key;
}

class Draw {
 public:
  explicit Draw(std::uint64_t key) noexcept : state_(spread(key)) {}
  Draw(std::uint64_t seed, std::uint64_t count) noexcept
      : state_(spread(spread(seed) ^ (count * 0xD1342543DE82EF95u))) {}

  /// [0, 1)
  double uniform() noexcept { return share_of(next()); }
  double uniform(double from, double to) noexcept { return from + (to - from) * uniform(); }
  /// @param count > 0. @return 0 .. count − 1
  int below(int count) noexcept { return static_cast<int>(uniform() * count); }
  /// Mean 0, sigma 1. Box and Muller 1958.
  double normal() noexcept {
    constexpr double kTurn = 6.283185307179586;
    const double r = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return r * std::cos(kTurn * uniform());
  }
  /// Mean 1: the way to the next of things that lie scattered at one to a metre.
  double exponential() noexcept { return -std::log(1.0 - uniform()); }

 private:
  std::uint64_t next() noexcept { return spread(state_ += 0x9E3779B97F4A7C15u); }
  std::uint64_t state_;
};

}  // namespace roverd::sim::world
