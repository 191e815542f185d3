// Node maps: what is read, what is wrong with it, and ways through it.

#include "mission/graph/route_graph.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::mission {
namespace {

//  3 ── 4 ── 5     4 m apart, 5 ─▶ 6 one way,
//  │         │     7 stands alone
//  1 ── 2    6
constexpr const char* kMap = R"(# a yard
Node id=1 pose=0 0 0 links=2 3 ~
Node id=2 pose=4 0 0 links=1 ~

Node id=3 pose=0 4 1.5708 links=1 4 ~
Node id=4 pose=4 4 0 links=3 5 ~
Node id=5 pose=8 4 -1.57e0 links=4 6 ~
Node id=6 pose=8 0 0 links= ~
Node id=7 pose=20 20 0 ~
Home id=1 ~
)";

std::string map_refusal(const std::string& text) {
  const auto read = graph_from_text(text);
  if (read) return "taken";
  EXPECT_EQ(read.error().code, base::Code::Invalid);
  std::string out;
  for (const auto& field : read.error().fields) {
    out += field.pointer + ": " + field.detail + "; ";
  }
  return out;
}

TEST(RouteGraph, IsReadWithItsHomeAndItsOddities) {
  const auto read = graph_from_text(kMap);
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->graph.nodes.size(), 7u);
  EXPECT_EQ(read->graph.links(), 9u);
  EXPECT_EQ(read->graph.home, 1);
  EXPECT_EQ(read->graph.find(3)->theta_rad, 1.5708);
  EXPECT_EQ(read->graph.find(8), nullptr);
  ASSERT_EQ(read->notes.size(), 2u);
  EXPECT_EQ(read->notes[0].line, 7u);
  EXPECT_EQ(read->notes[0].detail, "the link to node 6 leads there only");
  EXPECT_EQ(read->notes[1].line, 9u);
  EXPECT_NE(read->notes[1].detail.find("no link joins"), std::string::npos);
}

TEST(RouteGraph, OtherFormsOfTheSame) {
  const auto read = graph_from_text(
      "\xEF\xBB\xBFversion 2\r\nNODE links=2 2 1 pose=0 0 0 id=1\r\nHome id=2 pose=1 0 0 links=1 "
      "~");
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->graph.home, 2);
  EXPECT_EQ(read->graph.nodes.size(), 2u);
  EXPECT_EQ(read->graph.links(), 2u);
  // Passed over, no ~, a link twice, a link to itself.
  EXPECT_EQ(read->notes.size(), 4u);
}

TEST(RouteGraph, DamageIsNamedByItsLine) {
  EXPECT_EQ(map_refusal(""), "line 1: no node in the whole text; ");
  EXPECT_EQ(map_refusal("Node pose=0 0 0 ~"), "line 1: has no id; ");
  EXPECT_EQ(map_refusal("\nNode id=1 pose=0 0 ~"),
            "line 2: pose must be x, y and theta, has 2 numbers; ");
  EXPECT_EQ(map_refusal("Node id=1 pose=0 x 0 ~"), "line 1: pose cannot be \"x\"; ");
  EXPECT_EQ(map_refusal("Node id=1 pose=nan 0 0 ~"), "line 1: pose cannot be \"nan\"; ");
  EXPECT_EQ(map_refusal("Node id=1.5 pose=0 0 0 ~"), "line 1: id cannot be \"1.5\"; ");
  EXPECT_EQ(map_refusal("Node id=99999999999999999999 pose=0 0 0 ~"),
            "line 1: id cannot be \"99999999999999999999\"; ");
  EXPECT_EQ(map_refusal("Node id=1 pose=0 0 0 ~ links=2"), "line 1: goes on after its ~; ");
  EXPECT_EQ(map_refusal("Node id=1 id=2 pose=0 0 0 ~"), "line 1: has id twice; ");
  EXPECT_EQ(map_refusal("Node 7 id=1 ~"), "line 1: has \"7\" without a key; ");
  EXPECT_EQ(map_refusal("Node id=1 latlon=58 ~"),
            "line 1: latlon must be latitude and longitude, has 1 numbers; ");
  EXPECT_EQ(map_refusal("Node id=1 latlon=91 26 ~"),
            "line 1: latlon is no latitude and longitude in degrees; ");
  EXPECT_EQ(map_refusal("Node id=1 latlon=58 26 pose=0 0 0 ~"),
            "line 1: has both a pose and a latlon; ");
  EXPECT_EQ(map_refusal("Node id=1 pose=1e5 0 0 ~"),
            "line 1: pose lies more than 10 km from the origin; ");
  EXPECT_EQ(map_refusal("Node id=1 pose=0 0 0 ~\nNode id=1 pose=1 0 0 ~"),
            "line 2: node 1 is on line 1 already; ");
  EXPECT_EQ(
      map_refusal("Node id=1 pose=0 0 0 links=5 6 ~"),
      "line 1: is linked to node 5, which is not there; line 1: is linked to node 6, which is "
      "not there; ");
  EXPECT_EQ(map_refusal("Node id=1 pose=0 0 0 ~\nHome id=2 ~"),
            "line 2: names the home node 2, which is not there; ");
  EXPECT_EQ(map_refusal("Node id=1 pose=0 0 0 ~\nHome id=1 ~\nHome id=1 ~"),
            "line 3: names a second home; the first one is on line 2; ");
}

TEST(RouteGraph, TheShortestWayGoesAlongTheLinks) {
  const RouteGraph graph = graph_from_text(kMap)->graph;
  EXPECT_EQ(*shortest_way(graph, 2, 6), (std::vector<std::int64_t>{2, 1, 3, 4, 5, 6}));
  EXPECT_EQ(way_length_m(graph, *shortest_way(graph, 2, 6)), 20.0);
  EXPECT_EQ(*shortest_way(graph, 4, 4), (std::vector<std::int64_t>{4}));
  // 5 leads to 6, but nothing leads back, and nothing to 7.
  EXPECT_EQ(shortest_way(graph, 6, 5).error().code, base::Code::Conflict);
  EXPECT_EQ(shortest_way(graph, 1, 7).error().detail, "no way leads from node 1 to node 7");
}

TEST(RouteGraph, LiesOnEarthAsItsFrameSays) {
  const RouteGraph graph = graph_from_text(kMap)->graph;
  MapFrame frame{LatLon{58.378, 26.729}, 90.0};
  const auto way = *shortest_way(graph, 1, 5);
  auto items = items_along(graph, frame, way);
  ASSERT_EQ(items.size(), 4u);
  const auto last = [&] {
    return base::distance_bearing(*frame.origin, std::get<Waypoint>(items.back()).at);
  };
  EXPECT_NEAR(last().distance_m, std::hypot(8, 4), 1e-4);
  EXPECT_NEAR(last().bearing_deg, 63.435, 0.001);  // 8 east, 4 north
  frame.heading_deg = 0.0;                         // x is north, y is west
  items = items_along(graph, frame, way);
  EXPECT_NEAR(last().bearing_deg, 360.0 - 26.565, 0.001);
  EXPECT_EQ(nearest_node(graph, frame, position_of(*graph.find(4), frame)), 4);
  EXPECT_FALSE(nearest_node(graph, frame, LatLon{0.0, 0.0}));
  EXPECT_FALSE(nearest_node(graph, MapFrame{}, LatLon{58.378, 26.729}));
  // Indoors the items are local, and the last one has the node's heading.
  items = items_along(graph, MapFrame{}, *shortest_way(graph, 1, 3));
  EXPECT_EQ(std::get<Local>(items.back()).heading_deg.has_value(), true);
  EXPECT_NEAR(*std::get<Local>(items.back()).heading_deg, 360.0, 0.001);
  EXPECT_NEAR(std::get<Local>(items.back()).north_m, 4.0, 1e-9);
}

TEST(RouteGraph, InAMapItsWaysArePointsOfThatMap) {
  const RouteGraph graph = graph_from_text(kMap)->graph;
  const MapFrame frame{{}, 90.0, "shed"};
  const auto items = items_along(graph, frame, *shortest_way(graph, 2, 3));
  EXPECT_EQ(items, (std::vector<Item>{MapPoint{.x_m = 4.0}, MapPoint{},
                                      MapPoint{.y_m = 4.0, .yaw_deg = base::deg_from_rad(1.5708)}}))
      << "the last one has the node's heading, from the map's x axis";
  EXPECT_EQ(nearest_node(graph, 6.5, 3.0), 5);
  EXPECT_FALSE(nearest_node(graph, frame, LatLon{58.378, 26.729})) << "none lies on the earth";
}

//   shed: 1 ── 2 │door│ 3 ── 4 on the street, 10 m apart
constexpr const char* kShedAndStreet =
    "Node id=1 pose=0 0 0 links=2 ~\nNode id=2 pose=10 0 0 links=1 3 ~\n"
    "Node id=3 latlon=58.37818 26.729 links=2 4 ~\nNode id=4 latlon=58.37827 26.729 links=3 ~\n";
const base::MapLies kShedLies{LatLon{58.378, 26.729}, base::kPi / 2.0};  // x looks north

TEST(RouteGraph, WhereTheMapLiesJoinsItsNodesAndThoseOnTheEarth) {
  const RouteGraph graph = graph_from_text(kShedAndStreet)->graph;
  const OnePlane flat = on_one_plane(graph, kShedLies);
  EXPECT_FALSE(flat.parted);
  const auto way = shortest_way(flat.graph, 1, 4);
  ASSERT_TRUE(way) << way.error().detail;
  EXPECT_NEAR(way_length_m(flat.graph, *way), 30.0, 0.1);
  const auto items = items_along(flat.graph, {{}, 90.0, "shed"}, *way);
  ASSERT_EQ(items.size(), 4u);
  EXPECT_EQ(items[1], Item(MapPoint{.x_m = 10.0}));
  EXPECT_EQ(std::get<Waypoint>(items[2]).at, (LatLon{58.37818, 26.729})) << "as it was given";
}

TEST(RouteGraph, NoWayLeadsOutOfAMapThatLiesNowhere) {
  const RouteGraph graph = graph_from_text(kShedAndStreet)->graph;
  const OnePlane flat = on_one_plane(graph, {});
  EXPECT_TRUE(flat.parted);
  EXPECT_FALSE(shortest_way(flat.graph, 1, 4));
  EXPECT_FALSE(shortest_way(flat.graph, 4, 1));
  // Each part has its ways.
  EXPECT_EQ(way_length_m(flat.graph, *shortest_way(flat.graph, 1, 2)), 10.0);
  EXPECT_NEAR(way_length_m(flat.graph, *shortest_way(flat.graph, 3, 4)), 10.0, 0.1);
  EXPECT_EQ(nearest_node(graph, 100.0, 0.0), 2) << "only those in the map's own metres";
  EXPECT_EQ(nearest_node(graph, {{}, 90.0, "shed"}, LatLon{58.378, 26.729}), 3);
}

TEST(RouteGraph, NodesOnTheEarthBecomeMetresOfAGraphWithAnOrigin) {
  RouteGraph graph = graph_from_text("Node id=5 latlon=58.378 26.729 ~")->graph;
  const MapFrame frame{LatLon{58.3779, 26.729}, 0.0};  // x is north
  ASSERT_TRUE(settle_on_earth(graph, frame));
  EXPECT_FALSE(graph.nodes[0].on_earth);
  EXPECT_NEAR(graph.nodes[0].x_m, 11.14, 0.01);
  EXPECT_LT(base::distance_bearing(position_of(graph.nodes[0], frame), {58.378, 26.729}).distance_m,
            1e-3);
  const auto why = [](const MapFrame& in) {
    RouteGraph again = graph_from_text("Node id=5 latlon=58.378 26.729 ~")->graph;
    const auto fine = settle_on_earth(again, in);
    return fine ? "" : fine.error().detail;
  };
  EXPECT_EQ(why({{}, 90.0, "shed"}), "");
  EXPECT_NE(why({}).find("node 5 lies on the earth, and the graph indoors"), std::string::npos);
  EXPECT_NE(why({LatLon{59.0, 26.0}}).find("node 5 lies more than 10 km"), std::string::npos);
}

TEST(RouteGraph, TenThousandNodesAreQuick) {
  std::string text;
  const auto id = [](int x, int y) { return std::to_string(1 + x + 100 * y); };
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      text += "Node id=" + id(x, y) + " pose=" + std::to_string(x) + " " + std::to_string(y) +
              " 0 links=";
      if (x > 0) text += id(x - 1, y) + " ";
      if (x < 99) text += id(x + 1, y) + " ";
      if (y > 0 && x % 10 == 0) text += id(x, y - 1) + " ";
      if (y < 99 && x % 10 == 0) text += id(x, y + 1) + " ";
      text += "~\n";
    }
  }
  const auto read = graph_from_text(text);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->notes.empty());
  const auto way = shortest_way(read->graph, 1, 10'000);
  ASSERT_TRUE(way);
  EXPECT_EQ(way_length_m(read->graph, *way), 198.0);
}

}  // namespace
}  // namespace roverd::mission
