// Missions over HTTP: every change checked, kept, and refused when somebody else was quicker.

#include <algorithm>
#include <future>

#include "house.hpp"

namespace roverd::test {
namespace {

using MissionsApi = HouseTest;

std::string if_match(const std::string& tag) {
  return "If-Match: " + tag + "\r\n";
}

TEST_F(MissionsApi, AMissionIsCreatedReadReplacedAndDeleted) {
  // Create,
  const auto made = call("POST", "/missions", two_waypoints("north field"));
  ASSERT_EQ(made.status, 201u);
  const std::string id = made.body["id"];
  EXPECT_EQ(made.raw.header("location"), "/api/v1/missions/" + id);
  EXPECT_EQ(made.raw.header("etag"), "\"rev-1\"");
  // read,
  const auto read = call("GET", "/missions/" + id);
  EXPECT_EQ(read.status, 200u);
  EXPECT_EQ(read.body, made.body);
  EXPECT_EQ(call("GET", "/missions/" + id, "", "If-None-Match: \"rev-1\"\r\n").status, 304u);
  // list,
  const auto list = call("GET", "/missions");
  EXPECT_EQ(list.body["items"][0]["name"], "north field");
  EXPECT_EQ(list.body["items"][0]["items"], 2);
  EXPECT_NEAR(list.body["items"][0]["length_m"], 11.7, 0.1);
  // replace,
  Json changed = two_waypoints("north field");
  changed["home"] = {{"lat", 58.0}, {"lon", 26.0}};
  const auto put = call("PUT", "/missions/" + id, changed, if_match("\"rev-1\""));
  EXPECT_EQ(put.status, 200u);
  EXPECT_EQ(put.raw.header("etag"), "\"rev-2\"");
  EXPECT_EQ(put.body["home"]["lat"], 58.0);
  // look back, and go back,
  EXPECT_EQ(call("GET", "/missions/" + id + "/revisions").body["items"].size(), 2u);
  EXPECT_TRUE(call("GET", "/missions/" + id + "/revisions/1").body["home"].is_null());
  const auto back =
      call("POST", "/missions/" + id + "/revert", Json{{"revision", 1}}, if_match("\"rev-2\""));
  EXPECT_EQ(back.status, 200u);
  EXPECT_EQ(back.body["revision"], 3);
  EXPECT_TRUE(back.body["home"].is_null());
  // delete.
  EXPECT_EQ(call("DELETE", "/missions/" + id, "", if_match("\"rev-3\"")).status, 204u);
  EXPECT_EQ(call("GET", "/missions/" + id).status, 404u);
}

TEST_F(MissionsApi, WhatItWasDrawnAsIsKeptWithEachRevisionUntilItemsComeWithoutIt) {
  Json field = two_waypoints("field");
  field["drawing"] = {{"kind", "survey"}, {"wish", {{"spacing_m", 1.5}}}};
  const auto made = call("POST", "/missions", field);
  ASSERT_EQ(made.status, 201u) << made.body.dump();
  const std::string path = "/missions/" + made.body["id"].get<std::string>();
  EXPECT_EQ(made.body["drawing"], field["drawing"]);
  EXPECT_EQ(call("GET", path).body["drawing"], field["drawing"]);
  // Described otherwise, it is still what was drawn; a copy is it, too.
  ASSERT_EQ(call("PATCH", path, Json{{"name", "north"}}, if_match("\"rev-1\"")).status, 200u);
  EXPECT_EQ(call("GET", path).body["drawing"], field["drawing"]);
  const auto copy = call("POST", path + "/copy", Json::object());
  EXPECT_EQ(copy.body["drawing"], field["drawing"]) << copy.body.dump();
  // Other points without a drawing drop it, and so does an operation on them.
  const std::string rev = call("GET", path).raw.header("etag");
  const auto other = call("PUT", path, two_waypoints("by hand"), if_match(rev));
  ASSERT_EQ(other.status, 200u);
  EXPECT_FALSE(other.body.contains("drawing"));
  const auto back =
      call("POST", path + "/revert", Json{{"revision", 1}}, if_match(other.raw.header("etag")));
  EXPECT_EQ(back.body["drawing"], field["drawing"]);
  const auto turned = call("POST", path + "/operations", Json{{"op", "reverse"}},
                           if_match(back.raw.header("etag")));
  ASSERT_EQ(turned.status, 200u) << turned.body.dump();
  EXPECT_FALSE(turned.body.contains("drawing"));
  EXPECT_EQ(call("GET", path + "/revisions/1").body["drawing"], field["drawing"]);
  // No file knows it.
  const std::string files = call("GET", path + "/export?format=geojson").raw.body;
  EXPECT_EQ(files.find("spacing_m"), std::string::npos);
}

TEST_F(MissionsApi, ADrawingThatIsTooLargeOrNoneIsRefusedByName) {
  for (const Json& bad : {Json(5), Json::array(), Json::object(), Json{{"kind", "a field"}},
                          Json{{"kind", "survey"}, {"x", std::string(70'000, 'x')}}}) {
    Json plan = two_waypoints("field");
    plan["drawing"] = bad;
    const auto refused = call("POST", "/missions", plan);
    EXPECT_EQ(refused.status, 422u);
    EXPECT_EQ(refused.body["errors"][0]["pointer"], "/drawing");
  }
  EXPECT_TRUE(call("GET", "/missions").body["items"].empty());
}

TEST_F(MissionsApi, AChangeBasedOnAnOldRevisionIsRefusedWithThePresentOne) {
  // Given two people who read revision 1, of whom one saves first,
  const std::string id = make_mission();
  ASSERT_EQ(call("PUT", "/missions/" + id, two_waypoints("hers"), if_match("\"rev-1\"")).status,
            200u);
  // when the other one saves,
  const auto late = call("PUT", "/missions/" + id, two_waypoints("his"), if_match("\"rev-1\""));
  // then nothing is overwritten and he gets what she saved.
  EXPECT_EQ(late.status, 412u);
  EXPECT_EQ(late.body["current"]["name"], "hers");
  EXPECT_EQ(late.raw.header("etag"), "\"rev-2\"");
  EXPECT_EQ(call("GET", "/missions/" + id).body["name"], "hers");
  EXPECT_EQ(call("DELETE", "/missions/" + id, "", if_match("\"rev-1\"")).status, 412u);
}

TEST_F(MissionsApi, AChangeWithoutItsRevisionIsRefused) {
  const std::string id = make_mission();
  EXPECT_EQ(call("PUT", "/missions/" + id, two_waypoints("x")).status, 428u);
  EXPECT_EQ(call("DELETE", "/missions/" + id).status, 428u);
}

TEST_F(MissionsApi, IfMatchKnowsTheStarListsAndNonsense) {
  const std::string id = make_mission();
  const std::string path = "/missions/" + id;
  EXPECT_EQ(call("PUT", path, two_waypoints("a"), if_match("*")).status, 200u);
  EXPECT_EQ(call("PUT", path, two_waypoints("b"), if_match("\"rev-9\", \"rev-2\"")).status, 200u);
  EXPECT_EQ(call("PUT", path, two_waypoints("c"), if_match("rev-3")).status, 412u);
  EXPECT_EQ(call("PUT", path, two_waypoints("c"), if_match("W/\"rev-3\"")).status, 412u);
  EXPECT_EQ(call("PUT", path, two_waypoints("c"), if_match("\"rev-3000\"")).status, 412u);
  EXPECT_EQ(call("PUT", "/missions/nobody", two_waypoints("c"), if_match("*")).status, 404u);
  EXPECT_EQ(call("PUT", "/missions/nobody", two_waypoints("c"), if_match("\"rev-1\"")).status,
            404u);
}

TEST_F(MissionsApi, EveryWrongFieldIsNamedAndNothingIsStored) {
  // Given a mission with three mistakes,
  Json plan = two_waypoints("bad");
  plan["items"][0]["lat"] = 91;
  plan["items"][1]["lon"] = "east";
  plan["colour"] = "red";
  // when it is sent, then each is named,
  const auto reply = call("POST", "/missions", plan);
  EXPECT_EQ(reply.status, 422u);
  std::vector<std::string> pointers;
  for (const Json& error : reply.body["errors"]) pointers.push_back(error["pointer"]);
  std::sort(pointers.begin(), pointers.end());
  EXPECT_EQ(pointers, (std::vector<std::string>{"/colour", "/items/0/lat", "/items/1/lon"}));
  // and nothing is there.
  EXPECT_TRUE(call("GET", "/missions").body["items"].empty());
}

TEST_F(MissionsApi, MalformedBodiesAreRefusedAsMalformed) {
  for (const char* body : {"{", "{\"name\": NaN}", "[1,2", "\xff\xff"}) {
    EXPECT_EQ(call("POST", "/missions", std::string(body)).status, 400u) << body;
  }
  EXPECT_EQ(call("POST", "/missions", std::string("{\"name\":\"a\",\"name\":\"b\"}")).status, 422u);
  EXPECT_EQ(call("POST", "/missions", std::string("[]")).status, 422u);
  EXPECT_EQ(call("POST", "/missions", std::string("{\"name\":\"a\",\"items\":[1e999]}")).status,
            422u);
  EXPECT_EQ(call("POST", "/missions", std::string(50'000, '[')).status, 400u);
}

TEST_F(MissionsApi, OnlyJsonIsTakenAsJson) {
  // A foreign page's form can send these without asking.
  const std::string body = two_waypoints("x").dump();
  EXPECT_EQ(call("POST", "/missions", body, "Content-Type: text/plain\r\n").status, 415u);
  EXPECT_EQ(
      call("POST", "/missions", body, "Content-Type: application/x-www-form-urlencoded\r\n").status,
      415u);
}

TEST_F(MissionsApi, ListsArePaged) {
  for (int i = 0; i < 5; ++i) make_mission("m" + std::to_string(i));
  std::vector<std::string> names;
  std::string cursor;
  for (int page = 0; page < 3; ++page) {
    const auto reply =
        call("GET", "/missions?limit=2" + (cursor.empty() ? "" : "&cursor=" + cursor));
    ASSERT_EQ(reply.status, 200u);
    for (const Json& one : reply.body["items"]) names.push_back(one["name"]);
    EXPECT_EQ(reply.body["next_cursor"].is_null(), page == 2);
    if (page < 2) cursor = reply.body["next_cursor"];
  }
  EXPECT_EQ(names, (std::vector<std::string>{"m4", "m3", "m2", "m1", "m0"}));
  EXPECT_EQ(call("GET", "/missions?limit=0").status, 422u);
  EXPECT_EQ(call("GET", "/missions?cursor=nonsense").status, 400u);
}

TEST_F(MissionsApi, ADeletedMissionIsListedAndComesBack) {
  const std::string id = make_mission("lost");
  EXPECT_EQ(call("POST", "/missions/" + id + "/restore", "", if_match("*")).status, 409u);
  ASSERT_EQ(call("DELETE", "/missions/" + id, "", if_match("*")).status, 204u);
  const auto gone = call("GET", "/missions?deleted=true");
  ASSERT_EQ(gone.body["items"].size(), 1u);
  EXPECT_EQ(gone.body["items"][0]["id"], id);
  EXPECT_EQ(gone.body["items"][0]["name"], "lost");
  EXPECT_TRUE(gone.body["items"][0]["deleted_at"].is_string());
  EXPECT_EQ(call("GET", "/missions?deleted=perhaps").status, 422u);
  EXPECT_EQ(call("POST", "/missions/" + id + "/restore").status, 428u);
  EXPECT_EQ(call("POST", "/missions/" + id + "/restore", "", if_match("\"rev-1\"")).status, 412u);
  const auto back = call("POST", "/missions/" + id + "/restore", "", if_match("\"rev-2\""));
  EXPECT_EQ(back.status, 200u);
  EXPECT_EQ(back.raw.header("etag"), "\"rev-3\"");
  EXPECT_EQ(call("GET", "/missions/" + id + "/revisions").body["items"][0]["what"], "restored");
  EXPECT_TRUE(call("GET", "/missions?deleted=true").body["items"].empty());
  EXPECT_EQ(call("POST", "/missions/nobody/restore", "", if_match("*")).status, 404u);
}

TEST_F(MissionsApi, ARevertBasedOnAnOldRevisionIsRefusedWithThePresentOne) {
  const std::string id = make_mission();
  ASSERT_EQ(call("PUT", "/missions/" + id, two_waypoints("hers"), if_match("*")).status, 200u);
  const std::string path = "/missions/" + id + "/revert";
  EXPECT_EQ(call("POST", path, Json{{"revision", 1}}).status, 428u);
  const auto late = call("POST", path, Json{{"revision", 1}}, if_match("\"rev-1\""));
  EXPECT_EQ(late.status, 412u);
  EXPECT_EQ(late.body["current"]["name"], "hers");
  EXPECT_EQ(late.raw.header("etag"), "\"rev-2\"");
}

TEST_F(MissionsApi, NamesTagsAndTheArchiveKeepOrder) {
  const std::string north = make_mission("North field");
  const std::string yard = make_mission("yard");
  const auto tagged =
      call("PATCH", "/missions/" + north, Json{{"tags", {"mow", "farm"}}, {"name", "North Field"}},
           if_match("\"rev-1\""));
  ASSERT_EQ(tagged.status, 200u) << tagged.raw.body;
  EXPECT_EQ(tagged.body["tags"], Json({"farm", "mow"}));
  EXPECT_EQ(tagged.raw.header("etag"), "\"rev-2\"");
  const auto ids = [this](const std::string& query) {
    const auto list = call("GET", "/missions?" + query);
    std::vector<std::string> out;
    for (const Json& one : list.body["items"]) out.push_back(one["id"]);
    return out;
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(ids("name=north%20f"), Ids{north});
  EXPECT_EQ(ids("tag=mow"), Ids{north});
  EXPECT_EQ(ids("tag=mo"), Ids{});
  EXPECT_EQ(call("PATCH", "/missions/" + yard, Json{{"tags", {"farm"}}}, if_match("*")).status,
            200u);
  EXPECT_EQ(call("PATCH", "/missions/" + yard, Json{{"archived", true}}, if_match("*")).status,
            200u);
  EXPECT_EQ(ids(""), Ids{north});
  EXPECT_EQ(ids("archived=true"), Ids{yard});
  const Json farm = {{"tag", "farm"}, {"missions", 1}, {"archived", 1}};
  const Json mow = {{"tag", "mow"}, {"missions", 1}, {"archived", 0}};
  EXPECT_EQ(call("GET", "/tags").body, Json({{"items", {farm, mow}}, {"next_cursor", nullptr}}));
  EXPECT_EQ(call("GET", "/tags?limit=1").body["items"], Json::array({farm}));
  EXPECT_EQ(call("GET", "/tags?limit=1&cursor=farm").body["items"], Json::array({mow}));
  EXPECT_EQ(call("GET", "/tags?limit=0").status, 422u);
  EXPECT_EQ(call("GET", "/missions?archived=true&deleted=true").status, 422u);
  EXPECT_EQ(call("GET", "/missions/" + yard).body["archived"], true);
  // What cannot be, or is based on another state, changes nothing.
  EXPECT_EQ(call("PATCH", "/missions/" + north, Json{{"name", "x"}}).status, 428u);
  EXPECT_EQ(call("PATCH", "/missions/" + north, Json{{"name", "x"}}, if_match("\"rev-1\"")).status,
            412u);
  const auto bad = call("PATCH", "/missions/" + north, Json{{"tags", {"ok", ""}}}, if_match("*"));
  EXPECT_EQ(bad.status, 422u);
  EXPECT_EQ(bad.body["errors"][0]["pointer"], "/tags/1");
  EXPECT_EQ(call("PATCH", "/missions/" + north, Json{{"items", 1}}, if_match("*")).status, 422u);
  // A copy goes its own way.
  const auto copied = call("POST", "/missions/" + north + "/copy");
  EXPECT_EQ(copied.status, 201u);
  EXPECT_EQ(copied.body["name"], "North Field (copy)");
  EXPECT_EQ(copied.body["tags"], Json({"farm", "mow"}));
  EXPECT_EQ(copied.raw.header("location"),
            "/api/v1/missions/" + copied.body["id"].get<std::string>());
  EXPECT_EQ(call("POST", "/missions/" + north + "/copy", Json{{"name", "south"}}).body["name"],
            "south");
  EXPECT_EQ(call("POST", "/missions/nobody/copy").status, 404u);
}

/// A database in which two missions were deleted, 40 days and one day ago.
void with_deleted_missions(const std::filesystem::path& file) {
  const base::WallTime now = base::wall_now();
  for (const auto& [name, days] : {std::pair{"long gone", 40}, {"just gone", 1}}) {
    store::Options options;
    options.clock = [then = now - std::chrono::hours(24 * days)] { return then; };
    const auto at_once = [](const std::function<void()>& work) { work(); };
    const auto store = store::Store::open(file, at_once, options).value();
    mission::Plan plan;
    plan.name = name;
    std::promise<std::string> id;
    store->create_mission(plan, {}, [&](const base::Result<store::StoredMission>& made) {
      id.set_value(made.value().id);
    });
    store->delete_mission(id.get_future().get(), 1, {},
                          [](const base::Result<void>& done) { ASSERT_TRUE(done); });
  }
}

class MissionsOfBefore : public HouseTest {
 protected:
  MissionsOfBefore() : HouseTest(House::Vehicle::Whole, {with_deleted_missions}) {}
};

TEST_F(MissionsOfBefore, ThatWereDeletedTooLongAgoAreForgotten) {
  const Json gone = call("GET", "/missions?deleted=true").body["items"];
  ASSERT_EQ(gone.size(), 1u);
  EXPECT_EQ(gone[0]["name"], "just gone");
  const std::string id = gone[0]["id"];
  EXPECT_EQ(call("POST", "/missions/" + id + "/restore", "", if_match("*")).status, 200u);
  EXPECT_EQ(call("GET", "/missions/" + id).body["name"], "just gone");
}

TEST_F(MissionsApi, TwoRevisionsAreCompared) {
  const std::string id = make_mission("first");
  Json changed = two_waypoints("second");
  changed["home"] = {{"lat", 58.0}, {"lon", 26.0}};
  changed["items"][1]["speed_mps"] = 0.5;
  changed["items"].push_back({{"type", "wait"}, {"seconds", 3}});
  ASSERT_EQ(call("PUT", "/missions/" + id, changed, if_match("\"rev-1\"")).status, 200u);
  const auto found = call("GET", "/missions/" + id + "/compare");
  ASSERT_EQ(found.status, 200u);
  EXPECT_EQ(found.body["from"], 1);
  EXPECT_EQ(found.body["to"], 2);
  EXPECT_EQ(found.body["name"], Json({{"from", "first"}, {"to", "second"}}));
  EXPECT_TRUE(found.body["home"]["from"].is_null());
  EXPECT_TRUE(found.body["settings"].is_null());
  EXPECT_EQ(found.body["changed"], 1);
  EXPECT_EQ(found.body["added"], 1);
  EXPECT_EQ(found.body["unchanged"], 1);
  EXPECT_EQ(found.body["items"][0]["to"]["speed_mps"], 0.5);
  EXPECT_EQ(found.body["items"][1]["change"], "added");
  EXPECT_EQ(found.body["items"][1]["to_item"], 3);
  const auto back = call("GET", "/missions/" + id + "/compare?from=2&to=1");
  EXPECT_EQ(back.body["removed"], 1);
  EXPECT_EQ(call("GET", "/missions/" + id + "/compare?from=0").status, 422u);
  EXPECT_EQ(call("GET", "/missions/" + id + "/compare?from=9").status, 404u);
  EXPECT_EQ(call("GET", "/missions/nobody/compare").status, 404u);
}

TEST_F(MissionsApi, ARepeatedKeyCreatesOnce) {
  const std::string key = "Idempotency-Key: 7f3a\r\n";
  const auto first = call("POST", "/missions", two_waypoints("once"), key);
  const auto again = call("POST", "/missions", two_waypoints("once"), key);
  EXPECT_EQ(first.status, 201u);
  EXPECT_EQ(again.status, 201u);
  EXPECT_EQ(first.body, again.body);
  EXPECT_EQ(call("GET", "/missions").body["items"].size(), 1u);
  EXPECT_EQ(call("POST", "/missions", two_waypoints("other"), key).status, 422u);
}

TEST_F(MissionsApi, AFileIsImportedAccountedForAndExportedAgain) {
  // Given a waypoint file with a home, a point, a camera command,
  const std::string file =
      "QGC WPL 110\r\n"
      "0\t1\t0\t16\t0\t0\t0\t0\t58.3780\t26.7289\t60\t1\r\n"
      "1\t0\t3\t16\t0\t0\t0\t0\t58.3785\t26.7290\t10\t1\r\n"
      "2\t0\t3\t206\t20\t0\t0\t0\t0\t0\t0\t1\r\n";
  // when it is imported,
  const auto made = call("POST", "/missions/import?name=trial%20field.waypoints", file,
                         "Content-Type: application/octet-stream\r\n");
  // then every row is accounted for,
  ASSERT_EQ(made.status, 201u);
  EXPECT_EQ(made.body["format"], "waypoints");
  EXPECT_EQ(made.body["mission"]["name"], "trial field");
  EXPECT_EQ(made.body["mission"]["items"].size(), 1u);
  EXPECT_EQ(made.body["left_out"], 1);
  EXPECT_EQ(made.raw.header("etag"), "\"rev-1\"");
  // and every format gives it back with a name to save it under.
  const std::string path = "/missions/" + made.body["mission"]["id"].get<std::string>();
  for (const char* format : {"waypoints", "plan", "gpx", "kml", "geojson", "csv", "follower"}) {
    const auto out = call("GET", path + "/export?format=" + format);
    ASSERT_EQ(out.status, 200u);
    EXPECT_NE(out.raw.header("content-disposition").find("attachment; filename=\""),
              std::string::npos);
    const auto back =
        call("POST", "/missions/import", out.raw.body, "Content-Type: text/plain\r\n");
    ASSERT_EQ(back.status, 201u) << format;
    EXPECT_NEAR(back.body["mission"]["items"][0]["lat"], 58.3785, 1e-9);
    EXPECT_NEAR(back.body["mission"]["items"][0]["lon"], 26.7290, 1e-9);
  }
}

TEST_F(MissionsApi, AFollowersTableTakesItsOriginFromTheCall) {
  const std::string rows = "x,y,z,yaw,velocity\n0,0,0,0,3.6\n";
  const std::string text = "Content-Type: text/csv\r\n";
  const std::string path = "/missions/import?format=csv";
  const auto lost = call("POST", path, rows, text);
  EXPECT_EQ(lost.status, 422u);
  EXPECT_EQ(lost.body["errors"][0]["pointer"], "line 2");
  const auto made =
      call("POST", path + "&origin_lat=58.378&origin_lon=26.729&speed_unit=kmh", rows, text);
  ASSERT_EQ(made.status, 201u);
  EXPECT_NEAR(made.body["mission"]["items"][0]["lat"], 58.378, 1e-9);
  EXPECT_NEAR(made.body["mission"]["items"][0]["speed_mps"], 1.0, 1e-9);
  EXPECT_EQ(call("POST", path + "&origin_lat=58.378", rows, text).status, 422u);
  EXPECT_EQ(call("POST", path + "&speed_unit=knots", rows, text).status, 422u);
}

TEST_F(MissionsApi, ADownloadKeepsAForeignName) {
  const auto name_for = [this](const std::string& name) {
    const auto made = call("POST", "/missions", two_waypoints(name));
    EXPECT_EQ(made.status, 201u) << name;
    const std::string id = made.body.value("id", "");
    return call("GET", "/missions/" + id + "/export?format=plan").raw.header("content-disposition");
  };
  EXPECT_EQ(name_for("field"), "attachment; filename=\"field.plan\"");
  EXPECT_EQ(name_for("p\xC3\xB5ld \"1/2\""),
            "attachment; filename=\"p_ld_1_2.plan\"; "
            "filename*=UTF-8''p%C3%B5ld%20%221_2%22.plan");
  EXPECT_EQ(name_for("\xE9\xBA\xA6"),
            "attachment; filename=\"mission.plan\"; filename*=UTF-8''%E9%BA%A6.plan");
}

TEST_F(MissionsApi, ABrokenFileNamesItsLineAndMakesNothing) {
  const std::string bad =
      "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t58.3780\t26.7289\t60\t1\n"
      "1\t0\t3\t16\t0\t0\t0\t0\t158.3\t26.7290\t10\t1\n";
  const auto reply = call("POST", "/missions/import", bad, "Content-Type: text/plain\r\n");
  EXPECT_EQ(reply.status, 422u);
  EXPECT_NE(reply.body.dump().find("line 3"), std::string::npos);
  EXPECT_EQ(call("POST", "/missions/import?format=plan", std::string("{\"fileType\":")).status,
            422u);
  EXPECT_EQ(call("POST", "/missions/import?format=shapefile", bad).status, 422u);
  EXPECT_EQ(call("POST", "/missions/import").status, 400u);
  EXPECT_TRUE(call("GET", "/missions").body["items"].empty());
  EXPECT_EQ(call("GET", "/missions/nobody/export?format=plan").status, 404u);
  EXPECT_EQ(call("GET", "/missions/nobody/export").status, 422u);
}

}  // namespace
}  // namespace roverd::test
