#include "nav/tags/finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Dense>
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include "nav/sense/mount.hpp"

namespace roverd::nav::tags {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kRounds = 30;
constexpr int kSmallest_px = 16;

/// Camera axes: x right, y down, z ahead.
struct Pose {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
};

struct Corners {
  std::array<Eigen::Vector3d, 4> object;
  std::array<Eigen::Vector2d, 4> image;
};

Corners corners_of(const apriltag_detection_t& d, double size_m) {
  const double h = 0.5 * size_m;
  Corners c;
  c.object = {Eigen::Vector3d{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
  for (std::size_t i = 0; i < 4; ++i) c.image[i] = {d.p[i][0], d.p[i][1]};
  return c;
}

struct Step {
  Matrix6 normal = Matrix6::Zero();
  Vector6 slope = Vector6::Zero();
  double sse_px2 = 0.0;
  bool before = true;  ///< all corners are before the camera
};

/// x: a small turn about the camera's axes, then the place.
Step linearised(const Corners& c, const Pose& pose, const Lens& lens) {
  Step s;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d turned = pose.r * c.object[i];
    const Eigen::Vector3d p = turned + pose.t;
    if (p.z() < 1e-3) {
      s.before = false;
      return s;
    }
    const Eigen::Vector2d off{lens.fx * p.x() / p.z() + lens.cx - c.image[i].x(),
                              lens.fy * p.y() / p.z() + lens.cy - c.image[i].y()};
    Eigen::Matrix<double, 2, 3> by_p;
    by_p << lens.fx / p.z(), 0.0, -lens.fx * p.x() / (p.z() * p.z()), 0.0, lens.fy / p.z(),
        -lens.fy * p.y() / (p.z() * p.z());
    Eigen::Matrix3d cross;
    cross << 0.0, -turned.z(), turned.y(), turned.z(), 0.0, -turned.x(), -turned.y(), turned.x(),
        0.0;
    Eigen::Matrix<double, 2, 6> j;
    j.leftCols<3>() = -by_p * cross;
    j.rightCols<3>() = by_p;
    s.normal += j.transpose() * j;
    s.slope += j.transpose() * off;
    s.sse_px2 += off.squaredNorm();
  }
  return s;
}

struct Settled {
  Pose pose;
  Step step;
};

/// Damped where a step makes it worse. Empty: it leads nowhere.
std::optional<Settled> settled(const Corners& c, Pose pose, const Lens& lens) {
  Step now = linearised(c, pose, lens);
  if (!now.before) return std::nullopt;
  double damp = 1e-6;
  for (int i = 0; i < kRounds; ++i) {
    Matrix6 a = now.normal;
    a.diagonal() *= 1.0 + damp;
    const Vector6 x = a.ldlt().solve(-now.slope);
    if (!x.allFinite()) return std::nullopt;
    Pose next = pose;
    const double turn = x.head<3>().norm();
    if (turn > 1e-12) {
      next.r = Eigen::AngleAxisd(turn, x.head<3>() / turn).toRotationMatrix() * pose.r;
    }
    next.t += x.tail<3>();
    const Step then = linearised(c, next, lens);
    if (!then.before || then.sse_px2 > now.sse_px2) {
      damp = std::max(damp * 10.0, 1e-4);
      continue;
    }
    pose = next;
    now = then;
    damp *= 0.1;
    if (x.norm() < 1e-9) break;
  }
  return Settled{pose, now};
}

/// Out of the homography that the library found: K⁻¹ H = λ [r₁ r₂ t/h], made a rotation again.
std::optional<Pose> start_of(const apriltag_detection_t& d, const Lens& lens, double size_m) {
  Eigen::Matrix3d h;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) h(i, k) = d.H->data[3 * i + k];
  }
  Eigen::Matrix3d k;
  k << lens.fx, 0.0, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0;
  Eigen::Matrix3d m = k.inverse() * h;
  if (m(2, 2) < 0.0) m = -m;
  const double scale = std::sqrt(m.col(0).norm() * m.col(1).norm());
  if (!(scale > 1e-12) || !m.allFinite()) return std::nullopt;
  Pose pose;
  pose.t = m.col(2) / scale * (0.5 * size_m);
  pose.r.col(0) = m.col(0).normalized();
  const Eigen::Vector3d second = m.col(1) - pose.r.col(0).dot(m.col(1)) * pose.r.col(0);
  pose.r.col(1) = second.normalized();
  pose.r.col(2) = pose.r.col(0).cross(pose.r.col(1));
  if (!pose.r.allFinite()) return std::nullopt;
  return pose;
}

/// The pose that looks much the same: the tag's normal mirrored about the line of sight.
Pose mirrored(const Pose& pose) {
  const Eigen::Vector3d ray = pose.t.normalized();
  const Eigen::Vector3d normal = pose.r.col(2);
  const Eigen::Vector3d other = 2.0 * ray.dot(normal) * ray - normal;
  return {Eigen::Quaterniond::FromTwoVectors(normal, other).toRotationMatrix() * pose.r, pose.t};
}

/// Both poses, settled; the better one first. Empty: no pose fits.
std::vector<Settled> poses_of(const apriltag_detection_t& d, const Lens& lens, double size_m) {
  const Corners c = corners_of(d, size_m);
  std::vector<Settled> out;
  const auto start = start_of(d, lens, size_m);
  if (!start) return out;
  if (auto good = settled(c, *start, lens)) out.push_back(*good);
  const Pose& near = out.empty() ? *start : out.front().pose;
  if (auto good = settled(c, mirrored(near), lens)) out.push_back(*good);
  std::ranges::sort(out, {}, [](const Settled& s) { return s.step.sse_px2; });
  return out;
}

/// Camera axes to S: x right, y down, z ahead to x ahead, y left, z up.
Eigen::Matrix3d flu() {
  Eigen::Matrix3d m;
  m << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return m;
}

std::optional<Tag> tag_of(const apriltag_detection_t& d, const Lens& lens,
                          const TagParams& params) {
  if (d.hamming > params.max_hamming ||
      static_cast<double>(d.decision_margin) < params.min_margin) {
    return std::nullopt;
  }
  const auto poses = poses_of(d, lens, params.size_m);
  if (poses.empty()) return std::nullopt;
  const Settled& best = poses.front();
  const double variance = params.corner_sigma_px * params.corner_sigma_px;
  Tag tag;
  tag.id = d.id;
  tag.hamming = d.hamming;
  tag.margin = static_cast<double>(d.decision_margin);
  tag.rms_px = std::sqrt(best.step.sse_px2 / 8.0);
  tag.rotation = flu() * best.pose.r;
  tag.place = flu() * best.pose.t;
  const Matrix6 inverse = best.step.normal.ldlt().solve(Matrix6::Identity());
  if (!inverse.allFinite()) return std::nullopt;
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = flu();
  tag.covariance = variance * turn * inverse * turn.transpose();
  tag.doubt = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double apart = Eigen::AngleAxisd(best.pose.r.transpose() * poses[i].pose.r).angle();
    if (apart < 0.02) continue;  // both starts came to the same pose
    const double worse = poses[i].step.sse_px2 - best.step.sse_px2;
    tag.doubt = std::exp(-0.5 * worse / variance);
  }
  return tag;
}

base::Result<void> check(const GreyImage& image, const Lens& lens) {
  const auto refuse = [](const char* field, const std::string& why) -> base::Result<void> {
    return base::fail(base::Code::Invalid, std::string(field) + " " + why, {{field, why}});
  };
  const auto side = [](int px) { return px >= kSmallest_px && px <= Finder::kLargest_px; };
  if (!side(image.width)) return refuse("width", "must be 16 to 4096");
  if (!side(image.height)) return refuse("height", "must be 16 to 4096");
  if (image.stride < image.width) return refuse("stride", "must be the width at least");
  const auto need =
      static_cast<std::size_t>(image.stride) * static_cast<std::size_t>(image.height - 1) +
      static_cast<std::size_t>(image.width);
  if (image.bytes.size() < need) return refuse("bytes", "are too few for that size");
  const auto focal = [](double f) { return std::isfinite(f) && f > 1.0 && f < 1e6; };
  if (!focal(lens.fx)) return refuse("fx", "must be a focal length in pixels");
  if (!focal(lens.fy)) return refuse("fy", "must be a focal length in pixels");
  if (!std::isfinite(lens.cx)) return refuse("cx", "must be a number");
  if (!std::isfinite(lens.cy)) return refuse("cy", "must be a number");
  return {};
}

}  // namespace

struct Finder::Impl {
  Impl() : family(tag36h11_create()), detector(apriltag_detector_create()) {
    apriltag_detector_add_family(detector, family);
    detector->nthreads = 1;
    detector->refine_edges = true;
  }
  ~Impl() {
    apriltag_detector_destroy(detector);
    tag36h11_destroy(family);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  apriltag_family_t* family;
  apriltag_detector_t* detector;
  std::vector<std::uint8_t> pixels;
};

Finder::Finder() : impl_(std::make_unique<Impl>()) {}
Finder::~Finder() = default;
Finder::Finder(Finder&&) noexcept = default;
Finder& Finder::operator=(Finder&&) noexcept = default;

base::Result<std::vector<Tag>> Finder::find(const GreyImage& image, const Lens& lens,
                                            const TagParams& params) {
  if (auto good = check(image, lens); !good) return tl::unexpected(good.error());
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  // The library wants bytes that it may write to.
  impl_->pixels.resize(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    const auto row = image.bytes.subspan(y * static_cast<std::size_t>(image.stride), width);
    std::ranges::copy(row, impl_->pixels.begin() + static_cast<std::ptrdiff_t>(y * width));
  }
  image_u8_t wrapped{image.width, image.height, image.width, impl_->pixels.data()};
  impl_->detector->quad_decimate = static_cast<float>(params.decimate);
  zarray_t* found = apriltag_detector_detect(impl_->detector, &wrapped);
  std::vector<Tag> out;
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* d = nullptr;
    zarray_get(found, i, &d);
    if (auto tag = tag_of(*d, lens, params)) out.push_back(std::move(*tag));
  }
  apriltag_detections_destroy(found);
  if (out.size() > kMostTags) {
    std::ranges::sort(out, std::ranges::greater{}, &Tag::margin);
    out.resize(kMostTags);
  }
  std::ranges::stable_sort(out, {}, &Tag::id);
  return out;
}

TagPlace on_body(const Tag& tag, const base::Mount& mount, const TagParams& params) noexcept {
  const Eigen::Matrix3d turn = sense::rotation(mount);
  const Eigen::Vector3d place = turn * tag.place + Eigen::Vector3d(mount.x_m, mount.y_m, mount.z_m);
  const Eigen::Vector3d into = turn * tag.rotation.col(2);
  TagPlace out;
  out.id = tag.id;
  out.pose = {place.x(), place.y(), std::atan2(into.y(), into.x())};
  out.up_m = place.z();
  out.into_up = into.z();
  Matrix6 both = Matrix6::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = turn;
  const Matrix6 cov = both * tag.covariance * both.transpose();
  const Eigen::Vector3d ray =
      (turn * tag.place).cwiseProduct(Eigen::Vector3d(1, 1, 0)).normalized();
  const Eigen::Vector3d across{-ray.y(), ray.x(), 0.0};
  const Eigen::Matrix3d of_place = cov.bottomRightCorner<3, 3>();
  out.sigma_range_m = std::sqrt(std::max(0.0, ray.dot(of_place * ray)));
  out.sigma_across_m = std::sqrt(std::max(0.0, across.dot(of_place * across)));
  out.sigma_yaw_rad = std::sqrt(std::max(0.0, cov(2, 2)));
  out.yaw_known = tag.doubt <= params.max_doubt && std::hypot(into.x(), into.y()) > 0.5;
  return out;
}

}  // namespace roverd::nav::tags
