#include "sim/picture_voice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "camera/jpeg.hpp"

namespace roverd::sim {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;
constexpr int kJpegQuality = 88;
constexpr double kPiece_px = 2.5;
constexpr int kMostPieces = 6;  ///< 3 ms each
constexpr std::string_view kEndOfHead = "\r\n\r\n";

world::Frame mount_of(const world::SensorParams& p) {
  return world::Frame({.x_m = p.x_m,
                       .y_m = p.y_m,
                       .z_m = p.z_m,
                       .roll_rad = p.roll_deg * kRadian,
                       .pitch_rad = p.pitch_deg * kRadian,
                       .yaw_rad = p.yaw_deg * kRadian});
}

}  // namespace

PictureVoice::PictureVoice(const world::SensorParams& p)
    : params_(p), mount_(mount_of(p)), painter_(p.columns, p.rows, p.fov_h_deg * kRadian) {}

std::vector<std::uint8_t> PictureVoice::receive(base::Bytes bytes) {
  asked_.append(bytes.begin(), bytes.end());
  const bool whole = asked_.find(kEndOfHead) != std::string::npos;
  if (!whole) {
    if (asked_.size() > 8192) asked_.erase(0, asked_.size() - kEndOfHead.size());
    return {};
  }
  asked_.clear();
  speaks_ = true;
  constexpr std::string_view kHead =
      "HTTP/1.0 200 OK\r\nCache-Control: no-store\r\n"
      "Content-Type: multipart/x-mixed-replace; boundary=picture\r\n\r\n";
  return {kHead.begin(), kHead.end()};
}

/// In as many pieces as it is blurred: standing, one.
void PictureVoice::expose(const Surroundings& around, double until_s) {
  const auto camera_at = [&](double at_s) { return world::Frame(around.pose_at(at_s)) * mount_; };
  const double blur_px =
      painter_.blur_px(camera_at(until_s - params_.exposure_s), camera_at(until_s));
  const int pieces = std::clamp(static_cast<int>(std::ceil(blur_px / kPiece_px)), 1, kMostPieces);
  for (int i = 0; i < pieces; ++i) {
    const double at_s = until_s - params_.exposure_s * (1.0 - (i + 0.5) / pieces);
    around.scene().move_to(moment_, at_s);
    painter_.expose(around.scene(), moment_, camera_at(at_s));
  }
}

std::vector<std::uint8_t> PictureVoice::say(const Surroundings& around, const world::Sweep& sweep,
                                            const world::SensorFaults& faults) {
  if (!speaks_) return {};
  world::Draw draw(sweep.count + 1);
  if (!faults.sensor_freeze || picture_.empty()) {
    expose(around, sweep.at_s);
    const auto& grey = painter_.develop(sweep.count, faults.glare);
    auto made =
        camera::jpeg_of_grey(grey, params_.columns, params_.rows, params_.columns, kJpegQuality);
    if (!made) return {};
    picture_ = std::move(*made);
  }
  std::vector<std::uint8_t> body = picture_;
  if (draw.uniform() < faults.sensor_malformed) {
    for (std::uint8_t& byte : body) byte = static_cast<std::uint8_t>(draw.below(256));
  }
  if (draw.uniform() < faults.sensor_dropout) return {};
  const std::string head =
      "--picture\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(body.size()) +
      "\r\n\r\n";
  std::vector<std::uint8_t> out(head.begin(), head.end());
  out.insert(out.end(), body.begin(), body.end());
  out.push_back('\r');
  out.push_back('\n');
  return out;
}

}  // namespace roverd::sim
