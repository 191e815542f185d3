// The words about a map. yaml-cpp throws; nothing of that passes this file.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "atlas/map_files.hpp"

namespace roverd::atlas {

namespace {

using base::Code;
using base::FieldError;
using base::Result;

constexpr std::size_t kLongestName = 40;  // that is told

/// Plain decimal numbers only: what yaml calls infinite or not a number is none here.
std::optional<double> number_of(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  std::string_view text = node.Scalar();
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// A word that yaml reads as it stands (with a point in it, so that it is neither null nor true);
/// everything else is quoted.
std::string file_name_text(const std::string& name) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-";
  const bool plain = name.find('.') != std::string::npos &&
                     name.find_first_not_of(kPlain) == std::string::npos && name.front() != '-';
  if (plain) return name;
  YAML::Emitter quoted;
  quoted << YAML::DoubleQuoted << name;
  return quoted.c_str();
}

/// Reads field by field and remembers what was wrong with each.
class FieldReader {
 public:
  explicit FieldReader(const YAML::Node& table) : table_(table) {}

  /// Of two, some readers take the first and some the last.
  void no_name_twice() {
    std::set<std::string> names;
    for (const auto& line : table_) {
      if (!line.first.IsScalar() || names.insert(line.first.Scalar()).second) continue;
      wrong(line.first.Scalar().substr(0, kLongestName).c_str(), "is given twice");
    }
  }

  void text(const char* name, std::string& out) {
    const YAML::Node node = wanted(name);
    if (!node) return;
    if (!node.IsScalar() || node.Scalar().empty() ||
        node.Scalar().find('\0') != std::string::npos) {
      return wrong(name, "must be a file name");
    }
    // A yaml is UTF-8, though its reader lets other bytes pass: they could not be written again.
    if (YAML::Load(file_name_text(node.Scalar())).Scalar() != node.Scalar()) {
      return wrong(name, "must be a file name in UTF-8");
    }
    out = node.Scalar();
  }

  void number(const char* name, double low, double high, double& out) {
    const YAML::Node node = wanted(name);
    if (!node) return;
    const auto value = number_of(node);
    if (!value || *value < low || *value > high) {
      return wrong(name, "must be a number from " + plain(low) + " to " + plain(high));
    }
    out = *value;
  }

  void origin(nav::chart::Pose2& out) {
    const YAML::Node node = wanted("origin");
    if (!node) return;
    constexpr double kFar_m = 1e6;
    std::array<double, 3> values{};
    bool good = node.IsSequence() && node.size() == values.size();
    for (std::size_t i = 0; good && i < values.size(); ++i) {
      const auto value = number_of(node[i]);
      good = value.has_value();
      if (good) values[i] = *value;
    }
    if (!good) return wrong("origin", "must be three finite numbers: x, y, yaw");
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::abs(v) > kFar_m; })) {
      return wrong("origin",
                   "must lie within 1000 km of zero: take a corner of the site off coordinates of "
                   "a country");
    }
    out = {values[0], values[1], values[2]};
  }

  void negate(bool& out) {
    const YAML::Node node = wanted("negate");
    if (!node) return;
    // YAML 1.1 has more words for it than 1.2, and both are written.
    constexpr std::array<std::string_view, 5> kNo = {"0", "false", "no", "off", "n"};
    constexpr std::array<std::string_view, 5> kYes = {"1", "true", "yes", "on", "y"};
    std::string word = node.IsScalar() ? node.Scalar() : std::string();
    for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    out = std::find(kYes.begin(), kYes.end(), word) != kYes.end();
    if (!out && std::find(kNo.begin(), kNo.end(), word) == kNo.end()) {
      wrong("negate", "must be 0 or 1");
    }
  }

  void mode(MapMode& out) {
    const YAML::Node node = table_["mode"];
    if (!node) return;
    for (const MapMode m : {MapMode::Trinary, MapMode::Scale, MapMode::Raw}) {
      if (node.IsScalar() && node.Scalar() == to_string(m)) {
        out = m;
        return;
      }
    }
    wrong("mode", "must be trinary, scale or raw");
  }

  void wrong(const char* name, std::string detail) {
    problems_.push_back({std::string("/") + name, std::move(detail)});
  }
  std::vector<FieldError>& problems() { return problems_; }

 private:
  static std::string plain(double value) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
  }

  YAML::Node wanted(const char* name) {
    const YAML::Node node = table_[name];
    if (!node) wrong(name, "is missing");
    return node;
  }

  const YAML::Node& table_;
  std::vector<FieldError> problems_;
};

std::vector<std::string> others_of(const YAML::Node& table) {
  constexpr std::array<std::string_view, 7> kOurs = {
      "image", "mode", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"};
  std::vector<std::string> out;
  for (const auto& line : table) {
    const std::string name = line.first.IsScalar() ? line.first.Scalar() : std::string("?");
    if (std::find(kOurs.begin(), kOurs.end(), name) != kOurs.end()) continue;
    if (out.size() == kMostOthers) break;
    out.push_back(name.substr(0, kLongestName));
  }
  return out;
}

Result<MapWords> words_of(const YAML::Node& table) {
  if (!table.IsMap()) {
    return base::fail(Code::Malformed, "the words of a map are lines of name: value",
                      {{"line 1", "must be name: value"}});
  }
  MapWords words;
  FieldReader reader(table);
  reader.no_name_twice();
  reader.text("image", words.image);
  reader.mode(words.mode);
  reader.number("resolution", nav::chart::kFinest_m, nav::chart::kCoarsest_m, words.resolution_m);
  reader.origin(words.origin);
  reader.negate(words.negate);
  reader.number("occupied_thresh", 0.0, 1.0, words.occupied_thresh);
  reader.number("free_thresh", 0.0, 1.0, words.free_thresh);
  words.others = others_of(table);
  if (reader.problems().empty() && words.free_thresh > words.occupied_thresh) {
    reader.wrong("free_thresh", "must not be above occupied_thresh");
  }
  if (!reader.problems().empty()) {
    const FieldError& first = reader.problems().front();
    std::string detail = first.pointer.substr(1) + " " + first.detail;
    return base::fail(Code::Invalid, std::move(detail), std::move(reader.problems()));
  }
  return words;
}

/// The shortest text that reads back as the same; with_point: at least one digit behind it.
std::string number_text(double value, bool with_point) {
  std::array<char, 400> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr;
  std::string written(text.data(), end);
  if (with_point && written.find('.') == std::string::npos) written += ".0";
  return written;
}

}  // namespace

std::string_view to_string(MapMode m) noexcept {
  switch (m) {
    case MapMode::Trinary:
      return "trinary";
    case MapMode::Scale:
      return "scale";
    case MapMode::Raw:
      return "raw";
  }
  return "trinary";
}

Result<MapWords> read_words(std::string_view yaml) {
  if (yaml.size() > kLargestWords) {
    return base::fail(Code::TooLarge, "the words of a map have at most 64 KiB");
  }
  try {
    return words_of(YAML::Load(std::string(yaml)));
  } catch (const YAML::Exception& e) {
    const std::string line = "line " + std::to_string(e.mark.line + 1);
    return base::fail(Code::Malformed, line + " is no yaml: " + e.msg, {{line, e.msg}});
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return base::fail(Code::Malformed, std::string("no yaml: ") + e.what());
  }
}

std::string write_words(const MapWords& words) {
  std::string text = "image: " + file_name_text(words.image) + "\n";
  text += "mode: " + std::string(to_string(words.mode)) + "\n";
  text += "resolution: " + number_text(words.resolution_m, false) + "\n";
  text += "origin: [" + number_text(words.origin.x_m, true) + ", " +
          number_text(words.origin.y_m, true) + ", " + number_text(words.origin.yaw_rad, false) +
          "]\n";
  text += std::string("negate: ") + (words.negate ? "1" : "0") + "\n";
  text += "occupied_thresh: " + number_text(words.occupied_thresh, false) + "\n";
  text += "free_thresh: " + number_text(words.free_thresh, false) + "\n";
  return text;
}

}  // namespace roverd::atlas
