// The plot of one course under one disturbance.
//
//   ┌ the way from above ┐ ┌ e over s, left positive ┐

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "study/study.hpp"

namespace roverd::study {
namespace {

constexpr double kSide_px = 620.0;
constexpr double kWide_px = 900.0;
constexpr double kHigh_px = 420.0;
constexpr double kMargin_px = 45.0;

std::string number(double value, int decimals = 1) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

struct Box {
  double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;

  void take(double x, double y) {
    low_x = std::min(low_x, x);
    high_x = std::max(high_x, x);
    low_y = std::min(low_y, y);
    high_y = std::max(high_y, y);
  }
};

/// From metres to the picture's pixels.
class Frame {
 public:
  Frame(const Box& box, double left_px, double wide_px, double high_px, bool equal)
      : box_(box), left_px_(left_px), high_px_(high_px) {
    scale_x_ = (wide_px - 2 * kMargin_px) / std::max(1e-6, box.high_x - box.low_x);
    scale_y_ = (high_px - 2 * kMargin_px) / std::max(1e-6, box.high_y - box.low_y);
    if (equal) scale_x_ = scale_y_ = std::min(scale_x_, scale_y_);
  }
  double x(double metres) const { return left_px_ + kMargin_px + (metres - box_.low_x) * scale_x_; }
  double y(double metres) const { return high_px_ - kMargin_px - (metres - box_.low_y) * scale_y_; }

 private:
  Box box_;
  double left_px_;
  double high_px_;
  double scale_x_ = 1.0;
  double scale_y_ = 1.0;
};

template <class List, class X, class Y>
std::string line(const List& list, const Frame& frame, X x, Y y, const std::string& style) {
  std::string out = "<polyline fill=\"none\" " + style + " points=\"";
  for (const auto& p : list) out += number(frame.x(x(p))) + "," + number(frame.y(y(p))) + " ";
  return out + "\"/>\n";
}

std::string text(double x_px, double y_px, const std::string& what, const char* anchor = "start") {
  std::string safe;
  for (const char c : what) {
    safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return "<text x=\"" + number(x_px) + "\" y=\"" + number(y_px) + "\" text-anchor=\"" + anchor +
         "\">" + safe + "</text>\n";
}

std::string colour(std::size_t i, std::size_t n) {
  const double hue =
      360.0 * static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(1, n));
  return "stroke=\"hsl(" + number(hue, 0) + ",70%,45%)\" stroke-width=\"0.8\"";
}

std::string map_of(const std::vector<const Run*>& runs) {
  Box box;
  for (const auto& p : runs[0]->way) box.take(p.east_m, p.north_m);
  for (const Run* r : runs) {
    for (const auto& p : r->driven) box.take(p.at.east_m, p.at.north_m);
  }
  const Frame frame(box, 0.0, kSide_px, kSide_px, true);
  const auto east = [](const base::EnuPoint& p) { return p.east_m; };
  const auto north = [](const base::EnuPoint& p) { return p.north_m; };
  const auto driven_east = [](const nav::DrivenPoint& p) { return p.at.east_m; };
  const auto driven_north = [](const nav::DrivenPoint& p) { return p.at.north_m; };
  std::string out = line(runs[0]->way, frame, east, north, "stroke=\"#bbb\" stroke-width=\"4\"");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    out += line(runs[i]->driven, frame, driven_east, driven_north, colour(i, runs.size()));
  }
  out += text(
      kMargin_px, kSide_px - 12,
      number(box.high_x - box.low_x) + " m east, " + number(box.high_y - box.low_y) + " m north");
  return out;
}

std::string errors_of(const std::vector<const Run*>& runs) {
  Box box;
  double most = 0.05;
  for (const Run* r : runs) {
    for (const nav::Matched& m : r->matched) {
      most = std::max(most, std::abs(m.cross_m));
      box.take(m.s_m, 0.0);
    }
  }
  if (box.low_x > box.high_x) return {};
  box.take(box.low_x, most);
  box.take(box.low_x, -most);
  const Frame frame(box, kSide_px, kWide_px, kHigh_px, false);
  std::string out;
  for (const double e : {-most, 0.0, most}) {
    const std::array<base::EnuPoint, 2> ends{{{box.low_x, e}, {box.high_x, e}}};
    out += line(
        ends, frame, [](const base::EnuPoint& p) { return p.east_m; },
        [](const base::EnuPoint& p) { return p.north_m; }, "stroke=\"#ccc\"");
    out += text(kSide_px + kMargin_px - 4, frame.y(e) + 4, number(e, 2) + " m", "end");
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    out += line(
        runs[i]->matched, frame, [](const nav::Matched& m) { return m.s_m; },
        [](const nav::Matched& m) { return m.cross_m; }, colour(i, runs.size()));
  }
  return out + text(kSide_px + kWide_px - kMargin_px, kHigh_px - 20,
                    "way, to " + number(box.high_x) + " m", "end");
}

}  // namespace

std::string to_svg(const std::vector<const Run*>& runs) {
  if (runs.empty()) return {};
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
                    number(kSide_px + kWide_px, 0) + "\" height=\"" + number(kSide_px, 0) +
                    "\" font-family=\"sans-serif\" font-size=\"13\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  out += text(kMargin_px, 24, runs[0]->course + " / " + runs[0]->disturbance);
  out += map_of(runs);
  out += errors_of(runs);
  nav::CrossTrack worst;
  for (const Run* r : runs) {
    worst.rms_m = std::max(worst.rms_m, r->truth.cross.rms_m);
    worst.p95_m = std::max(worst.p95_m, r->truth.cross.p95_m);
    worst.max_m = std::max(worst.max_m, r->truth.cross.max_m);
  }
  out +=
      text(kSide_px + kMargin_px, kHigh_px + 20,
           std::to_string(runs.size()) + " runs; worst: rms " + number(worst.rms_m, 3) +
               " m, 95 % " + number(worst.p95_m, 3) + " m, max " + number(worst.max_m, 3) + " m");
  return out + "</svg>\n";
}

}  // namespace roverd::study
