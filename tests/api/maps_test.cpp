// Kept maps over HTTP: uploads, small edits, the choice, and what is refused.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>

#include "access_house.hpp"
#include "house.hpp"

namespace roverd::test {
namespace {

namespace fs = std::filesystem;

const std::string kYaml =
    "image: shed.pgm\nresolution: 0.5\norigin: [-1, -2, 0.5]\nnegate: 0\noccupied_thresh: 0.65\n"
    "free_thresh: 0.196\nwritten_by: somebody\n";
/// 4 x 3: all free but the lower left cell.
const std::string kPicture =
    "P2 # by hand\n4 3 255\n254 254 254 254 254 254 254 254 0 254 254 205\n";

constexpr const char* kForm = "Content-Type: multipart/form-data; boundary=x\r\n";

std::string part(const std::string& name, const std::string& content,
                 const std::string& file = "") {
  const std::string as_file = file.empty() ? "" : "; filename=\"" + file + "\"";
  return "--x\r\nContent-Disposition: form-data; name=\"" + name + "\"" + as_file + "\r\n\r\n" +
         content + "\r\n";
}
std::string form(const std::string& yaml, const std::string& picture,
                 const std::string& more = "") {
  return part("yaml", yaml, "maps/shed.yaml") + part("image", picture, "a.pgm") + more +
         "--x--\r\n";
}

Json square(double west, double south, double edge) {
  return {{{"x_m", west}, {"y_m", south}},
          {{"x_m", west + edge}, {"y_m", south}},
          {{"x_m", west + edge}, {"y_m", south + edge}},
          {{"x_m", west}, {"y_m", south + edge}}};
}

Before seeing() {
  Before before;
  before.sees = true;
  return before;
}

class MapsApi : public HouseTest {
 protected:
  explicit MapsApi(const Before& before = seeing()) : HouseTest(House::Vehicle::Whole, before) {}

  Reply add(const std::string& body = form(kYaml, kPicture)) {
    return call("POST", "/maps", body, kForm);
  }
  std::string refused(const std::string& body) {
    const Reply reply = add(body);
    EXPECT_EQ(reply.status, 422u) << reply.body;
    return reply.status == 422u ? reply.body["errors"][0]["pointer"].get<std::string>() : "";
  }
  std::string refused_change(const Json& body) {
    const Reply reply = call("PATCH", "/maps/1", body);
    EXPECT_EQ(reply.status, 422u) << reply.body;
    return reply.status == 422u ? reply.body["errors"][0]["pointer"].get<std::string>() : "";
  }
};

TEST_F(MapsApi, AMapIsUploadedListedShownAndDeleted) {
  EXPECT_EQ(call("GET", "/maps").body["items"], Json::array());
  const auto made = add();
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(made.raw.header("location"), "/api/v1/maps/1");
  EXPECT_EQ(made.body["name"], "shed");
  EXPECT_EQ(made.body["passed_over"], Json({"written_by"}));
  EXPECT_EQ(made.body["width"], 4);
  EXPECT_EQ(made.body["height"], 3);
  EXPECT_NEAR(made.body["origin"]["yaw_deg"], 28.6479, 1e-4);
  EXPECT_EQ(made.body["in_use"], false);
  EXPECT_EQ(made.body["anchor"], nullptr);
  ASSERT_EQ(add(form(kYaml, kPicture, part("name", "barn"))).body["name"], "barn");
  const auto list = call("GET", "/maps");
  ASSERT_EQ(list.body["items"].size(), 2u);
  EXPECT_EQ(list.body["in_use"], nullptr);
  const auto cells = call("GET", "/maps/1/cells");
  EXPECT_EQ(cells.status, 200u);
  EXPECT_EQ(cells.raw.header("content-type"), "image/x-portable-graymap");
  EXPECT_EQ(cells.raw.header("roverd-thinned"), "1");
  EXPECT_EQ(cells.raw.body.size(), std::string("P5\n4 3\n255\n").size() + 12);
  const std::string tag = cells.raw.header("etag");
  EXPECT_EQ(call("GET", "/maps/1/cells", "", "If-None-Match: " + tag + "\r\n").status, 304u);
  EXPECT_EQ(call("GET", "/maps/1/cells?most=4").raw.header("roverd-thinned"), "2");
  EXPECT_EQ(call("GET", "/maps/1/cells?most=0").status, 422u);
  EXPECT_EQ(call("DELETE", "/maps/1").status, 204u);
  EXPECT_EQ(call("DELETE", "/maps/1").status, 404u);
  for (const char* path : {"/maps/1", "/maps/1/cells", "/maps/0", "/maps/shed",
                           "/maps/1/export?format=yaml", "/maps/99999999999999999999"}) {
    EXPECT_EQ(call("GET", path).status, 404u) << path;
  }
}

TEST_F(MapsApi, WhatIsExportedIsTheMap) {
  ASSERT_EQ(add().status, 201u);
  const auto yaml = call("GET", "/maps/1/export?format=yaml");
  const auto picture = call("GET", "/maps/1/export?format=pgm");
  EXPECT_EQ(yaml.raw.header("content-disposition"), "attachment; filename=\"shed-1.yaml\"");
  EXPECT_NE(yaml.raw.body.find("image: shed-1.pgm\n"), std::string::npos) << yaml.raw.body;
  const auto again = add(form(yaml.raw.body, picture.raw.body));
  ASSERT_EQ(again.status, 201u);
  EXPECT_EQ(again.body["name"], "shed 2");  // nobody asked for a name that is taken
  EXPECT_EQ(call("GET", "/maps/1/cells").raw.body, call("GET", "/maps/2/cells").raw.body);
  ASSERT_EQ(add(form(kYaml, kPicture, part("name", "North shed (new)"))).status, 201u);
  EXPECT_EQ(call("GET", "/maps/3/export?format=pgm").raw.header("content-disposition"),
            "attachment; filename=\"North_shed_new-3.pgm\"");
  ASSERT_EQ(add(form(kYaml, kPicture, part("name", "\u5e93"))).status, 201u);
  EXPECT_EQ(call("GET", "/maps/4/export?format=pgm").raw.header("content-disposition"),
            "attachment; filename=\"map-4.pgm\"");
  EXPECT_EQ(call("GET", "/maps/1/export?format=png").status, 422u);
  EXPECT_EQ(call("GET", "/maps/1/export").status, 422u);
}

TEST_F(MapsApi, AnExportedMapComesBackWithItsNameAndWhereItLies) {
  // Given: a map that was told where it lies.
  ASSERT_EQ(add().status, 201u);
  const Json anchor = {{"lat", 58.37802},
                       {"lon", 26.7289},
                       {"heading_deg", 45.5},
                       {"accuracy_m", 0.25},
                       {"heading_accuracy_deg", 0.5}};
  ASSERT_EQ(call("PATCH", "/maps/1", Json{{"name", "north: shed"}, {"anchor", anchor}}).status,
            200u);
  const std::string yaml = call("GET", "/maps/1/export?format=yaml").raw.body;
  ASSERT_EQ(call("DELETE", "/maps/1").status, 204u);
  // When: it is brought to another robot.
  const auto back = add(form(yaml, kPicture));
  // Then
  ASSERT_EQ(back.status, 201u) << back.body;
  EXPECT_EQ(back.body["name"], "north: shed");
  EXPECT_EQ(back.body["anchor"], anchor);
  EXPECT_EQ(back.body["passed_over"], Json::array());
  // And: an anchor that cannot be is told, and the map is kept.
  const auto poor = add(form("# anchor_lat: 158\n" + kYaml, kPicture));
  EXPECT_EQ(poor.body["anchor"], nullptr);
  EXPECT_EQ(poor.body["passed_over"],
            Json({"written_by", "# anchor_lat", "# anchor_lon", "# anchor_heading_deg"}));
}

TEST_F(MapsApi, ANameIsGivenOnce) {
  const auto named = [this](const std::string& name) {
    return add(form(kYaml, kPicture, part("name", name)));
  };
  ASSERT_EQ(named("barn").status, 201u);
  const auto refused = named("barn");
  EXPECT_EQ(refused.status, 409u);
  EXPECT_EQ(refused.body["detail"],
            "the name \"barn\" is taken by map 1: give another one, or rename that map");
  EXPECT_EQ(refused.body["errors"][0]["pointer"], "/name");
  EXPECT_EQ(add().body["name"], "shed");
  EXPECT_EQ(add().body["name"], "shed 2");  // as the files are called: nobody's wish
  EXPECT_EQ(call("PATCH", "/maps/2", Json{{"name", "barn"}}).status, 409u);
  EXPECT_EQ(call("PATCH", "/maps/2", Json{{"name", "shed"}}).status, 200u);
}

// Missions count from it by its name.
TEST_F(MapsApi, TheRobotKnowsTheMapInUseByTheNameThatItIsGiven) {
  ASSERT_EQ(add().status, 201u);
  ASSERT_EQ(call("POST", "/maps/1/use").status, 200u);
  house.map_taken = -2;
  ASSERT_EQ(call("PATCH", "/maps/1", Json{{"name", "yard"}}).status, 200u);
  EXPECT_EQ(house.map_taken, 1);
  EXPECT_EQ(house.map_same_place, true);
}

//   A wall on a piece of ground, as some other program wrote it.
TEST_F(MapsApi, AMapInThreeDimensionsIsKeptWithItsPlaneAndGivenBack) {
  std::string points;
  int n = 0;
  for (double x = 0.05; x < 2.0; x += 0.1, ++n) points += std::to_string(x) + " 0.5 0\n";
  for (double z = 0.05; z < 2.0; z += 0.1, ++n) points += "1.05 0.5 " + std::to_string(z) + "\n";
  const std::string pcd = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
                          std::to_string(n) + "\nHEIGHT 1\nPOINTS " + std::to_string(n) +
                          "\nDATA ascii\n" + points;
  const auto cloud = [](const std::string& file, const std::string& more = "") {
    return part("cloud", file, "yard.pcd") + more + "--x--\r\n";
  };
  // when
  const auto made = add(cloud(pcd));
  // then
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(made.body["name"], "yard");
  EXPECT_EQ(made.body["solid"], true);
  EXPECT_EQ(made.body["resolution_m"], 0.05);
  const std::string cells = call("GET", "/maps/1/cells").raw.body;
  EXPECT_NE(cells.find('\0'), std::string::npos) << "the wall is occupied";
  const auto given = call("GET", "/maps/1/export?format=pcd");
  EXPECT_EQ(given.raw.header("content-disposition"), "attachment; filename=\"yard-1.pcd\"");
  ASSERT_EQ(add(cloud(given.raw.body)).status, 201u);
  EXPECT_EQ(call("GET", "/maps/2/cells").raw.body, cells) << "what is given is what is taken";
  EXPECT_EQ(call("POST", "/maps/1/use").status, 200u);
  // and a map of the plane has none, and a form holds one of both
  ASSERT_EQ(add().body["solid"], false);
  EXPECT_EQ(call("GET", "/maps/3/export?format=pcd").status, 409u);
  EXPECT_EQ(refused(cloud(pcd, part("yaml", kYaml, "a.yaml"))), "/yaml");
  EXPECT_EQ(refused(cloud(pcd.substr(0, pcd.size() - 20))), "/cloud/line 48");
  EXPECT_EQ(refused(cloud("no cloud")), "/cloud/line 1");
  EXPECT_EQ(call("GET", "/maps").body["items"].size(), 3u);
}

//   A cloud of another program, moved by its header, with a point that is none and a stray one.
TEST_F(MapsApi, WhatOfACloudIsLeftOutIsTold) {
  std::string points = "nan 0 0\n9e9 0 0\n";
  for (int i = 0; i < 198; ++i) points += std::to_string(0.1 * i) + " 0.5 0\n";
  const auto cloud = [](const std::string& text) {
    return part("cloud",
                "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 200\n"
                "HEIGHT 1\nVIEWPOINT 100 50 1 1 0 0 0\nPOINTS 200\nDATA ascii\n" +
                    text,
                "yard.pcd") +
           "--x--\r\n";
  };
  const auto made = add(cloud(points));
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(made.body["passed_over"],
            Json({"1 point that is no number", "1 point too far from the origin",
                  "VIEWPOINT: the points are taken as they stand"}));
  // With half of it in national coordinates it is no map.
  for (int i = 0; i < 100; ++i) points.insert(0, "500000 6470000 60\n");
  const auto half = add(cloud(points));
  EXPECT_EQ(half.status, 422u);
  EXPECT_NE(half.raw.body.find("101 of 199 points lie too far from the origin"), std::string::npos)
      << half.raw.body;
  EXPECT_EQ(call("GET", "/maps").body["items"].size(), 1u);
}

TEST_F(MapsApi, AMissionOfManyItemsDoesNotWaitBehindAMap) {
  // Given a map on its way in, which takes as long as it takes,
  auto held = house.hold(net::Lane::Slow);
  const std::string body = form(kYaml, kPicture);
  Client map(house.port());
  map.send("POST /api/v1/maps HTTP/1.1\r\nHost: 127.0.0.1\r\n" + std::string(kForm) +
           "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  // when a mission of many items comes, then it is taken,
  std::string line = R"({"type":"LineString","coordinates":[[26.7,58.3])";
  for (int i = 1; i < 20'000; ++i) line += ",[" + std::to_string(26.7 + 1e-5 * i) + ",58.300001]";
  EXPECT_EQ(call("POST", "/missions/import?name=line", line + "]}").status, 201u);
  // before the map is.
  EXPECT_FALSE(fs::exists(house.maps_folder() / "1"));
  held.reset();
  const auto made = map.answer();
  ASSERT_TRUE(made);
  EXPECT_EQ(made->status, 201u);
}

TEST_F(MapsApi, UglyUploadsAreNamedAndNothingIsKept) {
  EXPECT_EQ(refused(form("resolution: 0.5\n", kPicture)), "/yaml/image");
  EXPECT_EQ(refused(form(kYaml, "P5 10000 10000 255 ")), "/image/size");
  EXPECT_EQ(refused(form(kYaml, "P5\n4 3\n255\n12345")), "/image/byte 16");
  EXPECT_EQ(refused(form(kYaml, "\x89PNG")), "/image/byte 0");
  EXPECT_EQ(refused(part("image", kPicture) + "--x--\r\n"), "/yaml");
  EXPECT_EQ(refused(part("yaml", kYaml) + "--x--\r\n"), "/image");
  EXPECT_EQ(refused(form(kYaml, kPicture, part("yaml", kYaml))), "/yaml");
  EXPECT_EQ(refused(form(kYaml, kPicture, part("colour", "red"))), "/colour");
  EXPECT_EQ(refused(form(kYaml, kPicture, part("name", "\x01"))), "/name");
  EXPECT_EQ(add(form(kYaml, kPicture).substr(0, 100)).status, 400u);
  EXPECT_EQ(call("POST", "/maps", kYaml, "Content-Type: text/plain\r\n").status, 415u);
  EXPECT_EQ(call("GET", "/maps").body["items"], Json::array());
}

TEST_F(MapsApi, IsChangedALittle) {
  ASSERT_EQ(add(form("image: a\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: 0\n"
                     "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
                     kPicture))
                .status,
            201u);
  const Json anchor = {{"lat", 58.0}, {"lon", 26.0}, {"heading_deg", 90.0}};
  const auto changed = call("PATCH", "/maps/1",
                            Json{{"name", "yard"},
                                 {"anchor", anchor},
                                 {"edits",
                                  {{{"kind", "erase"}, {"polygon", square(0, 0, 0.5)}},
                                   {{"kind", "wall"}, {"polygon", square(0.5, 0.5, 0.5)}},
                                   {{"kind", "forbid"}, {"polygon", square(1.0, 1.0, 1.0)}}}}});
  ASSERT_EQ(changed.status, 200u) << changed.body;
  EXPECT_EQ(changed.body["name"], "yard");
  EXPECT_EQ(changed.body["revision"], 2);
  EXPECT_EQ(changed.body["anchor"]["accuracy_m"], 0.3);
  EXPECT_EQ(changed.body["forbidden"], Json::array({square(1.0, 1.0, 1.0)}));
  EXPECT_EQ(house.map_taken, -2);  // not in use: the robot does not care
  const std::string cells = call("GET", "/maps/1/cells").raw.body;
  const std::string want =
      "\xFE\xFE\x64\x64" + std::string("\xFE\0\xFE\xFE", 4) + "\xFE\xFE\xFE\xCD";
  EXPECT_EQ(cells.substr(cells.size() - 12), want);
  const auto drawn = call("GET", "/maps/1/export?format=pgm").raw.body;
  EXPECT_EQ(drawn[drawn.size() - 10], '\0');
  const auto left_out = call("GET", "/maps/1/export?format=pgm&forbidden=left_out").raw.body;
  EXPECT_EQ(left_out[left_out.size() - 10], '\xFE');
  const auto back =
      call("PATCH", "/maps/1", Json{{"anchor", nullptr}, {"forbidden", Json::array()}});
  EXPECT_EQ(back.body["anchor"], nullptr);
  EXPECT_EQ(back.body["forbidden"], Json::array());
}

TEST_F(MapsApi, UglyChangesAreNamedAndNothingIsChanged) {
  ASSERT_EQ(add().status, 201u);
  const auto edit = [](const char* kind, const Json& polygon) {
    return Json{{"edits", {{{"kind", kind}, {"polygon", polygon}}}}};
  };
  EXPECT_EQ(refused_change(edit("paint", square(0, 0, 1))), "/edits/0/kind");
  EXPECT_EQ(refused_change(edit("erase", Json::array())), "/edits/0/polygon");
  EXPECT_EQ(refused_change(edit("erase", Json(1000, square(0, 0, 1)[0]))), "/edits/0/polygon");
  Json far = square(0, 0, 1);
  far[2]["x_m"] = 1e9;
  EXPECT_EQ(refused_change(edit("erase", far)), "/edits/0/polygon/2/x_m");
  far[2] = {1, 2};
  EXPECT_EQ(refused_change(edit("erase", far)), "/edits/0/polygon/2");
  EXPECT_EQ(refused_change({{"anchor", {{"lat", 91}, {"lon", 0}, {"heading_deg", 0}}}}),
            "/anchor/lat");
  EXPECT_EQ(refused_change({{"anchor", {{"lat", 1}, {"lon", 0}}}}), "/anchor/heading_deg");
  EXPECT_EQ(refused_change({{"anchor", 5}}), "/anchor");
  EXPECT_EQ(refused_change({{"edits", Json(51, Json::object())}}), "/edits");
  EXPECT_EQ(refused_change(edit("erase", square(900, 0, 1))), "/edits/0/polygon");
  EXPECT_EQ(refused_change({{"forbidden", 1}}), "/forbidden");
  EXPECT_EQ(refused_change({{"name", ""}}), "/name");
  EXPECT_EQ(refused_change({{"resolution_m", 1}}), "/resolution_m");
  EXPECT_EQ(call("PATCH", "/maps/1", "{").status, 400u);
  EXPECT_EQ(call("PATCH", "/maps/2", Json{{"name", "x"}}).status, 404u);
  EXPECT_EQ(call("GET", "/maps/1").body["revision"], 1);
}

TEST_F(MapsApi, TheChoiceActsAtOnceAndIsWrittenDown) {
  ASSERT_EQ(add().status, 201u);
  ASSERT_EQ(add().status, 201u);
  const auto used = call("POST", "/maps/2/use");
  ASSERT_EQ(used.status, 200u) << used.body;
  EXPECT_EQ(used.body["in_use"], true);
  EXPECT_EQ(house.map_taken, 2);
  EXPECT_EQ(house.map_same_place, false);
  EXPECT_EQ(call("DELETE", "/maps/2").status, 409u);
  const auto list = call("GET", "/maps").body;
  EXPECT_EQ(list["in_use"], 2);
  EXPECT_EQ(list["items"][1]["placed"]["heading_deg"], 90.0);
  EXPECT_EQ(list["items"][0]["placed"], nullptr);
  until([this] { return house.snapshot() != nullptr; }, "it runs");
  const auto place = call("GET", "/vehicle").body["place"];
  EXPECT_EQ(place["map_id"], 2);
  EXPECT_EQ(place["placed"]["accuracy_m"], 0.4);
  std::ifstream kept(house.maps_folder() / "in_use.json");
  EXPECT_EQ(Json::parse(kept)["map"], 2);
  const Json wall = {{"edits", {{{"kind", "wall"}, {"polygon", square(0, 0, 1)}}}}};
  ASSERT_EQ(call("PATCH", "/maps/2", wall).status, 200u);
  EXPECT_EQ(house.map_same_place, true);  // it looks through the changed one, where it was
  const auto none = call("POST", "/maps/unuse");
  EXPECT_EQ(none.body["in_use"], nullptr);
  EXPECT_EQ(house.map_taken, -1);
  EXPECT_EQ(call("GET", "/vehicle").body["place"]["map_id"], nullptr);
  EXPECT_EQ(call("DELETE", "/maps/2").status, 204u);
  EXPECT_EQ(call("POST", "/maps/2/use").status, 404u);
}

TEST_F(MapsApi, AChoiceInWhichTheRobotDoesNotLookYetIsNotSaidToBeInUse) {
  ASSERT_EQ(add().status, 201u);
  house.map_looks = false;  // it is busy for longer than anybody waits
  for (const char* path : {"/maps/1/use", "/maps/unuse"}) {
    const auto reply = call("POST", path);
    EXPECT_EQ(reply.status, 503u);
    EXPECT_EQ(reply.body["detail"], "it is chosen and kept, but the robot does not look there yet");
  }
}

TEST_F(MapsApi, WhatAnotherOneForbadeMeanwhileIsNotAllowedUnseen) {
  ASSERT_EQ(add().status, 201u);
  const auto revision = call("GET", "/maps/1").body["revision"].get<int>();
  const Json forbid = {{"edits", {{{"kind", "forbid"}, {"polygon", square(0, 0, 1)}}}}};
  ASSERT_EQ(call("PATCH", "/maps/1", forbid).status, 200u);
  Json none = {{"revision", revision}, {"forbidden", Json::array()}};
  const auto late = call("PATCH", "/maps/1", none);
  EXPECT_EQ(late.status, 409u);
  EXPECT_EQ(late.body["detail"], "the map was changed meanwhile");
  const auto now = call("GET", "/maps/1").body;
  EXPECT_EQ(now["forbidden"].size(), 1u);
  none["revision"] = now["revision"];
  EXPECT_EQ(call("PATCH", "/maps/1", none).body["forbidden"], Json::array());
  EXPECT_EQ(refused_change({{"revision", "two"}}), "/revision");
}

TEST_F(MapsApi, AFileThatVanishedIsTold) {
  ASSERT_EQ(add().status, 201u);
  fs::remove(house.maps_folder() / "1/map.1.pgm");
  const std::string problem = call("GET", "/maps").body["items"][0]["problem"];
  EXPECT_NE(problem.find("map.1.pgm"), std::string::npos);
  EXPECT_EQ(call("GET", "/maps/1").body["problem"], problem);
  EXPECT_EQ(call("GET", "/maps/1/cells").status, 503u);
  EXPECT_EQ(call("POST", "/maps/1/use").status, 503u);
  EXPECT_EQ(call("GET", "/maps").body["in_use"], nullptr);
  EXPECT_EQ(call("DELETE", "/maps/1").status, 204u);
}

TEST_F(MapsApi, WhatWasReadMayBeSentBackHoweverLong) {
  ASSERT_EQ(add().status, 201u);
  Json ring = Json::array();
  for (int i = 0; i < 400; ++i) {
    ring.push_back({{"x_m", std::cos(i * 0.0157) * 1.23456}, {"y_m", std::sin(i * 0.0157)}});
  }
  Json areas = Json::array();
  for (int i = 0; i < 50; ++i) areas.push_back(ring);
  const auto kept = call("PATCH", "/maps/1", Json{{"forbidden", areas}});
  ASSERT_EQ(kept.status, 200u) << kept.body;
  EXPECT_EQ(kept.body["forbidden"].size(), 50u);
  areas.erase(areas.size() - 1);
  const auto less = call("PATCH", "/maps/1", Json{{"forbidden", areas}});
  EXPECT_EQ(less.body["forbidden"].size(), 49u);
  EXPECT_EQ(less.body["revision"], 3);
}

TEST_F(MapsApi, NobodyChangesTheMapUnderARobotThatDrivesByItself) {
  ASSERT_EQ(add().status, 201u);
  ASSERT_EQ(add().status, 201u);
  ASSERT_EQ(call("POST", "/maps/1/use").status, 200u);
  until_ready();
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  EXPECT_EQ(call("POST", "/maps/1/use").status, 200u);  // armed, and standing
  ASSERT_EQ(call("POST", "/vehicle/goto",
                 Json{{"lat", kStart.lat + 0.0002}, {"lon", kStart.lon}, {"valid_for_s", 5}})
                .status,
            202u);
  until([this] { return call("GET", "/vehicle").body["mode"] == "GUIDED"; }, "it drives");
  const auto refused = call("POST", "/maps/2/use");
  EXPECT_EQ(refused.status, 409u);
  EXPECT_NE(refused.body["detail"].get<std::string>().find("GUIDED"), std::string::npos);
  EXPECT_EQ(call("POST", "/maps/unuse").status, 409u);
  const Json wall = {{"edits", {{{"kind", "wall"}, {"polygon", square(0, 0, 1)}}}}};
  EXPECT_EQ(call("PATCH", "/maps/1", wall).status, 409u);
  EXPECT_EQ(call("PATCH", "/maps/2", wall).status, 200u);
  // What is driven may count from it by its name.
  EXPECT_EQ(call("PATCH", "/maps/1", Json{{"name", "now"}}).status, 409u);
  EXPECT_EQ(call("PATCH", "/maps/2", Json{{"name", "now"}}).status, 200u);
  const std::string same = call("GET", "/maps/1").body["name"];
  EXPECT_EQ(call("PATCH", "/maps/1", Json{{"name", same}}).status, 200u) << "it is called so";
  EXPECT_EQ(call("GET", "/maps").body["in_use"], 1);
  ASSERT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "HOLD"}}).status, 200u);
  until([this] { return call("GET", "/vehicle").body["mode"] == "HOLD"; }, "it holds");
  EXPECT_EQ(call("POST", "/maps/2/use").status, 200u);
}

TEST_F(MapsApi, AMapIsDrivenAndKept) {
  EXPECT_EQ(call("POST", "/maps/stop").status, 409u);
  EXPECT_EQ(call("GET", "/maps").body["making"], nullptr);
  ASSERT_EQ(call("POST", "/maps/start").status, 200u);
  EXPECT_EQ(call("POST", "/maps/start").status, 409u);
  EXPECT_EQ(call("GET", "/maps").body["making"]["way_m"], 3.4);
  EXPECT_EQ(call("GET", "/maps").body["making"]["clouds"], 3);
  EXPECT_EQ(call("POST", "/maps/stop", Json{{"name", ""}}).status, 422u);
  EXPECT_EQ(call("POST", "/maps/stop", Json{{"discard", 1}}).status, 422u);
  const auto made = call("POST", "/maps/stop", Json{{"name", "barn"}});
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(made.raw.header("location"), "/api/v1/maps/1");
  EXPECT_EQ(made.body["name"], "barn");
  EXPECT_EQ(made.body["anchor"]["heading_deg"], 12.0);
  EXPECT_EQ(made.body["in_use"], false);
  ASSERT_EQ(call("POST", "/maps/start").status, 200u);
  EXPECT_EQ(call("POST", "/maps/stop", Json{{"discard", true}}).status, 204u);
  EXPECT_EQ(call("GET", "/maps").body["items"].size(), 1u);
}

class ConfiguredMap : public MapsApi {
 protected:
  ConfiguredMap() : MapsApi(with_a_map()) {}
  ~ConfiguredMap() override { fs::remove_all(folder()); }

  static fs::path folder() {
    static const fs::path kFolder = [] {
      std::string name = (fs::temp_directory_path() / "roverd-hall-XXXXXX").string();
      EXPECT_NE(::mkdtemp(name.data()), nullptr);
      return fs::path(name);
    }();
    return kFolder;
  }
  static Before with_a_map() {
    std::ofstream(folder() / "hall.yaml") << kYaml;
    std::ofstream(folder() / "shed.pgm") << kPicture;
    Before before = seeing();
    before.map = maps::Configured{folder() / "hall.yaml", {}};
    return before;
  }
};

TEST_F(ConfiguredMap, IsListedFirstAndChangedElsewhere) {
  const auto list = call("GET", "/maps").body;
  EXPECT_EQ(list["items"][0]["id"], 0);
  EXPECT_EQ(list["items"][0]["name"], "hall");  // as `place` tells it, and missions name it
  EXPECT_EQ(list["from_configuration"], true);
  EXPECT_EQ(call("DELETE", "/maps/0").status, 409u);
  EXPECT_EQ(call("PATCH", "/maps/0", Json{{"name", "x"}}).status, 409u);
  EXPECT_EQ(call("PATCH", "/maps/00", Json{{"name", "x"}}).status, 404u);  // each has one name
  EXPECT_EQ(call("GET", "/maps/0/cells").status, 200u);
  ASSERT_EQ(add().status, 201u);
  ASSERT_EQ(call("POST", "/maps/1/use").status, 200u);
  EXPECT_EQ(call("GET", "/maps").body["from_configuration"], false);
  ASSERT_EQ(call("POST", "/maps/0/use").status, 200u);
  EXPECT_EQ(call("GET", "/maps").body["from_configuration"], true);
}

class MapsAccess : public AccessApi {};

TEST_F(MapsAccess, WhoMayDoWhatAndWhatIsWrittenDown) {
  const auto add_as = [this](const std::string& who) {
    return call("POST", "/maps", form(kYaml, kPicture), as(who) + kForm).status;
  };
  EXPECT_EQ(add_as("nobody"), 401u);
  EXPECT_EQ(add_as("viewer"), 403u);
  EXPECT_EQ(add_as("operator"), 201u);
  EXPECT_EQ(as("viewer", "GET", "/maps").status, 200u);
  EXPECT_EQ(as("viewer", "GET", "/maps/1/cells").status, 200u);
  EXPECT_EQ(as("viewer", "DELETE", "/maps/1").status, 403u);
  EXPECT_EQ(as("operator", "POST", "/maps/1/use").status, 403u);  // without control
  EXPECT_EQ(as("operator", "PATCH", "/maps/1", Json{{"name", "yard"}}.dump()).status, 200u);
  ASSERT_EQ(as("operator", "POST", "/control/take").status, 200u);
  const auto blind = as("operator", "POST", "/maps/1/use");
  EXPECT_EQ(blind.status, 409u) << "no sensor looks around: " << blind.body;
  EXPECT_EQ(as("operator", "DELETE", "/maps/1").status, 204u);
  const auto rows = as("admin", "GET", "/audit?call=/maps&user=operator").body["items"];
  std::set<std::string> calls;
  for (const Json& row : rows) calls.insert(row["call"]);
  EXPECT_EQ(calls, (std::set<std::string>{"POST /maps", "POST /maps/{id}/use", "PATCH /maps/{id}",
                                          "DELETE /maps/{id}"}));
}

}  // namespace
}  // namespace roverd::test
