#pragma once
// Small files for the tests of the file formats, and shortcuts to what became of them.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mission/formats/formats.hpp"

namespace roverd::mission {

/// A .waypoints file with home and these rows (blank-separated, without their number).
inline std::string file_of(const std::vector<std::string>& rows) {
  std::string text = "QGC WPL 110\n0 1 0 16 0 0 0 0 58.378 26.7289 61.5 1\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += std::to_string(i + 1) + " 0 " + rows[i] + "\n";
  }
  return text;
}

inline ImportedFile imported(const std::string& text, std::string_view name = "a.waypoints") {
  auto file = import_file(text, std::nullopt, name);
  EXPECT_TRUE(file) << file.error().detail;
  return file ? std::move(*file) : ImportedFile{};
}

/// What became of row `number` (from 1) of file_of.
inline const FileRow& row(const ImportedFile& file, std::size_t number) {
  return file.rows.at(number);  // home comes first
}

inline std::vector<LatLon> positions(const Plan& plan) {
  std::vector<LatLon> out;
  for (const Item& item : plan.items) {
    if (const auto* waypoint = std::get_if<Waypoint>(&item)) out.push_back(waypoint->at);
  }
  return out;
}

inline base::Error refused(const std::string& text,
                           std::optional<Format> format = Format::Waypoints) {
  const auto file = import_file(text, format, "");
  EXPECT_FALSE(file) << text;
  return file ? base::Error{} : file.error();
}

}  // namespace roverd::mission
