#include "sim/picture_voice.hpp"

#include <numbers>
#include <string_view>
#include <utility>

#include "camera/jpeg.hpp"

namespace roverd::sim {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;
constexpr int kJpegQuality = 88;
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

std::vector<std::uint8_t> PictureVoice::say(const Surroundings& around, const world::Sweep& sweep,
                                            const world::SensorFaults& faults) {
  if (!speaks_) return {};
  if (!faults.sensor_freeze || picture_.empty()) {
    around.scene().move_to(moment_, sweep.at_s);
    const world::Frame camera = world::Frame(around.pose_at(sweep.at_s)) * mount_;
    const auto& grey = painter_.paint(around.scene(), moment_, camera, sweep.count);
    auto made =
        camera::jpeg_of_grey(grey, params_.columns, params_.rows, params_.columns, kJpegQuality);
    if (!made) return {};
    picture_ = std::move(*made);
  }
  std::vector<std::uint8_t> body = picture_;
  world::Draw draw(sweep.count + 1);
  if (draw.uniform() < faults.sensor_malformed) {
    for (std::uint8_t& byte : body) byte = static_cast<std::uint8_t>(draw.below(256));
  }
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
