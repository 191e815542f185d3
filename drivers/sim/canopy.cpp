#include "sim/canopy.hpp"

#include "sim/motion.hpp"

namespace roverd::sim {
namespace {

/// The sky opens and closes within some seconds, not from one epoch to the next.
constexpr double kEdge_s = 2.0;
/// Of a corrected receiver's time between its fix and none.
constexpr double kFloatShare = 0.6;

}  // namespace

Canopy::Canopy(std::uint64_t seed)
    : draws_(seed, Stream::TreesFix),
      east_(seed, Stream::TreesEast),
      north_(seed, Stream::TreesNorth),
      draw_(draws_.uniform()) {}

void Canopy::step(const TreesParams& p, bool under, double dt_s) {
  under_ = under;
  cover_ += ((under ? 1.0 : 0.0) - cover_) * lag_share(kEdge_s, dt_s);
  east_m_ = cover_ * p.multipath_m * east_.step(dt_s, p.multipath_tau_s);
  north_m_ = cover_ * p.multipath_m * north_.step(dt_s, p.multipath_tau_s);
  held_s_ += dt_s;
  if (held_s_ < p.hold_s) return;
  held_s_ = 0.0;
  draw_ = draws_.uniform();
}

base::FixType Canopy::through(const TreesParams& p, base::FixType open) const noexcept {
  using base::FixType;
  if (!under_ || open == FixType::None || draw_ < p.fixed_share) return open;
  const double rest = (draw_ - p.fixed_share) / (1.0 - p.fixed_share);
  if (rest < p.none_share) return FixType::None;
  if (open == FixType::Single) return open;
  const bool floats = (rest - p.none_share) / (1.0 - p.none_share) < kFloatShare;
  return floats && open != FixType::Differential ? FixType::RtkFloat : FixType::Differential;
}

}  // namespace roverd::sim
