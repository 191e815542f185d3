#pragma once
// What a sensor that looks around saw: the one form in which scanners, clouds, depth images and
// single ranges reach the sense chain. Device units and device axes end in the codecs.
//
// Frame S: the sensor's own, FLU as the body's: x ahead, y left, z up, metres. How S stands on the
// body is its Mount, which the sense chain applies; drivers do not.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"

namespace roverd::base {

/// How a direction came back.
enum class Echo : std::uint8_t {
  Hit,      ///< something is at the point
  Clear,    ///< nothing came back: clear as far as the point, which lies at the range that the
            ///< sensor vouches for (Sight::clear_to_m)
  Unknown,  ///< dazzled, covered, a reserved code: the point lies at unit distance and tells only
            ///< into which direction nothing is known
};

/// 20 bytes, so that a full revolution stays within the caches.
struct SightPoint {
  float x_m = 0.0F;  ///< in S
  float y_m = 0.0F;
  float z_m = 0.0F;
  float after_s = 0.0F;  ///< later than Sight::stamp, when this direction was measured
  std::uint16_t intensity = 0;
  std::uint8_t ring = 0;  ///< 0 lowest; 0 where there is one only
  Echo echo = Echo::Unknown;
};

/// What the sensor says of the glass before it.
enum class Window : std::uint8_t { Unknown, Clean, Dirty, Blocked };
std::string_view to_string(Window w) noexcept;  // unknown clean dirty blocked

/// One scan, one revolution, one image: as much as the sensor gives as a piece. Immutable once
/// told.
struct Sight {
  std::string sensor;       ///< name of its driver
  Time stamp;               ///< when the first point was measured; the rest follows by after_s
  std::uint64_t count = 0;  ///< of this sensor, from 0; a gap is a piece that was lost
  /// Half the angle between neighbouring points, radians: how wide the ray of one point is.
  float half_step_rad = 0.0F;
  float clear_to_m = 0.0F;  ///< what Echo::Clear vouches for; 0: a missing echo tells nothing
  Window window = Window::Unknown;
  /// The device says that its data are not (yet) good: heating up, faulty. Nothing in it is used.
  bool good = true;
  std::vector<SightPoint> points;  ///< in the order in which they were measured
};

using OnSight = std::function<void(std::shared_ptr<const Sight>)>;

/// How S stands on the body: first rolled, then pitched, then yawed, then moved. Body FLU, origin
/// at the point whose pose the estimator tells, on the ground. Yaw left positive, pitch nose *down*
/// positive and roll left side up positive (right-handed about z, y, x).
struct Mount {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
  friend bool operator==(const Mount&, const Mount&) = default;
};

}  // namespace roverd::base
