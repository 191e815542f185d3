// 100,000 items there and back, in every format: what our own programs write they read.

#include <algorithm>
#include <chrono>
#include <random>

#include <gtest/gtest.h>

#include "files.hpp"
#include "mission/formats/formats.hpp"

namespace roverd::mission {
namespace {

/// A drunken walk of 1 to 20 m a step, no place twice in a row, with what waypoints can have.
Plan long_plan(int items) {
  std::mt19937 random(20'260'301);
  std::uniform_real_distribution<double> step(1e-5, 1e-4);
  std::bernoulli_distribution coin;
  Plan plan;
  plan.name = "long";
  LatLon at{58.378, 26.729};
  for (int i = 0; i < items; ++i) {
    at.lat += coin(random) ? step(random) : -step(random);
    at.lon += coin(random) ? step(random) : -step(random);
    Waypoint waypoint;
    waypoint.at = at;
    if (coin(random)) waypoint.alt_m = 61.25;
    if (coin(random)) waypoint.speed_mps = 0.75;
    plan.items.emplace_back(waypoint);
  }
  return plan;
}

TEST(ManyItems, ComeBackInEveryFormat) {
  constexpr int kItems = 100'000;
  const Plan plan = long_plan(kItems);
  const auto places = positions(plan);
  for (const Format format : kFormats) {
    if (!is_written(format)) continue;
    SCOPED_TRACE(to_string(format));
    const ExportedFile out = export_file(plan, format);
    EXPECT_LE(out.content.size(), 64u << 20u);
    const auto file = import_file(out.content, std::nullopt, out.file_name);
    ASSERT_TRUE(file) << file.error().detail;
    EXPECT_TRUE(file->more.empty());
    const auto back = positions(file->plan);
    ASSERT_EQ(back.size(), places.size());
    double most_deg = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      most_deg = std::max(
          {most_deg, std::abs(back[i].lat - places[i].lat), std::abs(back[i].lon - places[i].lon)});
    }
    EXPECT_LT(most_deg, 1e-9);
    if (format == Format::GeoJson) {
      EXPECT_EQ(file->plan.items, plan.items);
    }
  }
}

TEST(ManyItems, OfAMapAreWrittenInATimeThatGrowsAsTheyDo) {
  // Given: so many points of a map that to look through all rows for each takes half a minute.
  constexpr int kItems = 200'000;
  Plan plan;
  plan.name = "shed";
  plan.frame = MissionMap{"shed", base::MapLies{{58.0, 26.0}, 0.0}};
  for (int i = 0; i < kItems; ++i) {
    plan.items.emplace_back(MapPoint{.x_m = i * 0.01, .hold_s = 2.0});
  }
  // When
  const auto begin = std::chrono::steady_clock::now();
  const auto file = export_file(plan, Format::Csv);
  const std::chrono::duration<double> took_s = std::chrono::steady_clock::now() - begin;
  // Then
  EXPECT_EQ(std::ranges::count(file.rows, std::string("map_point"), &FileRow::what), kItems);
  EXPECT_LT(took_s.count(), 15.0);
}

}  // namespace
}  // namespace roverd::mission
