// Operations on a mission of 100,000 items (limit: 50 ms each), what changed between two of them,
// files of 100,000 points read (limit: 1 s each), surveys, and ways through a map of nodes.

#include <cmath>
#include <stdexcept>
#include <string>

#include <benchmark/benchmark.h>

#include "mission/edit/compare.hpp"
#include "mission/edit/operations.hpp"
#include "mission/formats/formats.hpp"
#include "mission/graph/route_graph.hpp"
#include "mission/survey/survey.hpp"

namespace {

using namespace roverd::mission;

constexpr int kItems = 100'000;

/// A wavy way of one point each 5 cm, 5 km long. (No lambda: GCC would make it at compile time.)
Plan made_way() {
  Plan made;
  made.name = "long way";
  for (int i = 0; i < kItems; ++i) {
    Waypoint waypoint;
    waypoint.at = {58.378 + 4.5e-7 * i, 26.729 + 2e-5 * std::sin(i * 0.01)};
    if (i % 1000 == 0) waypoint.hold_s = 1.0;
    made.items.emplace_back(waypoint);
  }
  return made;
}

const Plan& long_way() {
  static const Plan plan = made_way();
  return plan;
}

void Operate(benchmark::State& state, const Operation& operation) {
  for (auto _ : state) {
    state.PauseTiming();
    Plan plan = long_way();
    state.ResumeTiming();
    auto done = perform(std::move(plan), operation);
    if (!done) throw std::runtime_error(done.error().detail);
    benchmark::DoNotOptimize(done->plan.items.size());
    state.PauseTiming();
    done = {};
    state.ResumeTiming();
  }
}
BENCHMARK_CAPTURE(Operate, AddWaypoint, AddWaypoint{Waypoint{}, 1})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, RemoveItems, RemoveItems{Numbers{2, 9}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Reverse, Reverse{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Offset, Offset{{3.0, 4.0}, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, OffsetRange, Offset{{3.0, 4.0}, Numbers{2, kItems - 1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Rotate, ScaleRotate{1.0, 30.0, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Scale, ScaleRotate{1.1, 0.0, Centroid{}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Align, Align{{1, {58.3781, 26.729}}, Anchor{kItems, {58.4231, 26.7295}}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Clear, Clear{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, SetHome, SetHome{Home{{58.378, 26.729}, {}}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Mirror, Mirror{30.0, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Simplify, Simplify{0.1, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Densify, Densify{0.04, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Renumber, Renumber{{1, 10}, 500})->Unit(benchmark::kMillisecond);

void OperateSplit(benchmark::State& state) {
  for (auto _ : state) {
    state.PauseTiming();
    Plan plan = long_way();
    state.ResumeTiming();
    benchmark::DoNotOptimize(split(std::move(plan), kItems / 2).value().rest.items.size());
  }
}
BENCHMARK(OperateSplit)->Unit(benchmark::kMillisecond);

void OperateJoin(benchmark::State& state) {
  const auto parts = split(long_way(), kItems / 2).value();
  for (auto _ : state) {
    state.PauseTiming();
    Plan plan = parts.first;
    Join join{parts.rest};
    state.ResumeTiming();
    benchmark::DoNotOptimize(perform(std::move(plan), std::move(join)).value().plan.items.size());
  }
}
BENCHMARK(OperateJoin)->Unit(benchmark::kMillisecond);

void Compare(benchmark::State& state) {
  Plan now = long_way();
  std::get<Waypoint>(now.items[kItems / 2]).at.lat += 1e-6;
  for (auto _ : state) benchmark::DoNotOptimize(compare(long_way(), now).changed);
}
BENCHMARK(Compare)->Unit(benchmark::kMillisecond);

void Import(benchmark::State& state, Format format) {
  const std::string text = export_file(long_way(), format).content;
  for (auto _ : state) {
    benchmark::DoNotOptimize(import_file(text, std::nullopt, "x").value().plan.items.size());
  }
}
BENCHMARK_CAPTURE(Import, Plan, Format::Plan)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Waypoints, Format::Waypoints)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Gpx, Format::Gpx)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Kml, Format::Kml)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Kmz, Format::Kmz)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, GeoJson, Format::GeoJson)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Csv, Format::Csv)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Follower, Format::Follower)->Unit(benchmark::kMillisecond);

std::vector<LatLon> ring(double half_lat, double half_lon) {
  constexpr int kCorners = 200;
  const auto bent = [](double x) { return std::copysign(std::sqrt(std::abs(x)), x); };
  std::vector<LatLon> out;
  for (int i = 0; i < kCorners; ++i) {
    const double angle_rad = 2.0 * M_PI * i / kCorners;
    out.push_back({58.378 + half_lat * bent(std::cos(angle_rad)),
                   26.729 + half_lon * bent(std::sin(angle_rad))});
  }
  return out;
}

/// A field of 300 m by 200 m, round at its corners, with a pond: 6 ha in tracks 1 m apart.
SurveyRequest field(SurveyPattern pattern) {
  SurveyRequest request;
  request.rings.push_back(ring(9e-4, 2.6e-3));
  request.rings.push_back(ring(1e-4, 2e-4));
  request.pattern = pattern;
  return request;
}

void Surveyed(benchmark::State& state, SurveyPattern pattern) {
  const SurveyRequest request = field(pattern);
  for (auto _ : state) {
    auto survey = plan_survey(request);
    if (!survey) throw std::runtime_error(survey.error().detail);
    state.counters["covered_pct"] = 100.0 * survey->covered_share;
    state.counters["items"] = static_cast<double>(survey->items.size());
  }
}
BENCHMARK_CAPTURE(Surveyed, Tracks, SurveyPattern::Tracks)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Surveyed, Perimeter, SurveyPattern::Perimeter)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Surveyed, Spiral, SurveyPattern::Spiral)->Unit(benchmark::kMillisecond);

/// Rows of a farm: 100 by 100 nodes, crossed every tenth.
std::string map_text() {
  constexpr int kSide = 100;
  const auto id = [](int x, int y) { return std::to_string(1 + x + kSide * y); };
  std::string text;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      text += "Node id=" + id(x, y) + " pose=" + std::to_string(x) + " " + std::to_string(y) +
              " 0 links=";
      if (x > 0) text += id(x - 1, y) + " ";
      if (x + 1 < kSide) text += id(x + 1, y) + " ";
      if (y > 0 && x % 10 == 0) text += id(x, y - 1) + " ";
      if (y + 1 < kSide && x % 10 == 0) text += id(x, y + 1) + " ";
      text += "~\n";
    }
  }
  return text;
}

void RouteMapRead(benchmark::State& state) {
  const std::string text = map_text();
  for (auto _ : state) {
    benchmark::DoNotOptimize(graph_from_text(text).value().graph.nodes.size());
  }
}
BENCHMARK(RouteMapRead)->Unit(benchmark::kMillisecond);

void RoutePlanned(benchmark::State& state) {
  const RouteGraph graph = graph_from_text(map_text()).value().graph;
  for (auto _ : state) {
    const auto way = shortest_way(graph, 1, 10'000).value();
    benchmark::DoNotOptimize(items_along(graph, {LatLon{58.378, 26.729}, 90.0}, way).size());
  }
}
BENCHMARK(RoutePlanned)->Unit(benchmark::kMillisecond);

}  // namespace
