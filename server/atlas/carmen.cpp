#include "atlas/carmen.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::atlas {

namespace {

using nav::sense::Pose2;

/// Takes words off the front of a line.
class LineWords {
 public:
  explicit LineWords(std::string_view line) : rest_(line) {}

  /// Empty at the end.
  std::string_view word() noexcept {
    const std::size_t begin = rest_.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    rest_.remove_prefix(begin);
    const std::size_t end = std::min(rest_.find_first_of(" \t"), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }

  /// Finite, and no larger than anything measured here.
  bool number(double& out) noexcept {
    const std::string_view text = word();
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
    return ec == std::errc{} && end == text.data() + text.size() && !text.empty() &&
           std::abs(out) < 1e12;
  }

  bool pose(Pose2& out) noexcept {
    return number(out.x_m) && number(out.y_m) && number(out.yaw_rad);
  }

  std::string_view rest() const noexcept { return rest_; }

 private:
  std::string_view rest_;
};

bool same_place(const Pose2& a, const Pose2& b) noexcept {
  constexpr double kWritten = 2e-4;  // poses are written with four to six decimals
  return std::abs(a.x_m - b.x_m) < kWritten && std::abs(a.y_m - b.y_m) < kWritten &&
         std::abs(base::angle_diff_rad(a.yaw_rad, b.yaw_rad)) < kWritten;
}

}  // namespace

nav::chart::Scan scan_of(const CarmenScan& scan, base::Time stamp) {
  constexpr float kNothing_m = 79.0F;
  constexpr float kNearest_m = 0.05F;
  nav::chart::Scan out;
  out.stamp = stamp;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const float range = scan.ranges_m[i];
    if (!(range >= kNearest_m && range < kNothing_m)) continue;
    const float angle = scan.first_rad + scan.step_rad * static_cast<float>(i);
    out.beams.push_back({range * std::cos(angle), range * std::sin(angle), true});
  }
  return out;
}

void CarmenReader::feed(base::Bytes part) {
  for (const std::uint8_t b : part) {
    if (b == '\n') {
      line_done();
    } else if (line_.size() < kLongestLine) {
      line_.push_back(static_cast<char>(b));
    } else {
      too_long_ = true;
    }
  }
}

void CarmenReader::finish() {
  if (!line_.empty() || too_long_) line_done();
}

void CarmenReader::line_done() {
  ++lines_;
  if (line_.ends_with('\r')) line_.pop_back();
  LineWords words(line_);
  const std::string_view kind = words.word();
  const char* wrong = nullptr;
  if (too_long_) {
    wrong = "longer than 64 KiB";
  } else if (kind == "ODOM") {
    wrong = odometry_record(words.rest());
  } else if (kind == "FLASER") {
    wrong = scan_record(words.rest());
  }
  if (wrong != nullptr && refused_++ == 0) {
    first_refused_ = "line " + std::to_string(lines_) + ": " + wrong;
  }
  line_.clear();
  too_long_ = false;
}

const char* CarmenReader::odometry_record(std::string_view text) {
  LineWords words(text);
  Pose2 pose;
  if (!words.pose(pose)) return "ODOM without x, y and theta";
  const bool repeats = repeated_ && same_place(pose, *repeated_);
  if (last_ && !repeats) chained_ = chained_ * (inverse(*last_) * pose);
  last_ = pose;
  repeated_.reset();
  ++odometry_lines_;
  return nullptr;
}

const char* CarmenReader::scan_record(std::string_view text) {
  LineWords words(text);
  double count = 0.0;
  if (!words.number(count) || !(count >= 1.0 && count <= static_cast<double>(kMostBeams)) ||
      count != std::floor(count)) {
    return "FLASER without a count of beams from 1 to 4096";
  }
  const auto beams = static_cast<std::size_t>(count);
  scan_.ranges_m.resize(beams);
  for (float& range : scan_.ranges_m) {
    double value = 0.0;
    if (!words.number(value)) return "FLASER with fewer ranges than it counts";
    range = static_cast<float>(value);
  }
  Pose2 odometry;
  if (!words.pose(scan_.pose) || !words.pose(odometry)) return "FLASER without its two poses";
  if (!words.number(scan_.time_s)) return "FLASER without its time";
  const bool closed = beams % 2 == 1 && beams > 1;  // the last beam lies at +90 deg
  scan_.first_rad = static_cast<float>(-base::kPi / 2.0);
  scan_.step_rad = static_cast<float>(base::kPi / static_cast<double>(closed ? beams - 1 : beams));
  if (!begun_) chained_ = scan_.pose;
  begun_ = true;
  scan_.odometry = chained_;
  scan_.line = lines_;
  repeated_ = odometry;
  ++scans_;
  on_scan_(scan_);
  return nullptr;
}

}  // namespace roverd::atlas
