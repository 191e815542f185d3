#include "vision/codec.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace roverd::vision {
namespace {

constexpr std::size_t kFields = 6;
constexpr std::array<const char*, kFields> kFieldWords{"names",     "indices", "landmarks",
                                                       "obstacles", "planes",  "plane sizes"};
constexpr std::size_t kPlaneNumbers = 6;

struct Part {
  std::string_view text;
  std::size_t at = 0;  ///< of its first byte
};

bool printable(std::string_view text) noexcept {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

double length_of(const Point& p) noexcept {
  return std::hypot(p.x_m, p.y_m, p.z_m);
}

/// Reads one field after the other, until the first fault.
class Reading {
 public:
  explicit Reading(Bytes bytes)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

  Decoded take() {
    if (split() && names() && landmarks() && obstacles() && planes()) return std::move(out_);
    out_.datagram = {};
    return std::move(out_);
  }

 private:
  bool fault(Fault what, std::size_t field, std::size_t byte) noexcept {
    out_.fault = what;
    out_.field = field;
    out_.byte = byte;
    return false;
  }
  bool fault_at_end(Fault what, std::size_t field) noexcept {
    return fault(what, field, parts_[field].at + parts_[field].text.size());
  }

  bool split() noexcept {
    std::size_t at = 0;
    for (std::size_t i = 0; i < kFields; ++i) {
      const auto colon = text_.find(':', at);
      const bool last = i + 1 == kFields;
      if ((colon == std::string_view::npos) != last) {
        return fault(Fault::Fields, i, std::min(colon, text_.size()));
      }
      const std::size_t end = last ? text_.size() : colon;
      parts_[i] = {text_.substr(at, end - at), at};
      at = end + 1;
    }
    return true;
  }

  bool names() {
    const Part& part = parts_[0];
    if (part.text.empty()) return true;
    std::size_t at = 0;
    for (;;) {
      const std::size_t end = std::min(part.text.find('#', at), part.text.size());
      const std::string_view name = part.text.substr(at, end - at);
      if (name.empty() || name.size() > kLongestName || !printable(name) ||
          out_.datagram.names.size() == kMostNames) {
        return fault(Fault::Name, 0, at);
      }
      out_.datagram.names.emplace_back(name);
      if (end == part.text.size()) return true;
      at = end + 1;
    }
  }

  /// The numbers of a field, `most` at most; each within ±bound.
  std::optional<std::vector<double>> numbers(std::size_t field, std::size_t most, double bound) {
    const Part& part = parts_[field];
    const auto refuse = [&](Fault what, std::size_t at) -> std::optional<std::vector<double>> {
      fault(what, field, part.at + at);
      return std::nullopt;
    };
    std::vector<double> out;
    std::size_t at = 0;
    while (at < part.text.size()) {
      if (part.text[at] != ' ') return refuse(Fault::Blank, at);
      ++at;
      const std::size_t end = std::min(part.text.find(' ', at), part.text.size());
      if (end == at) return refuse(Fault::Blank, at);
      double value = 0.0;
      const char* const stop = part.text.data() + end;
      const auto [rest, bad] = std::from_chars(part.text.data() + at, stop, value);
      if (bad == std::errc::result_out_of_range) return refuse(Fault::Range, at);
      if (bad != std::errc{} || rest != stop || !std::isfinite(value)) {
        return refuse(Fault::Number, at);
      }
      if (std::abs(value) > bound) return refuse(Fault::Range, at);
      if (out.size() == most) return refuse(Fault::TooMany, at);
      out.push_back(value);
      at = end;
    }
    return out;
  }
  static Point point_at(const std::vector<double>& all, std::size_t i) noexcept {
    return {all[i], all[i + 1], all[i + 2]};
  }

  bool landmarks() {
    const auto indices = numbers(1, kMostLandmarks, kLargestSize);
    if (!indices) return false;
    const auto places = numbers(2, 3 * kMostLandmarks, kFarthest_m);
    if (!places) return false;
    if (places->size() != 3 * indices->size()) return fault_at_end(Fault::Landmarks, 2);
    for (std::size_t i = 0; i < indices->size(); ++i) {
      const double index = (*indices)[i];
      if (index < 0.0 || index != std::floor(index) ||
          index >= static_cast<double>(out_.datagram.names.size())) {
        return fault_at_end(Fault::Index, 1);
      }
      out_.datagram.landmarks.push_back(
          {static_cast<std::size_t>(index), point_at(*places, 3 * i)});
    }
    return true;
  }

  bool obstacles() {
    const auto places = numbers(3, 3 * kMostObstacles, kFarthest_m);
    if (!places) return false;
    if (places->size() % 3 != 0) return fault_at_end(Fault::Triples, 3);
    for (std::size_t i = 0; i < places->size(); i += 3) {
      out_.datagram.obstacles.push_back(point_at(*places, i));
    }
    return true;
  }

  bool planes() {
    const auto places = numbers(4, kPlaneNumbers * kMostPlanes, kFarthest_m);
    if (!places) return false;
    if (places->size() % kPlaneNumbers != 0) return fault_at_end(Fault::Planes, 4);
    const auto sizes = numbers(5, kMostPlanes, kLargestSize);
    if (!sizes) return false;
    if (kPlaneNumbers * sizes->size() != places->size()) return fault_at_end(Fault::Sizes, 5);
    for (std::size_t i = 0; i < sizes->size(); ++i) {
      const Plane plane{point_at(*places, kPlaneNumbers * i),
                        point_at(*places, kPlaneNumbers * i + 3), (*sizes)[i]};
      if (std::abs(length_of(plane.normal) - 1.0) > kNormalOff) {
        return fault_at_end(Fault::Normal, 4);
      }
      if (plane.size < 0.0) return fault_at_end(Fault::Range, 5);
      out_.datagram.planes.push_back(plane);
    }
    return true;
  }

  const std::string_view text_;
  std::array<Part, kFields> parts_{};
  Decoded out_;
};

void put(std::string& out, double value) {
  std::array<char, 32> text{};
  const auto [end, ec] = std::to_chars(text.data(), text.data() + text.size(), value);
  out += ' ';
  out.append(text.data(), end);
}

void put(std::string& out, const Point& p) {
  put(out, p.x_m);
  put(out, p.y_m);
  put(out, p.z_m);
}

base::VisionPoint ahead_left_up(const Point& p) noexcept {
  return {p.z_m, -p.x_m, -p.y_m};
}

}  // namespace

const char* to_string(Fault fault) noexcept {
  switch (fault) {
    case Fault::None:
      return "understood";
    case Fault::Fields:
      return "not six fields between colons";
    case Fault::Name:
      return "a name that is empty, too long, one too many or not printable";
    case Fault::Blank:
      return "a number without exactly one blank before it";
    case Fault::Number:
      return "a number that is none";
    case Fault::Range:
      return "a number beyond what can be";
    case Fault::Index:
      return "an index of no name";
    case Fault::TooMany:
      return "more numbers than are taken";
    case Fault::Landmarks:
      return "not three numbers for each landmark";
    case Fault::Triples:
      return "not three numbers for each obstacle";
    case Fault::Planes:
      return "not six numbers for each plane";
    case Fault::Sizes:
      return "not one size for each plane";
    case Fault::Normal:
      return "a normal whose length is not 1";
  }
  return "";
}

Decoded decode(Bytes bytes) {
  return Reading(bytes).take();
}

std::string describe(const Decoded& decoded) {
  if (decoded.fault == Fault::None) return to_string(decoded.fault);
  return std::string(to_string(decoded.fault)) + ": field " + std::to_string(decoded.field) + " (" +
         kFieldWords[std::min(decoded.field, kFields - 1)] + "), byte " +
         std::to_string(decoded.byte);
}

std::string encode(const Datagram& d) {
  std::string out;
  for (const std::string& name : d.names) out += (out.empty() ? "" : "#") + name;
  out += ':';
  for (const Landmark& l : d.landmarks) put(out, static_cast<double>(l.name));
  out += ':';
  for (const Landmark& l : d.landmarks) put(out, l.at);
  out += ':';
  for (const Point& p : d.obstacles) put(out, p);
  out += ':';
  for (const Plane& p : d.planes) {
    put(out, p.centre);
    put(out, p.normal);
  }
  out += ':';
  for (const Plane& p : d.planes) put(out, p.size);
  return out;
}

base::Vision seen(const Datagram& d) {
  base::Vision out;
  for (const Landmark& l : d.landmarks) {
    out.landmarks.push_back({d.names[l.name], ahead_left_up(l.at)});
  }
  for (const Point& p : d.obstacles) out.obstacles.push_back(ahead_left_up(p));
  for (const Plane& p : d.planes) {
    const double one = length_of(p.normal);
    out.planes.push_back(
        {ahead_left_up(p.centre),
         ahead_left_up({p.normal.x_m / one, p.normal.y_m / one, p.normal.z_m / one}), p.size});
  }
  return out;
}

}  // namespace roverd::vision
