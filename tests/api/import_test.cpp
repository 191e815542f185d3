// POST /missions/import with files that become several missions, a fence, or areas; and forms.

#include "house.hpp"

namespace roverd::test {
namespace {

class ImportApi : public HouseTest {
 protected:
  Reply send(const std::string& file, const std::string& query = "",
             const std::string& type = "application/octet-stream") {
    return call("POST", "/missions/import" + query, file, "Content-Type: " + type + "\r\n");
  }
  std::size_t stored(const std::string& what) {
    return call("GET", "/" + what).body["items"].size();
  }
};

std::string track(const std::string& name, double lat) {
  const auto point = [](double at) {
    return "<trkpt lat=\"" + std::to_string(at) + "\" lon=\"26.7\"/>";
  };
  return "<trk><name>" + name + "</name><trkseg>" + point(lat) + point(lat + 0.001) +
         "</trkseg></trk>\n";
}

TEST_F(ImportApi, TracksThatAreNotConnectedAreMissionsOfTheirOwn) {
  const auto made = send("<gpx version=\"1.1\">\n" + track("north", 58.4) + track("south", 57.0) +
                             track("north", 58.6) + "</gpx>",
                         "?name=day.gpx");
  ASSERT_EQ(made.status, 201u);
  const Json& missions = made.body["missions"];
  ASSERT_EQ(missions.size(), 3u);
  EXPECT_EQ(missions[0]["name"], "day: north");
  EXPECT_EQ(missions[1]["name"], "day: south");
  EXPECT_EQ(missions[2]["name"], "day: north (2)");
  // The first one is told whole, as the only one is.
  EXPECT_EQ(made.body["mission"]["id"], missions[0]["id"]);
  EXPECT_EQ(made.raw.header("location"),
            "/api/v1/missions/" + missions[0]["id"].get<std::string>());
  for (const Json& mission : missions) {
    const auto read = call("GET", "/missions/" + mission["id"].get<std::string>());
    ASSERT_EQ(read.status, 200u);
    EXPECT_EQ(read.body["items"].size(), 2u);
    EXPECT_LT(read.body["length_m"], 120.0);
  }
  const Json& report = made.body["report"];
  ASSERT_EQ(report.size(), 6u);
  EXPECT_EQ(report[2]["mission"], 2);
  EXPECT_EQ(report[2]["item"], 1);
  EXPECT_EQ(report[2]["outcome"], "changed");
  EXPECT_EQ(made.body["changed"], 2);
}

TEST_F(ImportApi, AFenceAloneIsKeptAsAFenceAndAreasAreOfferedForASurvey) {
  const auto fence = send(
      "QGC WPL 110\n0\t0\t3\t5003\t25\t0\t0\t0\t58.378\t26.7289\t0\t1\n"
      "1\t0\t3\t5100\t0\t0\t0\t0\t58.3781\t26.729\t0\t1\n",
      "?name=yard.waypoints");
  ASSERT_EQ(fence.status, 201u);
  EXPECT_TRUE(fence.body["mission"].is_null());
  EXPECT_TRUE(fence.body["missions"].empty());
  const auto kept = call("GET", "/fences/" + fence.body["fence_id"].get<std::string>());
  ASSERT_EQ(kept.status, 200u);
  EXPECT_EQ(kept.body["name"], "yard");
  EXPECT_EQ(stored("missions"), 0u);

  const auto area = send(
      R"({"type":"Polygon","coordinates":[[[26.728,58.378],[26.729,58.378],[26.729,58.3785],[26.728,58.378]]]})");
  ASSERT_EQ(area.status, 200u);
  EXPECT_TRUE(area.body["mission"].is_null());
  ASSERT_EQ(area.body["areas"].size(), 1u);
  const auto survey = call("POST", "/missions/survey",
                           Json{{"polygon", area.body["areas"][0]["polygon"]}, {"spacing_m", 2.0}});
  ASSERT_EQ(survey.status, 200u);
  EXPECT_GT(survey.body["covered_share"], 0.9);
  EXPECT_EQ(stored("missions"), 0u);
}

TEST_F(ImportApi, NothingToDriveIsRefusedAndNothingIsKept) {
  const auto reply = send("QGC WPL 110\n0\t1\t3\t22\t0\t0\t0\t0\t58.378\t26.7289\t5\t1\n");
  EXPECT_EQ(reply.status, 422u);
  EXPECT_NE(reply.body["detail"].get<std::string>().find("nothing to drive"), std::string::npos);
  // a fence that is fine beside a mission that is not
  const auto both = send(
      "QGC WPL 110\n0\t0\t3\t5003\t25\t0\t0\t0\t58.378\t26.7289\t0\t1\n"
      "1\t0\t3\t16\t0\t0\t0\t0\t158.3781\t26.729\t0\t1\n");
  EXPECT_EQ(both.status, 422u);
  EXPECT_EQ(both.body["errors"][0]["pointer"], "line 3");
  EXPECT_EQ(stored("missions"), 0u);
  EXPECT_EQ(stored("fences"), 0u);
}

TEST_F(ImportApi, ARefusedFileSaysWhatCouldBeTakenAndThatIsTakenWhenAsked) {
  const std::string file = "lat,lon\n58.378,26.7289\n95,26.729\n58.3785,26.729\n";
  const auto refused = send(file, "?name=field.csv");
  ASSERT_EQ(refused.status, 422u);
  EXPECT_EQ(refused.body["errors"][0]["pointer"], "line 3");
  EXPECT_EQ(refused.body["rest"], (Json{{"taken", 2}, {"changed", 0}, {"left_out", 1}}));
  EXPECT_EQ(stored("missions"), 0u);

  const auto made = send(file, "?name=field.csv&wrong=leave_out");
  ASSERT_EQ(made.status, 201u);
  EXPECT_EQ(made.body["mission"]["items"].size(), 2u);
  EXPECT_EQ(made.body["left_out"], 1);
  EXPECT_EQ(made.body["report"][1]["row"], "line 3");
  EXPECT_NE(made.body["report"][1]["reason"].get<std::string>().find("is 95"), std::string::npos);

  // Where nothing would be left, or the wish is no word of ours, there is no rest.
  const auto none = send("lat,lon\n95,26.729\n");
  EXPECT_EQ(none.status, 422u);
  EXPECT_FALSE(none.body.contains("rest"));
  EXPECT_FALSE(send("lat,lon\n95,26.729\n", "?wrong=leave_out").body.contains("rest"));
  EXPECT_EQ(send(file, "?wrong=maybe").status, 422u);
}

TEST_F(ImportApi, AFormIsTakenAsCurlSendsIt) {
  // As `curl -F file=@"field 1.csv" -F format=csv` sends it.
  const std::string border = "------------------------d74496d66958873e";
  const std::string file = "lat,lon\r\n58.378,26.7289\r\n58.3785,26.729\r\n";
  const std::string form =
      "--" + border +
      "\r\nContent-Disposition: form-data; name=\"file\"; filename=\"field 1.csv\"\r\n"
      "Content-Type: text/csv\r\n\r\n" +
      file + "\r\n--" + border +
      "\r\nContent-Disposition: form-data; name=\"format\"\r\n\r\ncsv\r\n--" + border + "--\r\n";
  const std::string type = "multipart/form-data; boundary=" + border;
  const auto made = send(form, "", type);
  ASSERT_EQ(made.status, 201u);
  EXPECT_EQ(made.body["mission"]["name"], "field 1");
  EXPECT_EQ(made.body["mission"]["items"].size(), 2u);

  EXPECT_EQ(send(form.substr(0, form.size() / 2), "", type).status, 400u);
  EXPECT_EQ(send(form, "", "multipart/form-data").status, 400u);
  EXPECT_EQ(send(form, "?format=fence2", type).status, 422u);
  EXPECT_EQ(stored("missions"), 1u);
}

TEST_F(ImportApi, AFormatThatIsReadAloneIsNotWritten) {
  const std::string id = make_mission();
  const auto reply = call("GET", "/missions/" + id + "/export?format=fence");
  EXPECT_EQ(reply.status, 422u);
}

}  // namespace
}  // namespace roverd::test
