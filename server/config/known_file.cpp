// The file of the places that people entered.

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/angle.hpp"
#include "config/known_places.hpp"
#include "config/learned.hpp"

namespace roverd {
namespace {

using KnownJson = nlohmann::ordered_json;

constexpr std::size_t kLongestKnownFile = 200'000;

/// In its range, or empty.
std::optional<double> within(const KnownJson& from, const char* name, double least, double most) {
  const auto at = from.find(name);
  if (at == from.end() || !at->is_number()) return std::nullopt;
  const double value = at->get<double>();
  return value >= least && value <= most ? std::optional(value) : std::nullopt;
}

std::optional<base::KnownPlace> one_from(const KnownJson& from) {
  if (!from.is_object() || !from.contains("name") || !from["name"].is_string()) return {};
  base::KnownPlace out;
  out.name = from["name"].get<std::string>();
  const auto lat = within(from, "lat", -90.0, 90.0);
  const auto lon = within(from, "lon", -180.0, 180.0);
  const auto sigma_m = within(from, "accuracy_m", 0.01, 2.0);
  const auto sigma_deg = within(from, "heading_accuracy_deg", 0.2, 45.0);
  if (out.name.empty() || out.name.size() > 24 || !lat || !lon || !sigma_m || !sigma_deg) return {};
  out.at = {*lat, *lon};
  out.sigma_m = *sigma_m;
  out.yaw_sigma_rad = base::rad_from_deg(*sigma_deg);
  if (const auto tag = within(from, "tag", 0.0, 586.0)) out.tag = static_cast<int>(*tag);
  if (const auto deg = within(from, "heading_deg", 0.0, 360.0)) {
    out.yaw_rad = base::yaw_from_heading(*deg);
  }
  return out;
}

}  // namespace

std::string known_places_text(const std::vector<base::KnownPlace>& places) {
  KnownJson list = KnownJson::array();
  for (const base::KnownPlace& p : places) {
    KnownJson one{{"name", p.name}, {"lat", p.at.lat}, {"lon", p.at.lon}};
    if (p.tag) one["tag"] = *p.tag;
    if (p.yaw_rad) one["heading_deg"] = base::heading_from_yaw(*p.yaw_rad);
    one["accuracy_m"] = p.sigma_m;
    one["heading_accuracy_deg"] = base::deg_from_rad(p.yaw_sigma_rad);
    list.push_back(std::move(one));
  }
  return KnownJson{{"known_places", std::move(list)}}.dump(1) + "\n";
}

base::Result<std::vector<base::KnownPlace>> known_places_from(std::string_view text) {
  const KnownJson json = KnownJson::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("known_places") || !json["known_places"].is_array()) {
    return base::fail(base::Code::Malformed, "it holds no list known_places");
  }
  std::vector<base::KnownPlace> out;
  for (const KnownJson& one : json["known_places"]) {
    auto place = one_from(one);
    if (!place || out.size() == base::kMostKnownPlaces) {
      return base::fail(base::Code::Invalid,
                        "known_places/" + std::to_string(out.size()) + " cannot be");
    }
    out.push_back(std::move(*place));
  }
  return out;
}

base::Result<std::vector<base::KnownPlace>> read_known_places(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    if (errno == ENOENT) return std::vector<base::KnownPlace>{};
    return base::fail(base::Code::Unavailable, std::strerror(errno));
  }
  std::string text(kLongestKnownFile, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
  return known_places_from(text);
}

base::Result<void> write_known_places(const std::filesystem::path& file,
                                      const std::vector<base::KnownPlace>& places) {
  return replace_file(file, known_places_text(places));
}

}  // namespace roverd
