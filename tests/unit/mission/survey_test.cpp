// Surveys judged by a raster of their own: what is covered, and that no metre leaves the field.

#include "mission/survey/survey.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "base/tangent_plane.hpp"
#include "field_raster.hpp"
#include "mission/json/json.hpp"

namespace roverd::mission {
namespace {

constexpr LatLon kSurveyField{58.378, 26.729};

std::vector<Outline> rectangle(double width, double height) {
  return {{{0, 0}, {width, 0}, {width, height}, {0, height}}};
}
//  ┌─┐
//  │ └──┐
//  └────┘
std::vector<Outline> ell() {
  return {{{0, 0}, {60, 0}, {60, 25}, {22, 25}, {22, 55}, {0, 55}}};
}
std::vector<Outline> you() {
  return {{{0, 0}, {60, 0}, {60, 50}, {42, 50}, {42, 18}, {18, 18}, {18, 50}, {0, 50}}};
}
//  │ │ │ │
//  └─┴─┴─┘
std::vector<Outline> comb() {
  Outline o{{0, 0}, {80, 0}};
  for (int tooth = 4; tooth >= 0; --tooth) {
    const double x = tooth * 17.0;
    o.push_back({x + 12, 40});
    o.push_back({x, 40.0 - tooth});
    if (tooth > 0) {
      o.push_back({x, 12});
      o.push_back({x - 5, 12});
    }
  }
  return {o};
}
std::vector<Outline> star(int tips, double inner, double outer) {
  Outline o;
  for (int i = 0; i < 2 * tips; ++i) {
    const double r = i % 2 == 0 ? outer : inner;
    const double a = std::numbers::pi * i / tips + 0.1;
    o.push_back({40 + r * std::cos(a), 40 + r * std::sin(a)});
  }
  return {o};
}
Outline round_hole(double x, double y, double r, int points = 24) {
  Outline o;
  for (int i = 0; i < points; ++i) {
    const double a = 2.0 * std::numbers::pi * i / points;
    o.push_back({x + r * std::cos(a), y + r * std::sin(a)});
  }
  return o;
}
std::vector<Outline> holes() {
  auto field = rectangle(70, 60);
  field.push_back(round_hole(20, 20, 6));
  field.push_back({{40, 30}, {58, 32}, {50, 45}});
  field.push_back({{30, 44}, {33, 44}, {33, 54}, {30, 54}});
  return field;
}
/// A circle whose radius swings, by many smooth waves.
std::vector<Outline> wavy(int points, double radius, double depth) {
  Outline o;
  for (int i = 0; i < points; ++i) {
    const double a = 2.0 * std::numbers::pi * i / points;
    const double wave = std::sin(5 * a) + 0.6 * std::sin(13 * a + 1) + 0.4 * std::sin(31 * a + 2);
    const double r = radius + depth * (wave / 2.0 - 1.0);
    o.push_back({radius + r * std::cos(a), radius + r * std::sin(a)});
  }
  return {o};
}
/// Vertices that run out and in along a circle.
std::vector<Outline> jagged(int points, double radius, double depth, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> off(-depth, 0.0);
  Outline o;
  for (int i = 0; i < points; ++i) {
    const double a = 2.0 * std::numbers::pi * i / points;
    const double r = radius + off(random);
    o.push_back({radius + r * std::cos(a), radius + r * std::sin(a)});
  }
  return {o};
}

/// Metres are those of a plane at kSurveyField; the planner has its own at the field's middle.
struct Ground {
  base::TangentPlane plane{kSurveyField};

  SurveyRequest request(const std::vector<Outline>& field, double spacing_m) const {
    SurveyRequest r;
    r.spacing_m = spacing_m;
    for (const Outline& o : field) {
      auto& ring = r.rings.emplace_back();
      for (const Spot& p : o) ring.push_back(plane.to_global({p.x_m, p.y_m}));
    }
    return r;
  }
  std::vector<Spot> path(const Survey& survey) const {
    std::vector<Spot> out;
    for (const Item& item : survey.items) {
      const auto p = plane.to_local(std::get<Waypoint>(item).at);
      out.push_back({p.east_m, p.north_m});
    }
    return out;
  }
};

struct Shape {
  const char* name;
  std::vector<Outline> field;
};
std::vector<Shape> shapes() {
  return {{"rectangle", rectangle(60, 40)},
          {"L", ell()},
          {"U", you()},
          {"comb", comb()},
          {"star", star(5, 16, 40)},
          {"holes", holes()},
          {"jagged", jagged(300, 35, 8, 1)}};
}

class Coverage : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Survey, Coverage, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return std::string(shape.param.name); });

TEST_P(Coverage, IsWholeInEveryDirectionAndNeverLeavesTheField) {
  const Ground ground;
  const double spacing = 2.0;
  const FieldRaster raster(GetParam().field, spacing / 12.0);
  std::vector<std::optional<double>> directions{std::nullopt};
  for (double deg = 0.0; deg < 180.0; deg += 22.5) directions.emplace_back(deg);
  for (const auto& direction : directions) {
    auto request = ground.request(GetParam().field, spacing);
    request.direction_deg = direction;
    const auto survey = plan_survey(request);
    ASSERT_TRUE(survey) << survey.error().detail;
    const auto path = ground.path(*survey);
    EXPECT_GE(raster.covered_share(path, spacing / 2, spacing / 2), 0.995)
        << direction.value_or(-1);
    // Half a spacing, but for the chords of round corners.
    EXPECT_GT(raster.clearance_m(path), spacing / 2 - 0.1) << direction.value_or(-1);
    EXPECT_NEAR(survey->covered_share, survey->reachable_share, 0.005);
    EXPECT_EQ(survey->tight_turns, 0);
    Plan plan;
    plan.name = "x";
    plan.items = survey->items;
    EXPECT_TRUE(check_plan(plan));
    EXPECT_NEAR(survey->length_m, length_m(plan), 0.01 + 1e-6 * survey->length_m);
  }
}

TEST_P(Coverage, IsWholeWithMoreHeadlandAndAsASpiral) {
  const Ground ground;
  const double spacing = 1.5;
  const FieldRaster raster(GetParam().field, spacing / 12.0);
  auto request = ground.request(GetParam().field, spacing);
  request.headland_passes = 3;
  for (const auto pattern : {SurveyPattern::Tracks, SurveyPattern::Spiral}) {
    request.pattern = pattern;
    const auto survey = plan_survey(request);
    ASSERT_TRUE(survey) << survey.error().detail;
    const auto path = ground.path(*survey);
    EXPECT_GE(raster.covered_share(path, spacing / 2, spacing / 2), 0.995);
    EXPECT_GT(raster.clearance_m(path), spacing / 2 - 0.1);
  }
}

TEST_P(Coverage, ByArcsKeepsTheRadiusWhereThereIsRoom) {
  const Ground ground;
  auto request = ground.request(GetParam().field, 2.0);
  request.turn = SurveyTurn::Arc;
  request.radius_m = 1.5;
  request.headland_passes = 3;
  request.skip = 1;
  const auto survey = plan_survey(request);
  ASSERT_TRUE(survey) << survey.error().detail;
  const auto path = ground.path(*survey);
  const FieldRaster raster(GetParam().field, 2.0 / 12.0);
  EXPECT_GT(raster.clearance_m(path), 0.9);
  // What the radius cannot reach in sharp corners stays open.
  EXPECT_GE(raster.covered_share(path, 1.0, 1.0), 0.93);
  // A corner of chords with the radius r turns by at most chord / r.
  int sharp = 0;
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const auto& before = std::get<Waypoint>(survey->items[i]);
    const auto& after = std::get<Waypoint>(survey->items[i + 1]);
    const double ax = path[i].x_m - path[i - 1].x_m;
    const double ay = path[i].y_m - path[i - 1].y_m;
    const double bx = path[i + 1].x_m - path[i].x_m;
    const double by = path[i + 1].y_m - path[i].y_m;
    double turn = std::abs(std::atan2(ax * by - ay * bx, ax * bx + ay * by));
    if (before.reverse != after.reverse) turn = std::numbers::pi - turn;
    // Long lines beside an arc are none of its chords.
    const double most = 0.7 * 1.5;
    const double chord =
        0.5 * (std::min(most, std::hypot(ax, ay)) + std::min(most, std::hypot(bx, by)));
    if (turn > 1.3 * chord / 1.5 + 0.05) ++sharp;
  }
  EXPECT_NEAR(sharp, survey->tight_turns, 1);
  EXPECT_EQ(survey->tight_turns > 0, !survey->notes.empty());
  RecordProperty("tight_turns", survey->tight_turns);
  if (GetParam().name == std::string("rectangle")) {
    EXPECT_LE(sharp, 2);
  }
}

//  │ ▲ │   tracks end half a spacing from the edge: a radius of 2 m has no room ahead
//  └─┴─┘
TEST(Survey, WithoutRoomAheadAVehicleWithARadiusShuntsInsideTheField) {
  const Ground ground;
  auto request = ground.request(rectangle(30, 24), 1.5);
  request.turn = SurveyTurn::Arc;
  request.radius_m = 2.0;
  for (const int passes : {0, 1}) {
    request.headland_passes = passes;
    const auto survey = plan_survey(request);
    ASSERT_TRUE(survey) << survey.error().detail;
    EXPECT_EQ(survey->tight_turns, 0);
    const auto backwards = [](const Item& item) { return std::get<Waypoint>(item).reverse; };
    EXPECT_TRUE(std::ranges::any_of(survey->items, backwards));
    const FieldRaster raster(rectangle(30, 24), 1.5 / 12.0);
    const auto path = ground.path(*survey);
    EXPECT_GT(raster.clearance_m(path), 0.75 - 0.1);
    EXPECT_GE(raster.covered_share(path, 0.75, 0.75), 0.98);
  }
}

//  ┌─────────┐
//  │ ═══════ │   20 m by 10 m with 2 m: ring, 8 m inside of it, 4 tracks
//  └─────────┘
TEST(Survey, OfARectangleIsARingAndItsTracks) {
  const Ground ground;
  auto request = ground.request(rectangle(20, 10), 2.0);
  const auto survey = plan_survey(request);
  ASSERT_TRUE(survey);
  EXPECT_NEAR(survey->direction_deg, 90.0, 0.1);
  EXPECT_EQ(survey->tracks, 3);
  EXPECT_EQ(survey->cells, 1);
  EXPECT_EQ(survey->items.size(), 5u + 6u);
  EXPECT_NEAR(survey->field_m2, 200.0, 0.01);
  EXPECT_NEAR(survey->covered_share, 1.0, 0.01);
  // It begins at the south-west corner, 1 m inside,
  EXPECT_NEAR(ground.path(*survey).front().x_m, 1.0, 0.01);
  EXPECT_NEAR(ground.path(*survey).front().y_m, 1.0, 0.01);
  // or where it is told.
  request.start = FieldCorner::NorthEast;
  EXPECT_NEAR(ground.path(*plan_survey(request)).front().x_m, 19.0, 0.01);
  request.start = ground.plane.to_global({-5.0, 30.0});
  EXPECT_NEAR(ground.path(*plan_survey(request)).front().y_m, 9.0, 0.01);
  // 56 m ring, 3 × 16 m, and ways between.
  EXPECT_NEAR(survey->length_m, 52.0 + 48.0 + 4.0, 4.0);
  EXPECT_GT(survey->time_s, survey->length_m / 0.8);
}

TEST(Survey, WithoutHeadlandTracksEndAtTheBorder) {
  const Ground ground;
  auto request = ground.request(rectangle(20, 10), 2.0);
  request.headland_passes = 0;
  const auto survey = plan_survey(request);
  ASSERT_TRUE(survey);
  EXPECT_EQ(survey->tracks, 5);
  EXPECT_EQ(survey->items.size(), 10u);
  EXPECT_GT(FieldRaster(rectangle(20, 10), 0.1).clearance_m(ground.path(*survey)), 0.98);
  EXPECT_GT(survey->covered_share, 0.95);
  // A longer track stays inside all the same,
  request.overshoot_m = 5.0;
  EXPECT_GT(FieldRaster(rectangle(20, 10), 0.1).clearance_m(ground.path(*plan_survey(request))),
            0.9);
  // unless the border is nearer.
  request.border_m = 0.0;
  request.overshoot_m = 0.0;
  EXPECT_LT(FieldRaster(rectangle(20, 10), 0.1).clearance_m(ground.path(*plan_survey(request))),
            0.01);
}

TEST(Survey, WhatLiesBehindANeckIsLeftOutAndSaid) {
  const Ground ground;
  // Two rooms of 20 m with a passage of 1 m between them.
  const std::vector<Outline> rooms{{{0, 0},
                                    {20, 0},
                                    {20, 9.5},
                                    {30, 9.5},
                                    {30, 0},
                                    {45, 0},
                                    {45, 20},
                                    {30, 20},
                                    {30, 10.5},
                                    {20, 10.5},
                                    {20, 20},
                                    {0, 20}}};
  auto request = ground.request(rooms, 2.0);
  const auto survey = plan_survey(request);
  ASSERT_TRUE(survey);
  EXPECT_NEAR(survey->reachable_share, 400.0 / 710.0, 0.01);
  ASSERT_EQ(survey->notes.size(), 1u);
  EXPECT_NE(survey->notes[0].find("1 more parts of together 234 m²"), std::string::npos)
      << survey->notes[0];
  for (const Spot& p : ground.path(*survey)) EXPECT_LT(p.x_m, 20.0);
  // From the other room that one is covered; with a smaller border both are.
  request.start = ground.plane.to_global({40.0, 10.0});
  for (const Spot& p : ground.path(*plan_survey(request))) EXPECT_GT(p.x_m, 30.0);
  request.border_m = 0.4;
  EXPECT_GT(plan_survey(request)->covered_share, 0.97);
}

TEST(Survey, PerimeterIsRingsAlone) {
  const Ground ground;
  auto request = ground.request(holes(), 2.0);
  request.pattern = SurveyPattern::Perimeter;
  request.headland_passes = 2;
  const auto survey = plan_survey(request);
  ASSERT_TRUE(survey);
  EXPECT_EQ(survey->tracks, 0);
  EXPECT_LT(survey->covered_share, 0.6);
  EXPECT_GT(survey->covered_share, 0.2);
}

TEST(Survey, OfFiveKilometresAndOfTenThousandCornersComesInBoundedTime) {
  const Ground ground;
  auto large = ground.request(jagged(10'000, 2500, 150, 3), 20.0);
  const auto survey = plan_survey(large);
  ASSERT_TRUE(survey) << survey.error().detail;
  EXPECT_GT(survey->covered_share, 0.97 * survey->reachable_share);
  const auto path = ground.path(*survey);
  double least = 1e9;
  for (const Spot& p : path)
    least = std::min(least, 2500.0 - std::hypot(p.x_m - 2500, p.y_m - 2500));
  EXPECT_GT(least, 9.0);
  // The same in small.
  const auto small = wavy(10'000, 60, 6);
  const auto fine = plan_survey(ground.request(small, 1.0));
  ASSERT_TRUE(fine) << fine.error().detail;
  const FieldRaster raster(small, 0.1);
  EXPECT_GE(raster.covered_share(ground.path(*fine), 0.5, 0.5), 0.995);
  EXPECT_LT(fine->items.size(), 1500u);  // rings are drawn with as few corners as do
  // And the smallest: one metre.
  const auto tiny = plan_survey(ground.request(rectangle(1, 1), 0.2));
  ASSERT_TRUE(tiny);
  EXPECT_GT(tiny->covered_share, 0.98);
  // A field that needs too many items says so.
  const auto many = plan_survey(ground.request(rectangle(5000, 5000), 0.05));
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().fields[0].pointer, "/spacing_m");
}

TEST(Survey, OrderPassesOverTracksAndComesBackForThem) {
  const Ground ground;
  for (const int skip : {0, 1, 2, 3, 7}) {
    auto request = ground.request(rectangle(60, 60), 1.0);
    request.skip = skip;
    request.direction_deg = 90.0;
    const auto survey = plan_survey(request);
    ASSERT_TRUE(survey);
    EXPECT_NEAR(survey->covered_share, 1.0, 0.01);
    const auto path = ground.path(*survey);
    int narrow = 0;
    for (std::size_t i = 6; i + 1 < path.size(); ++i) {
      const double step = std::abs(path[i + 1].y_m - path[i].y_m);
      if (std::abs(path[i + 1].x_m - path[i].x_m) < 1.0 && step < skip + 0.9) ++narrow;
    }
    EXPECT_LE(narrow, 2 * skip + 1) << skip;
  }
}

std::string survey_refusal(const SurveyRequest& request) {
  const auto survey = plan_survey(request);
  if (survey) return "none";
  EXPECT_EQ(survey.error().code, base::Code::Invalid);
  return survey.error().fields.empty() ? "no field" : survey.error().fields[0].pointer;
}

TEST(Survey, RefusesWhatIsNoField) {
  const Ground ground;
  const double nan = std::nan("");
  const auto with = [&](std::vector<Outline> field) { return ground.request(field, 1.0); };
  EXPECT_EQ(survey_refusal(with({})), "/polygon");
  EXPECT_EQ(survey_refusal(with({{}})), "/polygon");
  EXPECT_EQ(survey_refusal(with({{{0, 0}, {10, 0}}})), "/polygon/0");
  EXPECT_EQ(survey_refusal(with({{{0, 0}, {10, 0}, {10, 0}, {0, 0}}})), "/polygon/0");
  // A bow tie: the second edge meets the fourth.
  EXPECT_EQ(survey_refusal(with({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}})).substr(0, 11),
            "/polygon/0/");
  EXPECT_EQ(survey_refusal(with({{{0, 0}, {10, 0}, {20, 0}}})).substr(0, 10), "/polygon/0");
  auto outside = rectangle(20, 20);
  outside.push_back({{30, 30}, {35, 30}, {35, 35}});
  EXPECT_EQ(survey_refusal(with(outside)), "/polygon/1");
  auto nested = rectangle(20, 20);
  nested.push_back({{2, 2}, {18, 2}, {18, 18}, {2, 18}});
  nested.push_back({{5, 5}, {8, 5}, {8, 8}});
  EXPECT_EQ(survey_refusal(with(nested)), "/polygon/2");
  auto across = rectangle(20, 20);
  across.push_back({{15, 5}, {25, 5}, {25, 8}});
  EXPECT_NE(survey_refusal(with(across)), "none");
  auto wrong = with(rectangle(20, 20));
  wrong.rings[0][2].lat = nan;
  EXPECT_EQ(survey_refusal(wrong), "/polygon/0/2");
  wrong.rings[0][2].lat = 59.0;
  EXPECT_EQ(survey_refusal(wrong), "/polygon/0/0");
  wrong.rings[0].assign(kMaxFieldPoints + 1, kSurveyField);
  EXPECT_EQ(survey_refusal(wrong), "/polygon");
}

TEST(Survey, RefusesNumbersOutOfTheirRange) {
  const Ground ground;
  const auto with = [&](auto change) {
    auto request = ground.request(rectangle(20, 20), 2.0);
    change(request);
    return survey_refusal(request);
  };
  EXPECT_EQ(with([](auto& r) { r.spacing_m = 0.0; }), "/spacing_m");
  EXPECT_EQ(with([](auto& r) { r.spacing_m = std::nan(""); }), "/spacing_m");
  EXPECT_EQ(with([](auto& r) { r.spacing_m = 25.0; }), "/spacing_m");
  EXPECT_EQ(with([](auto& r) { r.border_m = 11.0; }), "/border_m");
  EXPECT_EQ(with([](auto& r) { r.border_m = -1.0; }), "/border_m");
  EXPECT_EQ(with([](auto& r) { r.headland_passes = -1; }), "/headland_passes");
  EXPECT_EQ(with([](auto& r) { r.overshoot_m = 1e308; }), "/overshoot_m");
  EXPECT_EQ(with([](auto& r) { r.skip = 51; }), "/skip");
  EXPECT_EQ(with([](auto& r) { r.direction_deg = std::nan(""); }), "/direction_deg");
  EXPECT_EQ(with([](auto& r) { r.turn = SurveyTurn::Arc; }), "/radius_m");
  EXPECT_EQ(with([](auto& r) { r.start = LatLon{91.0, 0.0}; }), "/start");
}

/// Fields that nobody drew: whatever comes, it is refused or it is covered from inside.
TEST(Survey, OfRandomFieldsStaysInsideAndCoversThem) {
  const Ground ground;
  for (unsigned seed = 1; seed <= 25; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.25, 1.0);
    Outline o;
    const int corners = 5 + static_cast<int>(seed % 12);
    for (int i = 0; i < corners; ++i) {
      const double a = 2.0 * std::numbers::pi * i / corners;
      const double r = 35.0 * share(random);
      o.push_back({35 + r * std::cos(a), 35 + r * std::sin(a)});
    }
    std::vector<Outline> field{o};
    if (seed % 3 == 0) field.push_back(round_hole(35, 35, 3.0 + seed % 4, 9));
    auto request = ground.request(field, 1.2);
    request.direction_deg = static_cast<double>(seed * 37 % 180);
    request.headland_passes = 1 + static_cast<int>(seed % 3);
    const auto survey = plan_survey(request);
    if (!survey) {
      EXPECT_EQ(survey.error().code, base::Code::Invalid);
      continue;
    }
    const FieldRaster raster(field, 0.1);
    const auto path = ground.path(*survey);
    EXPECT_GT(raster.clearance_m(path), 0.5) << seed;
    EXPECT_NEAR(survey->covered_share, survey->reachable_share, 0.005) << seed;
    if (survey->notes.empty()) {
      EXPECT_GE(raster.covered_share(path, 0.6, 0.6), 0.995) << seed;
    }
  }
}

}  // namespace
}  // namespace roverd::mission
