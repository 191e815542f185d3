// Node maps in the file.

#include <gtest/gtest.h>

#include "folder.hpp"
#include "store/store.hpp"

namespace roverd::store {
namespace {

RouteMap small_map(const std::string& name) {
  RouteMap map;
  map.about.name = name;
  map.about.frame = {base::LatLon{58.378, 26.729}, 12.5};
  map.graph.nodes = {
      {-3, 0.5, -1.0 / 3.0, 0.1, {4, 1000}}, {4, 1, 2, 3, {}}, {1000, 0, 0, 0, {-3}}};
  map.graph.home = 1000;
  return map;
}

TEST(RouteStore, KeepsMapsAsTheyCame) {
  const Folder folder;
  auto store = *Store::open(folder.file(), at_once);
  const auto made =
      answer_of<RouteMap>([&](auto reply) { store->create_route_map(small_map("yard"), reply); });
  ASSERT_TRUE(made) << made.error().detail;
  RouteMap indoors = small_map("hall");
  indoors.about.frame = {};
  indoors.about.frame.map = "shed";
  indoors.graph.nodes[1] = {4, 0, 0, 0, {1000}, base::LatLon{58.0, 26.0}};
  indoors.graph.home.reset();
  const auto hall =
      answer_of<RouteMap>([&](auto reply) { store->create_route_map(indoors, reply); });
  ASSERT_TRUE(hall) << hall.error().detail;
  store.reset();
  store = *Store::open(folder.file(), at_once);
  const auto read =
      answer_of<RouteMap>([&](auto reply) { store->read_route_map(made->about.id, reply); });
  ASSERT_TRUE(read);
  EXPECT_EQ(read->graph, small_map("yard").graph);
  EXPECT_EQ(read->about.frame.origin, small_map("yard").about.frame.origin);
  EXPECT_EQ(read->about.links, 3);
  EXPECT_FALSE(read->about.frame.map);
  const auto read_hall =
      answer_of<RouteMap>([&](auto reply) { store->read_route_map(hall->about.id, reply); });
  ASSERT_TRUE(read_hall);
  EXPECT_EQ(read_hall->graph, indoors.graph);
  EXPECT_EQ(read_hall->about.frame.map, "shed");
  // The newest first, page by page.
  const auto list = [&](const std::string& cursor) {
    return *answer_of<Page<RouteMapSummary>>(
        [&](auto reply) { store->list_route_maps(1, cursor, reply); });
  };
  EXPECT_EQ(list("").items.at(0).name, "hall");
  EXPECT_FALSE(list("").items.at(0).home);
  EXPECT_FALSE(list("").items.at(0).frame.origin);
  const auto second = list(*list("").next_cursor);
  EXPECT_EQ(second.items.at(0).name, "yard");
  EXPECT_FALSE(second.next_cursor);
  // Deleted, it is gone with its nodes.
  const auto remove = [&] {
    return answer_of<void>([&](auto reply) { store->delete_route_map(made->about.id, reply); });
  };
  EXPECT_TRUE(remove());
  EXPECT_EQ(remove().error().code, base::Code::NotFound);
  EXPECT_EQ(answer_of<RouteMap>([&](auto reply) { store->read_route_map(made->about.id, reply); })
                .error()
                .code,
            base::Code::NotFound);
}

}  // namespace
}  // namespace roverd::store
