// about.json of a kept map, the comments of an exported one, and what people ask of maps: forms and
// changes. Whatever the bytes, no crash; what is read is written as it was, and keeps within its
// bounds.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "api/map_request.hpp"
#include "maps/about_file.hpp"
#include "maps/comments.hpp"
#include "maps/edit.hpp"
#include "mission/json/json.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

void about(std::string_view text) {
  const auto read = maps::about_from(text);
  if (!read) return;
  const std::string written = maps::about_text(*read);
  const auto again = maps::about_from(written);
  check(again.has_value());
  check(maps::about_text(*again) == written);
  check(read->image.find('/') == std::string::npos && read->image.front() != '.');
}

void comments(std::string_view text) {
  const auto read = maps::read_comments(text);
  check(read.wrong.size() <= 5 && (read.wrong.empty() || !read.anchor));
  check(read.name.find('\n') == std::string::npos);
  if (!read.anchor) return;
  check(read.anchor->at.lat >= -90.0 && read.anchor->at.lat <= 90.0);
  maps::About about;
  about.name = read.name;
  about.anchor = read.anchor;
  const auto again = maps::read_comments(maps::comments_of(about));
  check(again.name == read.name && again.anchor.has_value());
  check(again.anchor->at.lon == read.anchor->at.lon);
  check(again.anchor->heading_deg == read.anchor->heading_deg);
}

void change(std::string_view text) {
  const auto json = mission::parse_json(text);
  if (!json || !json->is_object()) return;
  const auto read = api::read_map_change(*json);
  if (!read) return check(!read.error().fields.empty());
  auto map = *nav::chart::OccupancyMap::make({17, 9, 0.5, {-4.0, 1.0, 0.3}}, 0);
  for (const maps::Edit& e : read->edits) maps::edit(map, e);
  for (const auto cell : map.cells()) {
    check(cell == nav::chart::kFree || cell == nav::chart::kOccupied);
  }
  (void)maps::thinned(map, read->forbidden.value_or(std::vector<maps::Area>()), 10);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  about(text);
  comments(text);
  change(text);
  (void)api::read_map_form(std::string(text), "multipart/form-data; boundary=x");
  return 0;
}
