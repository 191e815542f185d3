#include "sim/noise.hpp"

#include <cmath>

namespace roverd::sim {

std::uint64_t mix(std::uint64_t z) noexcept {
  z += 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

Noise::Noise(std::uint64_t seed, Stream stream)
    : engine_(mix(mix(seed) ^ static_cast<std::uint64_t>(stream))) {}

double Noise::uniform() {
  return static_cast<double>(engine_() >> 11) * 0x1.0p-53;
}

// Marsaglia's polar method. std::normal_distribution may differ from one library to the next, and a
// seed must mean the same everywhere.
double Noise::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double u = 0.0;
  double v = 0.0;
  double s = 0.0;
  do {
    u = 2.0 * uniform() - 1.0;
    v = 2.0 * uniform() - 1.0;
    s = u * u + v * v;
  } while (s >= 1.0 || s == 0.0);
  const double factor = std::sqrt(-2.0 * std::log(s) / s);
  spare_ = v * factor;
  has_spare_ = true;
  return u * factor;
}

double Drift::step(double dt_s, double tau_s) {
  const double keep = std::exp(-dt_s / tau_s);
  value_ = value_ * keep + std::sqrt(1.0 - keep * keep) * noise_.normal();
  return value_;
}

}  // namespace roverd::sim
