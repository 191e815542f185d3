#pragma once
// What the vehicle carries or pulls, from above: what is swept, and what the sensors must not take
// for something in the way. Further keys of section [nav.tool], which act at the next start.
//
//        ┌──────┐            rigid: swept with the vehicle, as one convex outline
//   ┌────┴──┐ T │
//   │   B   │   │
//   └────┬──┘   │            pulled: it may stand anywhere within 60 deg to either side behind
//        └──────┘            its coupling, which nothing measures. What sensors see there is the
//                            trailer; it is swept by what is known of the coupling's angle
//                            (nav/sense/trailer.hpp).
//
// Frame B (FLU, metres). Pure.

#include <optional>

#include "base/params.hpp"
#include "base/result.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/trailer.hpp"
#include "nav/track/params.hpp"

namespace roverd::robot {

struct OutlineParams {
  double length_m = 0.0;
  double width_m = 0.0;

  bool any() const noexcept { return length_m > 0.0 && width_m > 0.0; }
};

template <class V>
void fields(V& v, OutlineParams& p) {
  v("length_m", p.length_m, 0.0, 10.0,
    "of the tool's outline, about its point (a trailer's: about its axle); 0: it has none");
  v("width_m", p.width_m, 0.0, 10.0, "of that outline; both are given, or none");
}

/// One of the two alone says nothing: Invalid, the field is its name.
base::Result<void> check(const OutlineParams& params);

/// The vehicle alone, about its origin: its middle, or the middle of the rear axle.
nav::sense::Footprint footprint_of(const nav::VehicleParams& vehicle) noexcept;
/// With what is mounted on it: what moves with it as one.
nav::sense::Footprint footprint_of(const nav::VehicleParams& vehicle, const nav::ToolParams& tool,
                                   const OutlineParams& outline);
/// Where what is pulled may stand. Empty: nothing with an outline is pulled.
std::optional<nav::sense::Footprint> pulled_of(const nav::ToolParams& tool,
                                               const OutlineParams& outline);
/// The trailer itself, its drawbar from the coupling too. Empty: as above.
std::optional<nav::sense::Trailer> trailer_of(const nav::ToolParams& tool,
                                              const OutlineParams& outline);

}  // namespace roverd::robot
