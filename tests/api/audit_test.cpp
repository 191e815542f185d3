// Who did what, as it is written down and read.

#include "access_house.hpp"

namespace roverd::test {
namespace {

class AuditApi : public AccessApi {
 protected:
  /// Newest first.
  Json rows(const std::string& filter = "") {
    const Reply reply = as("admin", "GET", "/audit?limit=1000" + filter);
    EXPECT_EQ(reply.status, 200u) << reply.raw.body;
    return reply.body.value("items", Json::array());
  }
  static std::vector<std::string> in_short(const Json& rows) {
    std::vector<std::string> out;
    for (const Json& row : rows) {
      const std::string user = row["user"].is_null() ? "-" : row["user"].get<std::string>();
      out.push_back(user + " " + row["call"].get<std::string>() + " " +
                    std::to_string(row["status"].get<int>()) + " x" +
                    std::to_string(row["times"].get<int>()));
    }
    return out;
  }
};
using Rows = std::vector<std::string>;

TEST_F(AuditApi, TellsWhoChangedWhatFromWhereAndWithWhichAnswer) {
  EXPECT_EQ(as("operator", "POST", "/control/take").status, 200u);
  EXPECT_EQ(as("operator", "POST", "/missions", R"({"name":"north","items":[]})").status, 201u);
  EXPECT_EQ(as("token of operator", "DELETE", "/missions/none", "").status, 428u);
  EXPECT_EQ(as("viewer", "GET", "/missions").status, 200u);
  const Json all = rows();
  EXPECT_EQ(in_short(all),
            (Rows{"admin DELETE /missions/{id} 428 x1", "operator POST /missions 201 x1",
                  "operator POST /control/take 200 x1", "operator CONTROL taken 200 x1"}));
  const Json& token = all[0];
  EXPECT_EQ(token["credential"].get<std::string>().substr(0, 6), "token ");
  EXPECT_EQ(token["address"], "127.0.0.1");
  EXPECT_EQ(token["target"], "/api/v1/missions/none");
  EXPECT_EQ(all[1]["credential"].get<std::string>().substr(0, 8), "session ");
  EXPECT_EQ(all[1]["detail"], nullptr);
  EXPECT_FALSE(all[1]["time"].is_null());
  EXPECT_EQ(in_short(rows("&call=/control")), Rows{"operator POST /control/take 200 x1"});
  EXPECT_EQ(rows("&refused=true").size(), 1u);
  EXPECT_TRUE(rows("&user=viewer").empty());
  EXPECT_TRUE(rows("&from=2190-01-01T00:00:00Z").empty());
}

TEST_F(AuditApi, HasEveryLogInAndNeverWhatWasTyped) {
  const auto log_in = [&](const std::string& user, const std::string& password) {
    return call("POST", "/session", Json{{"user", user}, {"password", password}}).status;
  };
  EXPECT_EQ(log_in("admin", "wrong horse"), 401u);
  EXPECT_EQ(log_in("correct horse", "admin"), 401u);  // in the wrong field
  EXPECT_EQ(log_in("viewer", kPassword), 200u);
  EXPECT_EQ(as("admin", "GET", "/audit?call=/session&user=admin&cursor=9999").status, 200u);
  const Json all = rows();
  EXPECT_EQ(in_short(all), (Rows{"viewer POST /session 200 x1", "- POST /session 401 x1",
                                 "admin POST /session 401 x1"}));
  EXPECT_EQ(all.dump().find("horse"), std::string::npos);
  EXPECT_EQ(all[2]["detail"], "user or password is wrong");
}

TEST_F(AuditApi, CountsWhatIsRefusedAgainAndAgain) {
  for (int i = 0; i < 50; ++i) (void)as("viewer", "POST", "/vehicle/arm", "{}");
  for (int i = 0; i < 20; ++i) (void)as("forged token", "GET", "/vehicle");
  (void)raw("GET /api/v1/vehicle HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  const Json all = rows();
  EXPECT_LE(all.size(), 8u) << all.dump(1);
  int armed = 0;
  int read = 0;
  for (const Json& row : all) {
    if (row["call"] == "POST /vehicle/arm" && row["user"] == "viewer")
      armed += row["times"].get<int>();
    if (row["call"] == "GET /vehicle" && row["status"] == 401) read += row["times"].get<int>();
  }
  EXPECT_EQ(armed, 50);
  EXPECT_EQ(read, 20);
}

TEST_F(AuditApi, CountsStopsAndStreamsTooSoThatNobodyFillsTheDiskWithThem) {
  for (int i = 0; i < 50; ++i) (void)as("nobody", "POST", "/vehicle/estop");
  for (int i = 0; i < 30; ++i) {
    Client viewer(house.port());
    ASSERT_EQ(viewer.upgrade("/api/v1/stream", as("viewer")), 101u);
  }
  const Json all = rows();
  EXPECT_LE(all.size(), 6u) << all.dump(1);
  int stops = 0;
  for (const Json& row : all) {
    if (row["call"] == "POST /vehicle/estop") stops += row["times"].get<int>();
  }
  EXPECT_EQ(stops, 50);
}

TEST_F(AuditApi, TellsEachThingThatWasDoneAndCountsTheSameDoneAgain) {
  for (int i = 0; i < 40; ++i) (void)as("viewer", "DELETE", "/sessions");
  for (int i = 0; i < 3; ++i)
    (void)as("operator", "POST", "/missions", R"({"name":"a","items":[]})");
  EXPECT_EQ(as("operator", "DELETE", "/runs/7").status, 404u);
  int ended = 0;
  const Json all = rows();
  EXPECT_LE(all.size(), 6u) << all.dump(1);
  for (const Json& row : all) {
    if (row["call"] == "DELETE /sessions") ended += row["times"].get<int>();
  }
  EXPECT_EQ(ended, 40);
}

TEST_F(AuditApi, HasStreamsAndTheStopsOnThem) {
  Client viewer(house.port());
  ASSERT_EQ(viewer.upgrade("/api/v1/stream", as("token of viewer")), 101u);
  viewer.send_frame(1, R"({"estop":true})");
  Client nobody(house.port());
  EXPECT_EQ(nobody.upgrade("/api/v1/stream"), 401u);
  until([this] { return rows("&call=STREAM").size() == 1; }, "the stop is written down");
  EXPECT_EQ(in_short(rows()), (Rows{"- GET /stream 401 x1", "admin STREAM estop 202 x1",
                                    "admin GET /stream 101 x1"}));
}

TEST_F(AuditApi, IsTakenAwayAsAFileAndChecked) {
  (void)as("operator", "POST", "/missions", R"({"name":"=1+1","items":[]})");
  (void)as("nobody", "POST", "/vehicle/estop");
  const Reply csv = as("admin", "GET", "/audit/export");
  ASSERT_EQ(csv.status, 200u);
  EXPECT_EQ(csv.raw.header("content-type"), "text/csv; charset=utf-8");
  EXPECT_EQ(csv.raw.body.substr(0, csv.raw.body.find('\r')),
            "id,time,user,credential,address,call,target,status,detail,times,hash");
  EXPECT_NE(csv.raw.body.find(",127.0.0.1,POST /vehicle/estop,/api/v1/vehicle/estop,200,,1,"),
            std::string::npos)
      << csv.raw.body;
  const Reply lines = as("admin", "GET", "/audit/export?format=jsonl&after=1");
  ASSERT_EQ(lines.status, 200u);
  EXPECT_EQ(Json::parse(lines.raw.body)["id"], 2);  // one line
  const Json check = as("admin", "GET", "/audit/check").body;
  EXPECT_EQ(check["whole"], true);
  EXPECT_EQ(check["rows"], 2);
  EXPECT_EQ(check["hash"], Json::parse(lines.raw.body)["hash"]);
  EXPECT_EQ(as("admin", "GET", "/audit/export?format=xml").status, 422u);
  EXPECT_EQ(as("admin", "GET", "/audit?from=yesterday").status, 422u);
  EXPECT_EQ(as("admin", "GET", "/audit?cursor=x").status, 400u);
}

class AuditWithoutAccess : public HouseTest {};

TEST_F(AuditWithoutAccess, IsKeptTooAndBeginsEmpty) {
  EXPECT_EQ(call("GET", "/audit").body["items"], Json::array());
  EXPECT_EQ(call("GET", "/audit/check").body["last"], nullptr);
  make_mission();
  const Json row = call("GET", "/audit").body["items"][0];
  EXPECT_EQ(row["call"], "POST /missions");
  EXPECT_EQ(row["user"], nullptr);
  EXPECT_EQ(row["address"], "127.0.0.1");
}

}  // namespace
}  // namespace roverd::test
