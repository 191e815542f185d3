#pragma once
// What a camera without distortion sees of a scene, in grey: sky, ground, everything that stands on
// it as flat faces with their true outlines and the right one in front, and AprilTags to a
// hundredth of a pixel. Leaves are balls here. Pure: same scene, moment, place and number, same
// picture.
//
// Camera frame S: x ahead, y left, z up. column = columns/2 − f·y/x, row = rows/2 − f·z/x; the
// middle of the first pixel is 0.5. f = columns / 2 / tan(fov / 2).

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "sim/world/scene.hpp"

namespace roverd::sim::world {

inline constexpr int kTags = 587;  ///< of tag36h11

class Painter {
 public:
  /// @param fov_rad across, less than π.
  Painter(int columns, int rows, double fov_rad);

  /// @param camera X_ES. @param number of the picture: its noise. @return columns · rows, valid
  /// until the next call.
  const std::vector<std::uint8_t>& paint(const Scene& scene, const Moment& moment,
                                         const Frame& camera, std::uint64_t number);

 private:
  using Face = std::vector<Vec3>;

  void paint_ground(const Scene& scene);
  void paint_shape(const Scene& scene, const Shape& shape);
  void paint_prism(const Shape& shape, double shade);
  void paint_cone(const Shape& shape, double shade);
  void paint_ball(const Shape& shape, double shade);
  void paint_face(const Face& corners, double shade);
  void paint_tag(const Thing& tag, double ground_m);
  void add_noise(std::uint64_t number);
  Vec3 seen(Vec3 at) const noexcept;
  Vec3 seen_turned(Vec3 v) const noexcept;
  const std::array<bool, 100>& cells_of(int id);

  const int columns_;
  const int rows_;
  const double f_;
  Frame camera_;
  std::vector<std::uint8_t> grey_;
  std::vector<float> near_;                     ///< 1 / ahead of what each pixel shows
  std::map<int, std::array<bool, 100>> cells_;  ///< of tags, true: white
};

}  // namespace roverd::sim::world
