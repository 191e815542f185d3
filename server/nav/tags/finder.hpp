#pragma once
// AprilTags of the family tag36h11 in a grey image, by Debian's libapriltag, with the pose of each
// and how sure it is.
//
//   tag frame T: origin in its middle, x right and y down as one looks at it, z into it
//   camera frame S: FLU as all sensors: x ahead, y left, z up
//
// The library finds corners and bits. The pose is the one of least squared distance of the four
// corners in the image (Gauss-Newton from the library's homography); its covariance is
// sigma² (JᵀJ)⁻¹. A flat tag has two poses that look alike when it is small or looked at head on:
// `doubt` says how likely the other one is, by the ratio of their likelihoods.
// Its start mirrors the normal about the line of sight. Source: Schweighofer and Pinz 2006.
//
// The image has no lens distortion, or was rectified. One Finder for each thread; it allocates. The
// library makes no thread of its own here.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/result.hpp"
#include "base/sight.hpp"
#include "nav/tags/params.hpp"
#include "nav/tags/tag_place.hpp"

namespace roverd::nav::tags {

struct GreyImage {
  int width = 0;
  int height = 0;
  int stride = 0;                         ///< bytes from row to row
  std::span<const std::uint8_t> bytes{};  ///< stride · height at least
};

/// Pixels; the middle of the first pixel is 0.5.
struct Lens {
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
};

struct Tag {
  int id = 0;
  int hamming = 0;                                         ///< bits that were put right
  double margin = 0.0;                                     ///< grey levels
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R_ST
  Eigen::Vector3d place = Eigen::Vector3d::Zero();         ///< p_ST, metres in S
  /// Of a small turn about S's axes (rad), then of the place (m).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double rms_px = 0.0;  ///< of the corners
  double doubt = 1.0;   ///< 0: no other pose explains it, 1: another one does as well
};

class Finder {
 public:
  static constexpr int kLargest_px = 4096;
  static constexpr std::size_t kMostTags = 64;  ///< of an image; the clearest ones

  Finder();
  ~Finder();
  Finder(Finder&&) noexcept;
  Finder& operator=(Finder&&) noexcept;

  /// @return by id. Invalid, naming the field: an image or lens that cannot be.
  base::Result<std::vector<Tag>> find(const GreyImage& image, const Lens& lens,
                                      const TagParams& params);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// @param mount of the camera on the body.
TagPlace on_body(const Tag& tag, const base::Mount& mount, const TagParams& params) noexcept;

}  // namespace roverd::nav::tags
