#pragma once
// One scan as what was seen (base/sight.hpp). Scanner angles grow counter-clockwise seen from
// above; frame S has x straight ahead, so
//
//            90°                         x
//             |   LMS1xx, LMS5xx, TiM    |       angle in S = scanner angle − ahead
//   180° ─────o───── 0°             y ───o       (ahead = 90°; 0° for a TiM240)
//
// Raw 0: nothing came back, Clear as far as clear_to. Raw 1 to 15: reserved codes (1 dazzled; real
// LMS1xx say 3 where nothing was measured), Unknown. Any other: Hit at raw · scale + offset. Of
// several echoes of a beam each other one is a further Hit; where any echo is a hit the direction
// is not Clear.
//
// Beam i was measured i · step / 360° / frequency after beam 0. Pure.

#include <string>

#include "base/result.hpp"
#include "base/sight.hpp"
#include "sick/scan.hpp"

namespace roverd::sick {

struct SightRules {
  double ahead_deg = 90.0;  ///< the scanner's angle that is straight ahead
  double clear_to_m = 8.0;  ///< what a missing echo vouches for; 0: nothing
};

/// What a scan says of its beams, to see whether it changed.
struct Beams {
  std::int32_t start_e4deg = 0;
  std::uint16_t step_e4deg = 0;
  std::size_t count = 0;
  std::uint32_t frequency_chz = 0;
  friend bool operator==(const Beams&, const Beams&) = default;
};
/// Of the first channel of distances; empty: there is none.
std::optional<Beams> beams_of(const Scan& scan) noexcept;
/// From beam 0 to the last one, seconds; 0 where the frequency is not told.
double duration_s(const Beams& beams) noexcept;

/// All but sensor, stamp and count. @return Invalid: no distances, beams over more than a full turn
/// or not within ±720°, no step between them, a scan frequency outside 0.1 to 1000 Hz.
base::Result<base::Sight> to_sight(const Scan& scan, const SightRules& rules);

/// Share of the beams of which nothing came back or that are Unknown, 0 to 1.
double missing_share(const base::Sight& sight) noexcept;

}  // namespace roverd::sick
