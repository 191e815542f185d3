#pragma once
// What a camera without distortion sees of a scene, in grey: sky, ground, everything that stands on
// it as flat faces with their true outlines and the right one in front, and AprilTags to a
// hundredth of a pixel. Leaves are balls here. Pure: same scene, moment, place and number, same
// picture.
//
//   expose() for each piece of the time that the shutter is open ─▶ develop(): their mean, stray
//   light, noise
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

  /// One more piece of the light that makes the next picture. @param camera X_ES
  void expose(const Scene& scene, const Moment& moment, const Frame& camera);
  /// Of what was exposed since the last one. @param number of the picture: its noise. @param glare
  /// 0 to 1: share of its contrast that stray light takes. @return columns · rows, valid until the
  /// next call.
  const std::vector<std::uint8_t>& develop(std::uint64_t number, double glare);
  /// How far anything moves in the picture from one place of the camera to the other, about.
  double blur_px(const Frame& from, const Frame& to) const noexcept;

 private:
  using Face = std::vector<Vec3>;

  void paint_ground(const Scene& scene);
  void paint_shape(const Scene& scene, const Shape& shape);
  void paint_prism(const Shape& shape, double shade);
  void paint_cone(const Shape& shape, double shade);
  void paint_ball(const Shape& shape, double shade);
  void paint_face(const Face& corners, double shade);
  void paint_tags(const Scene& scene);
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
  std::vector<std::uint16_t> light_;  ///< sum of the pieces
  int pieces_ = 0;
  std::vector<float> near_;                     ///< 1 / ahead of what each pixel shows
  std::map<int, std::array<bool, 100>> cells_;  ///< of tags, true: white
};

}  // namespace roverd::sim::world
