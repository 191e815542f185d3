#pragma once
// What a camera's own program recognised in one image: named landmarks, obstacles, planes.
//
// Frame S: the camera's own, FLU as the body's: x ahead along its optical axis, y left, z up,
// metres. How S stands on the body is its Mount, which whoever uses it applies; drivers do not.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/time.hpp"

namespace roverd::base {

struct VisionPoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  friend bool operator==(const VisionPoint&, const VisionPoint&) = default;
};

struct VisionLandmark {
  std::string name;
  VisionPoint at;
  friend bool operator==(const VisionLandmark&, const VisionLandmark&) = default;
};

struct VisionPlane {
  VisionPoint centre;  ///< centre.x_m is its depth; behind the camera it is a false one
  VisionPoint normal;  ///< of length 1; to which side it points is not settled
  double size = 0.0;   ///< points that lie in it
  friend bool operator==(const VisionPlane&, const VisionPlane&) = default;
};

/// One image. Immutable once told.
struct Vision {
  std::string sensor;       ///< name of its driver
  Time stamp;               ///< when the image was taken
  std::uint64_t count = 0;  ///< of this camera, from 0
  std::vector<VisionLandmark> landmarks;
  std::vector<VisionPoint> obstacles;
  std::vector<VisionPlane> planes;
};

using OnVision = std::function<void(std::shared_ptr<const Vision>)>;

}  // namespace roverd::base
