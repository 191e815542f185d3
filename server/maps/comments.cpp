#include "maps/comments.hpp"

#include <array>
#include <charconv>
#include <cstddef>
#include <system_error>

namespace roverd::maps {

namespace {

/// The shortest that reads back as the same.
std::string decimal(double value) {
  std::array<char, 400> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr;
  return {text.data(), end};
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

struct Field {
  std::string_view name;
  double low;
  double high;
  bool needed;
  double Anchor::*member;  ///< null: of the place
  double base::LatLon::*of_place;
};
constexpr std::array<Field, 5> kFields{{
    {"anchor_lat", -90.0, 90.0, true, nullptr, &base::LatLon::lat},
    {"anchor_lon", -180.0, 180.0, true, nullptr, &base::LatLon::lon},
    {"anchor_heading_deg", 0.0, 360.0, true, &Anchor::heading_deg, nullptr},
    {"anchor_accuracy_m", 0.0, 10.0, false, &Anchor::accuracy_m, nullptr},
    {"anchor_heading_accuracy_deg", 0.0, 45.0, false, &Anchor::heading_accuracy_deg, nullptr},
}};

double value_of(const Field& field, const Anchor& anchor) {
  return field.member != nullptr ? anchor.*field.member : anchor.at.*field.of_place;
}

/// Reads line by line; each field at most once.
class CommentReader {
 public:
  void line(std::string_view name, std::string_view value) {
    if (name == "name" && out_.name.empty()) out_.name = value;
    for (std::size_t i = 0; i < kFields.size(); ++i) {
      if (kFields[i].name == name) read(i, value);
    }
  }

  Comments done() {
    bool any = false;
    for (const int n : times_) any = any || n > 0;
    if (!any) return out_;
    for (std::size_t i = 0; i < kFields.size(); ++i) {
      if (bad_[i] || times_[i] > 1 || (kFields[i].needed && times_[i] == 0)) {
        out_.wrong.push_back("# " + std::string(kFields[i].name));
      }
    }
    if (out_.wrong.empty()) out_.anchor = anchor_;
    return out_;
  }

 private:
  void read(std::size_t i, std::string_view text) {
    const Field& field = kFields[i];
    ++times_[i];
    double value = 0.0;
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = ec == std::errc{} && end == text.data() + text.size() && value >= field.low &&
                      value <= field.high;
    if (!good) {
      bad_[i] = true;
    } else if (field.member != nullptr) {
      anchor_.*field.member = value;
    } else {
      anchor_.at.*field.of_place = value;
    }
  }

  Comments out_;
  Anchor anchor_;
  std::array<int, kFields.size()> times_{};
  std::array<bool, kFields.size()> bad_{};
};

}  // namespace

std::string comments_of(const About& about) {
  std::string text = "# name: " + about.name + "\n";
  if (!about.anchor) return text;
  for (const Field& field : kFields) {
    text += "# " + std::string(field.name) + ": " + decimal(value_of(field, *about.anchor)) + "\n";
  }
  return text;
}

Comments read_comments(std::string_view yaml) {
  CommentReader reader;
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (yaml.starts_with(kMark)) yaml.remove_prefix(kMark.size());
  while (!yaml.empty()) {
    const auto end = yaml.find('\n');
    std::string_view line = trimmed(yaml.substr(0, end));
    yaml.remove_prefix(end == std::string_view::npos ? yaml.size() : end + 1);
    if (line.empty()) continue;
    if (!line.starts_with('#')) break;
    line.remove_prefix(1);
    const auto colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    reader.line(trimmed(line.substr(0, colon)), trimmed(line.substr(colon + 1)));
  }
  return reader.done();
}

}  // namespace roverd::maps
