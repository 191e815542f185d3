// Frames of docs/cloud-format.md to named values, and lines of rangers.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "cloud/codec.hpp"
#include "ranges/codec.hpp"
#include "tools/decode.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

/// What is no number has no place in JSON.
Json finite_or_null(float value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

void describe_cloud(const cloud::Cloud& body, Json& out) {
  std::uint64_t points = 0;
  for (std::size_t i = 0; i < body.count; ++i) {
    const std::uint8_t* at = body.data.data() + 12 * i;
    const bool finite = std::isfinite(cloud::f32_at(at)) && std::isfinite(cloud::f32_at(at + 4)) &&
                        std::isfinite(cloud::f32_at(at + 8));
    points += finite ? 1U : 0U;
  }
  out["message"] = "cloud";
  out["points"] = body.count;
  out["finite"] = points;
  out["half_step_rad"] = body.half_step_rad;
}

void describe_cloud(const cloud::Depth& body, Json& out) {
  std::uint64_t valid = 0;
  std::uint16_t least = 0;
  std::uint16_t most = 0;
  for (std::size_t i = 0; 2 * i < body.data.size(); ++i) {
    const std::uint16_t depth = cloud::u16_at(body.data.data() + 2 * i);
    if (depth == 0) continue;
    least = valid == 0 ? depth : std::min(least, depth);
    most = std::max(most, depth);
    ++valid;
  }
  out["message"] = "depth";
  out["width"] = body.width;
  out["height"] = body.height;
  out["fx"] = body.fx;
  out["fy"] = body.fy;
  out["cx"] = body.cx;
  out["cy"] = body.cy;
  out["unit_m"] = body.unit_m;
  out["valid"] = valid;
  out["least"] = valid == 0 ? Json(nullptr) : Json(least);
  out["most"] = valid == 0 ? Json(nullptr) : Json(most);
}

void describe_cloud(const cloud::Ranges& body, Json& out) {
  out["message"] = "ranges";
  out["first_rad"] = body.first_rad;
  out["step_rad"] = body.step_rad;
  Json ranges = Json::array();
  for (std::size_t i = 0; i < body.count; ++i) {
    ranges.push_back(finite_or_null(cloud::f32_at(body.data.data() + 4 * i)));
  }
  out["range_m"] = std::move(ranges);
}

Json cloud_object(const cloud::Frame& frame) {
  Json out;
  std::visit([&](const auto& body) { describe_cloud(body, out); }, frame.body);
  out["sequence"] = frame.header.sequence;
  out["stamp_ns"] = frame.header.stamp_ns;
  out["optical"] = frame.header.optical;
  out["good"] = frame.header.good;
  if (const auto& p = frame.header.pose) {
    out["pose"] = {{"x_m", p->x_m},
                   {"y_m", p->y_m},
                   {"z_m", p->z_m},
                   {"roll_rad", p->roll_rad},
                   {"pitch_rad", p->pitch_rad},
                   {"yaw_rad", p->yaw_rad}};
  }
  return out;
}

class CloudBytes {
 public:
  explicit CloudBytes(OnObject on_object) : on_object_(std::move(on_object)) {}

  void feed(base::Bytes part) {
    decoder_.feed(part, [this](const cloud::Frame& frame) {
      tell_refused();
      on_object_(cloud_object(frame));
    });
  }
  /// Each cause once between two frames, with how many.
  void tell_refused() {
    for (const auto& [cause, n] : decoder_.refused()) {
      std::uint64_t& told = told_[cause];
      if (n > told) on_object_({{"count", n - told}, {"refused", cause}});
      told = n;
    }
  }

 private:
  const OnObject on_object_;
  cloud::Decoder decoder_{cloud::kMaxPoints};
  std::map<std::string, std::uint64_t> told_;
};

Json ranges_object(std::string_view text) {
  const ranges::Line line = ranges::parse(text, 1.0);
  Json out;
  out["line"] = text;
  if (line.fault != nullptr) {
    out["refused"] = line.fault;
    return out;
  }
  Json readings = Json::array();
  for (const ranges::Reading& r : line.readings) {
    if (r.outcome == ranges::Outcome::Range) {
      readings.push_back(r.range_m);
    } else {
      readings.push_back(r.outcome == ranges::Outcome::Nothing ? "nothing" : "unknown");
    }
  }
  out["range_m"] = std::move(readings);
  return out;
}

}  // namespace

Reader cloud_reader(OnObject on_object) {
  const auto bytes = std::make_shared<CloudBytes>(std::move(on_object));
  return {.feed = [bytes](base::Bytes part) { bytes->feed(part); },
          .finish = [bytes] { bytes->tell_refused(); }};
}

Reader ranges_reader(OnObject on_object) {
  const auto lines = std::make_shared<ranges::Lines>();
  const auto feed = [lines, on_object](base::Bytes part) {
    lines->feed(
        part, [&](std::string_view text) { on_object(ranges_object(text)); },
        [&] {
          on_object({{"refused", "a line that is too long"}});
        });
  };
  // The last line may lack its end.
  return {.feed = feed, .finish = [feed] {
            constexpr std::uint8_t kEnd = '\n';
            feed(base::Bytes(&kEnd, 1));
          }};
}

}  // namespace roverd
