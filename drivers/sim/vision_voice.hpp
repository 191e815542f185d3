#pragma once
// What a camera's program would recognise in a simulated image, as the datagram that it sends:
// cones and poles by name, walls as planes, all else as obstacles, with the errors of such
// programs. Pure: same image and seed, same datagram.
//
//   shots of one thing ─▶ cone, pole: one landmark, its middle
//                      ─▶ wall: a plane for each straight piece of kFewest shots
//                      ─▶ all else: its nearest shot is an obstacle
//
// Errors: a landmark in twenty is missed, one in fifty is called otherwise, and in one image of ten
// something is seen that is not there: a landmark, or a large plane behind the camera.

#include <cstdint>
#include <vector>

#include "sim/world/scene.hpp"
#include "sim/world/sensor.hpp"

namespace roverd::sim {

/// @param malformed share of the datagrams that are cut, or hold something that is no number.
/// @param seed of the run and the camera: each has errors of its own
std::vector<std::uint8_t> vision_datagram(const world::Sweep& sweep, const world::World& world,
                                          double malformed, std::uint64_t seed = 0);

}  // namespace roverd::sim
