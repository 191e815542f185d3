#pragma once
// The simulated IP camera: asked over HTTP it answers with a stream of JPEG pictures of its world.
// Pure: the socket is the caller's.

#include <cstdint>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "sim/surroundings.hpp"
#include "sim/world/faults.hpp"
#include "sim/world/painter.hpp"
#include "sim/world/sensor.hpp"

namespace roverd::sim {

class PictureVoice {
 public:
  explicit PictureVoice(const world::SensorParams& p);

  /// Bytes from a client. @return the head of the answer, once it has asked; the parts follow.
  std::vector<std::uint8_t> receive(base::Bytes bytes);
  /// One part of the stream; empty: nobody asked yet, or it is lost. Frozen, it is the last one
  /// again; malformed, some of it is no picture. Its moment is the end of its exposure.
  std::vector<std::uint8_t> say(const Surroundings& around, const world::Sweep& sweep,
                                const world::SensorFaults& faults);

 private:
  void expose(const Surroundings& around, double until_s);

  const world::SensorParams params_;
  const world::Frame mount_;
  world::Painter painter_;
  world::Moment moment_;
  std::string asked_;  ///< the end of what was asked
  bool speaks_ = false;
  std::vector<std::uint8_t> picture_;
};

}  // namespace roverd::sim
