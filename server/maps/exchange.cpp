#include "maps/exchange.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "atlas/map_files.hpp"
#include "maps/comments.hpp"
#include "maps/edit.hpp"
#include "maps/solid.hpp"
#include "maps/words.hpp"

namespace roverd::maps {

namespace {

using base::Error;
using base::Result;
using nav::chart::OccupancyMap;

/// Of a form's part: "/yaml/origin" for its "/origin", "/image/byte 3" for its "byte 3".
tl::unexpected<Error> of_part(const std::string& part, Error error) {
  error.code = base::Code::Invalid;
  error.detail = part + ": " + error.detail;
  for (base::FieldError& field : error.fields) {
    field.pointer = (field.pointer.starts_with('/') ? part : part + "/") + field.pointer;
  }
  if (error.fields.empty()) error.fields.push_back({part, error.detail});
  return tl::unexpected<Error>(std::move(error));
}

std::string text_of(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

}  // namespace

Result<Upload> read_upload(std::string_view yaml, std::string_view picture) {
  auto words = atlas::read_words(yaml);
  if (!words) return of_part("/yaml", words.error());
  const auto read =
      atlas::read_pgm({reinterpret_cast<const std::uint8_t*>(picture.data()), picture.size()});
  if (!read) return of_part("/image", read.error());
  auto map = atlas::map_of(*words, *read);
  if (!map) return of_part("/yaml", map.error());
  if (std::max(map->columns(), map->rows()) > kLongestSide) {
    return of_part("/image", {base::Code::Invalid,
                              "has " + std::to_string(std::max(map->columns(), map->rows())) +
                                  " cells along a side; at most " + std::to_string(kLongestSide),
                              {}});
  }
  Comments said = read_comments(yaml);
  Upload out{std::move(*map), std::move(words->others), {}, std::move(said.name), said.anchor};
  for (std::string& name : said.wrong) out.passed_over.push_back(std::move(name));
  return out;
}

Result<nav::cells::ReadMap> read_cloud(std::string_view pcd) {
  auto read =
      nav::cells::read_whole_map({reinterpret_cast<const std::uint8_t*>(pcd.data()), pcd.size()},
                                 kSolidCell_m, kMostSentCells);
  if (!read) return of_part("/cloud", read.error());
  return read;
}

Result<Upload> solid_upload(nav::cells::ReadMap read) {
  auto plane = plane_of(read.map);
  if (!plane) return of_part("/cloud", plane.error());
  return Upload{
      std::move(*plane), nav::cells::left_out(read), nav::cells::write_map(read.map), {}, {}};
}

std::string exported_yaml(const OccupancyMap& map, const About& about, const std::string& image) {
  atlas::MapWords words = words_for(map);
  words.image = image;
  return comments_of(about) + atlas::write_words(words);
}

Result<std::string> exported_pgm(OccupancyMap map, const std::vector<Area>& forbidden) {
  const atlas::MapWords words = words_for(map);
  const auto picture = atlas::picture_of(with_forbidden(std::move(map), forbidden), words);
  if (!picture) return tl::unexpected<Error>(picture.error());
  return text_of(atlas::write_pgm(*picture));
}

Shown shown(const OccupancyMap& map, const std::vector<Area>& forbidden, std::size_t most) {
  const Thinned thin = thinned(map, forbidden, most);
  return {text_of(atlas::write_pgm(thin.picture)), thin.factor};
}

}  // namespace roverd::maps
