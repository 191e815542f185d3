#pragma once
// Who moves is foreseen: how much of a commanded twist may be driven, so that nobody is met who
// goes on as he does.
//
// A part λ of the twist may be driven if, for the next foresee_s and as long as braking lasts,
//
//   brake: after delay_s the body brakes along the curve and stands, and nobody comes nearer to it
//          than side_m on the way nor where it stands; so it stands before his way, not in it; or
//   keep:  it goes over to λ from the speed that was measured, and nobody comes nearer than
//          foresee_gap_m: nor to what it pulls, taken as if it followed straight behind.
//
// The largest of some λ that may be driven is. If there is none, he comes to the body wherever it
// stands: then it stands. He may be anywhere within his radius, and within σ t of where he goes.
// Who walks up from behind is his own business: to stand would help nobody.
//
// And he may turn. Whoever is not straight behind it may turn towards it at any moment by up to
// 100 degrees, and is told kTold_s (0.35 s) later: so it drives no faster than it stands by then
// (the separation that ISO 13855 asks for, with his own speed),
//
//   v_his (kTold_s + delay_s + λ brakes) + v_its λ (kTold_s + delay_s + λ brakes / 2)
//       <= room - side_m
//
// v_his: turn_part |v| cos(what is left of the angle to the body after 100 degrees), v_its: how
// fast the twist brings the body nearer to where he is, in m/s; negative where it leaves him, but 0
// then in a turn, whose next side comes round. Smooth in where he is beside it and how he goes, so
// beside whoever walks along it does not speed up and brake by turns; a step only where he comes
// to be straight behind.
//
// Of more than 16 the nearest count. Pure; allocates nothing: for the control tick. Without movers
// nothing is reckoned; with one whom the body may meet up to 12 · 40 looks, more where it brakes
// for longer than foresee_s: 10 s ahead at most.

#include <cstdint>
#include <span>

#include "base/geo.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/movers.hpp"
#include "nav/sense/odometry.hpp"
#include "nav/sense/params.hpp"

namespace roverd::nav::sense {

struct Foreseen {
  double part = 1.0;         ///< of the commanded twist, 0..1
  bool found = false;        ///< somebody would be met
  bool may_turn = false;     ///< he does not come, but might
  double unless_left = 1.0;  ///< the part, but for those whom the twist leads away from
  double meets_s = 0.0;      ///< when, if all went on so; might: if he turned now
  double room_m = 0.0;       ///< between him and the body, with what it pulls
  Vec2 at{};                 ///< where he is now, in B: the middle of what was seen of him
  double radius_m = 0.0;
  std::uint8_t sensor = 0;
  double age_s = 0.0;
};

/// @param now X_OB and how it moves. @param twist commanded, finite
/// @param whole the body with what it pulls straight behind it; null: it pulls nothing
Foreseen foresee(std::span<const Mover> movers, const Odometry& now, const Footprint& body,
                 const base::BodyTwist& twist, const ProtectParams& params,
                 const Footprint* whole = nullptr) noexcept;

}  // namespace roverd::nav::sense
