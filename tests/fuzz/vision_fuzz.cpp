// Any bytes as a datagram of a vision program: what is taken is within its bounds and is written
// and read back as the same, what is refused says why.

#include <cmath>
#include <cstdlib>
#include <string>

#include "vision/codec.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

void check_point(const base::VisionPoint& p) {
  check(std::abs(p.x_m) <= vision::kFarthest_m && std::abs(p.y_m) <= vision::kFarthest_m &&
        std::abs(p.z_m) <= vision::kFarthest_m);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const vision::Decoded decoded = vision::decode({data, size});
  check(!vision::describe(decoded).empty());
  if (decoded.fault != vision::Fault::None) {
    check(decoded.datagram == vision::Datagram{} && decoded.byte <= size && decoded.field < 6);
    return 0;
  }
  const vision::Datagram& d = decoded.datagram;
  check(d.names.size() <= vision::kMostNames && d.landmarks.size() <= vision::kMostLandmarks &&
        d.obstacles.size() <= vision::kMostObstacles && d.planes.size() <= vision::kMostPlanes);
  const std::string text = vision::encode(d);
  const auto again =
      vision::decode({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  check(again.fault == vision::Fault::None && again.datagram == d);
  const base::Vision seen = vision::seen(d);
  for (const auto& l : seen.landmarks) check_point(l.at);
  for (const auto& p : seen.obstacles) check_point(p);
  for (const auto& p : seen.planes) {
    check_point(p.centre);
    check(std::abs(std::hypot(p.normal.x_m, p.normal.y_m, p.normal.z_m) - 1.0) < 1e-6);
    check(p.size >= 0.0);
  }
  return 0;
}
