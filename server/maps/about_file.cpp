#include "maps/about_file.hpp"

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

namespace roverd::maps {

namespace {

using Json = nlohmann::json;
using base::Code;
using base::Result;

constexpr double kLatest_ms = 9e12;  // the year 2255
constexpr double kMostCount = 1e9;

/// Reads member by member; the first that is wrong is remembered.
class Reader {
 public:
  explicit Reader(const Json& object) : object_(object) {}

  double number(const char* name, double low, double high) {
    const Json* value = member(name);
    if (value == nullptr || !value->is_number()) return refuse(name), low;
    const double v = value->get<double>();
    if (!(v >= low && v <= high)) return refuse(name), low;
    return v;
  }
  std::int64_t whole(const char* name, double low, double high) {
    return static_cast<std::int64_t>(std::floor(number(name, low, high)));
  }
  std::string text(const char* name) {
    const Json* value = member(name);
    if (value == nullptr || !value->is_string()) return refuse(name), std::string();
    return value->get<std::string>();
  }
  const Json* member(const char* name) const {
    const auto at = object_.find(name);
    return at == object_.end() ? nullptr : &*at;
  }
  void refuse(const char* name) {
    if (wrong_.empty()) wrong_ = name;
  }
  const std::string& wrong() const { return wrong_; }

 private:
  const Json& object_;
  std::string wrong_;
};

std::optional<Area> area_from(const Json& json) {
  if (!json.is_array() || json.size() < 3 || json.size() > kMostCorners) return std::nullopt;
  Area area;
  for (const Json& corner : json) {
    if (!corner.is_array() || corner.size() != 2) return std::nullopt;
    if (!corner[0].is_number() || !corner[1].is_number()) return std::nullopt;
    const Corner c{corner[0].get<double>(), corner[1].get<double>()};
    if (!(std::abs(c.x_m) <= kFarthest_m && std::abs(c.y_m) <= kFarthest_m)) return std::nullopt;
    area.push_back(c);
  }
  return area;
}

void read_forbidden(Reader& reader, std::vector<Area>& out) {
  const Json* list = reader.member("forbidden");
  if (list == nullptr || !list->is_array() || list->size() > kMostForbidden) {
    return reader.refuse("forbidden");
  }
  for (const Json& one : *list) {
    auto area = area_from(one);
    if (!area) return reader.refuse("forbidden");
    out.push_back(std::move(*area));
  }
}

void read_anchor(Reader& reader, std::optional<Anchor>& out) {
  const Json* json = reader.member("anchor");
  if (json != nullptr && json->is_null()) return;
  if (json == nullptr || !json->is_object()) return reader.refuse("anchor");
  Reader inner(*json);
  Anchor a;
  a.at.lat = inner.number("lat", -90.0, 90.0);
  a.at.lon = inner.number("lon", -180.0, 180.0);
  a.heading_deg = inner.number("heading_deg", 0.0, 360.0);
  a.accuracy_m = inner.number("accuracy_m", 0.0, 10.0);
  a.heading_accuracy_deg = inner.number("heading_accuracy_deg", 0.0, 45.0);
  if (!inner.wrong().empty()) return reader.refuse("anchor");
  out = a;
}

/// A plain name in the map's own folder.
void read_image(Reader& reader, std::string& out) {
  out = reader.text("image");
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyz0123456789.";
  if (out.empty() || out.front() == '.' || out.size() > 60 ||
      out.find_first_not_of(kPlain) != std::string::npos) {
    reader.refuse("image");
  }
}

void read_mode(Reader& reader, atlas::MapMode& out) {
  const std::string word = reader.text("mode");
  for (const auto m : {atlas::MapMode::Trinary, atlas::MapMode::Scale, atlas::MapMode::Raw}) {
    if (word == atlas::to_string(m)) {
      out = m;
      return;
    }
  }
  reader.refuse("mode");
}

}  // namespace

atlas::MapWords Kept::words() const {
  atlas::MapWords out;
  out.image = image;
  out.mode = mode;
  out.resolution_m = about.shape.resolution_m;
  out.origin = about.shape.origin;
  return out;
}

std::string about_text(const Kept& kept) {
  const About& a = kept.about;
  Json forbidden = Json::array();
  for (const Area& area : a.forbidden) {
    Json corners = Json::array();
    for (const Corner& c : area) corners.push_back({c.x_m, c.y_m});
    forbidden.push_back(std::move(corners));
  }
  const auto ms = std::chrono::floor<std::chrono::milliseconds>(a.created.time_since_epoch());
  Json out = {{"name", a.name},
              {"created_ms", ms.count()},
              {"revision", a.revision},
              {"image", kept.image},
              {"mode", atlas::to_string(kept.mode)},
              {"columns", a.shape.columns},
              {"rows", a.shape.rows},
              {"resolution_m", a.shape.resolution_m},
              {"x_m", a.shape.origin.x_m},
              {"y_m", a.shape.origin.y_m},
              {"yaw_rad", a.shape.origin.yaw_rad},
              {"anchor", nullptr},
              {"forbidden", std::move(forbidden)}};
  if (a.anchor) {
    out["anchor"] = {{"lat", a.anchor->at.lat},
                     {"lon", a.anchor->at.lon},
                     {"heading_deg", a.anchor->heading_deg},
                     {"accuracy_m", a.anchor->accuracy_m},
                     {"heading_accuracy_deg", a.anchor->heading_accuracy_deg}};
  }
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Kept> about_from(std::string_view text) {
  if (text.size() > kLargestAbout) return base::fail(Code::TooLarge, "too large");
  const Json json = Json::parse(text.begin(), text.end(), nullptr, false);
  if (!json.is_object()) return base::fail(Code::Malformed, "is no JSON object");
  Reader reader(json);
  Kept out;
  About& a = out.about;
  a.name = reader.text("name");
  a.created = base::WallTime(
      std::chrono::milliseconds(reader.whole("created_ms", -kLatest_ms, kLatest_ms)));
  a.revision = reader.whole("revision", 1.0, kMostCount);
  read_image(reader, out.image);
  read_mode(reader, out.mode);
  a.shape.columns = static_cast<std::int32_t>(reader.whole("columns", 1.0, kMostCount));
  a.shape.rows = static_cast<std::int32_t>(reader.whole("rows", 1.0, kMostCount));
  a.shape.resolution_m =
      reader.number("resolution_m", nav::chart::kFinest_m, nav::chart::kCoarsest_m);
  a.shape.origin = {reader.number("x_m", -1e6, 1e6), reader.number("y_m", -1e6, 1e6),
                    reader.number("yaw_rad", -1e6, 1e6)};
  read_anchor(reader, a.anchor);
  read_forbidden(reader, a.forbidden);
  if (!reader.wrong().empty()) {
    return base::fail(Code::Invalid, reader.wrong() + " is missing or cannot be",
                      {{"/" + reader.wrong(), "is missing or cannot be"}});
  }
  return out;
}

}  // namespace roverd::maps
