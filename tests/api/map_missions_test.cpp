// Missions that count from a kept map, over HTTP: their length, and as files of others.

#include <string>

#include "house.hpp"

namespace roverd::test {
namespace {

const std::string kShed =
    "--x\r\nContent-Disposition: form-data; name=\"yaml\"; filename=\"shed.yaml\"\r\n\r\n"
    "image: shed.pgm\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
    "free_thresh: 0.196\n\r\n"
    "--x\r\nContent-Disposition: form-data; name=\"image\"\r\n\r\n"
    "P2 2 1 255 254 0\n\r\n--x--\r\n";

class MapMissionsApi : public HouseTest {
 protected:
  MapMissionsApi() : HouseTest(House::Vehicle::Whole, seeing()) {}

  static Before seeing() {
    Before before;
    before.sees = true;
    return before;
  }
  void keep_shed() {
    const auto kept =
        call("POST", "/maps", kShed, "Content-Type: multipart/form-data; boundary=x\r\n");
    ASSERT_EQ(kept.status, 201u) << kept.body;
  }
  std::string mission() {
    const Json points = {{{"type", "map_point"}, {"x_m", 1}, {"y_m", 2}},
                         {{"type", "map_point"}, {"x_m", 4}, {"y_m", 6}}};
    const auto kept = call("POST", "/missions",
                           Json{{"name", "m"}, {"frame", {{"map", "shed"}}}, {"items", points}});
    EXPECT_EQ(kept.status, 201u) << kept.body;
    return "/missions/" + kept.body["id"].get<std::string>();
  }
};

TEST_F(MapMissionsApi, AreListedWithTheirLength) {
  const std::string path = mission();
  EXPECT_EQ(call("GET", "/missions").body["items"][0]["length_m"], 5.0);
  EXPECT_EQ(call("GET", path + "/revisions").body["items"][0]["length_m"], 5.0);
}

TEST_F(MapMissionsApi, AreNoFileOfPlacesWhereNobodyKnowsWhereTheMapLies) {
  keep_shed();
  const std::string path = mission();
  for (const char* format :
       {"plan", "waypoints", "gpx", "kml", "kmz", "geojson", "csv", "follower"}) {
    const auto file = call("GET", path + "/export?format=" + format);
    EXPECT_EQ(file.status, 409u) << format;
    const std::string why = file.body["detail"];
    EXPECT_NE(why.find("metres of the map \"shed\""), std::string::npos) << why;
    EXPECT_NE(why.find("as JSON"), std::string::npos) << why;
  }
}

TEST_F(MapMissionsApi, AreFilesOfPlacesByTheAnchorOfTheirMap) {
  keep_shed();
  const std::string path = mission();
  // Given: its x axis looks north.
  const Json anchor = {{"lat", 58.0}, {"lon", 26.0}, {"heading_deg", 0.0}};
  ASSERT_EQ(call("PATCH", "/maps/1", Json{{"anchor", anchor}}).status, 200u);
  // When
  const auto file = call("GET", path + "/export?format=geojson");
  // Then
  ASSERT_EQ(file.status, 200u) << file.body;
  EXPECT_EQ(file.raw.header("items-left-out"), "0");
  EXPECT_EQ(file.raw.header("items-changed"), "2");
  const Json line = Json::parse(file.raw.body)["features"][0]["geometry"]["coordinates"];
  ASSERT_EQ(line.size(), 2u) << file.raw.body;
  EXPECT_NEAR(line[0][1].get<double>(), 58.0 + 1.0 / 111'360.0, 1e-7);
  EXPECT_LT(line[0][0].get<double>(), 26.0);  // y is to the left of it, west
  // And: in use it lies as the robot drives by it.
  ASSERT_EQ(call("POST", "/maps/1/use").status, 200u);
  const auto placed = call("GET", "/maps").body["items"][0]["placed"];
  ASSERT_TRUE(placed.is_object());
  const auto again = call("GET", path + "/export?format=geojson");
  const Json there = Json::parse(again.raw.body)["features"][0]["geometry"]["coordinates"];
  EXPECT_NEAR(there[0][1].get<double>(), placed["lat"].get<double>(), 1e-4);
  EXPECT_NE(there, line);
}

}  // namespace
}  // namespace roverd::test
