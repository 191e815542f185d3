// Nothing may delay a stop: what costs much is done beside the web thread, within bounds.

#include <thread>

#include <poll.h>

#include "house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;

constexpr int kMany = 50'000;

/// A LineString of so many points.
std::string line_file(int points) {
  std::string out = R"({"type":"Feature","properties":{},"geometry":{"type":"LineString",)"
                    R"("coordinates":[)";
  for (int i = 0; i < points; ++i) {
    if (i > 0) out += ',';
    out +=
        '[' + std::to_string(26.7 + 1e-5 * i) + ',' + std::to_string(58.3 + 1e-5 * (i % 97)) + ']';
  }
  return out + "]}}";
}

class BusyApi : public HouseTest {
 protected:
  std::unique_ptr<Client> begin_import(const std::string& file) {
    auto client = std::make_unique<Client>(house.port());
    client->send(
        "POST /api/v1/missions/import?name=line HTTP/1.1\r\nHost: 127.0.0.1\r\n"
        "Content-Length: " +
        std::to_string(file.size()) + "\r\n\r\n" + file);
    return client;
  }
  static bool has_answer(const Client& client) {
    pollfd look{client.handle(), POLLIN, 0};
    return ::poll(&look, 1, 0) > 0;
  }
};

TEST_F(BusyApi, AStopIsCarriedOutAndAnsweredWhileLargeFilesAreRead) {
  until_ready();
  // Given four large files on their way in,
  const std::string file = line_file(20'000);
  std::vector<std::unique_ptr<Client>> imports;
  for (int i = 0; i < 4; ++i) imports.push_back(begin_import(file));
  // when somebody stops the robot, and asks for small things,
  EXPECT_EQ(call("POST", "/vehicle/estop").status, 200u);
  EXPECT_EQ(call("GET", "/vehicle").body["estop"], true);
  const std::string id = make_mission();
  // then that is done before the large ones are (one after the other, they take seconds),
  EXPECT_FALSE(has_answer(*imports.back()));
  EXPECT_FALSE(has_answer(*imports[2]));
  // and they are done as well.
  for (auto& client : imports) {
    const auto answer = client->answer();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 201u) << answer->body.substr(0, 300);
  }
  EXPECT_EQ(call("GET", "/missions/" + id).status, 200u);
}

TEST_F(BusyApi, BeyondItsBoundLargeWorkIsRefusedAndNothingIsDone) {
  const std::string file = line_file(10'000);
  std::vector<std::unique_ptr<Client>> imports;
  for (int i = 0; i < 40; ++i) imports.push_back(begin_import(file));
  std::size_t taken = 0;
  for (auto& client : imports) {
    const auto answer = client->answer();
    ASSERT_TRUE(answer);
    if (answer->status == 201u) {
      ++taken;
      continue;
    }
    EXPECT_EQ(answer->status, 503u);
    EXPECT_EQ(answer->header("retry-after"), "1");
    EXPECT_NE(answer->body.find("nothing was done"), std::string::npos);
  }
  EXPECT_GE(taken, net::Workers::kLargeWaiting);
  EXPECT_LT(taken, imports.size());
  EXPECT_EQ(call("GET", "/missions").body["items"].size(), taken);
  // Afterwards there is room again.
  EXPECT_EQ(begin_import(file)->answer()->status, 201u);
}

TEST_F(BusyApi, AnOwnExportLargerThanADocumentComesInAgain) {
  const auto first = begin_import(line_file(kMany))->answer();
  ASSERT_TRUE(first);
  ASSERT_EQ(first->status, 201u);
  const std::string place = first->header("location").substr(std::string("/api/v1").size());
  const auto file =
      raw("GET /api/v1" + place + "/export?format=plan HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  ASSERT_EQ(file.status, 200u);
  EXPECT_GT(file.raw.body.size(), 8u * 1024 * 1024);
  const auto again = begin_import(file.raw.body)->answer();
  ASSERT_TRUE(again);
  ASSERT_EQ(again->status, 201u) << again->body.substr(0, 300);
  EXPECT_NE(again->body.find("\"taken\":" + std::to_string(kMany)), std::string::npos);
}

TEST_F(BusyApi, ACommandHasASmallBodyAndADocumentALargerOne) {
  const auto of = [this](const std::string& path, std::size_t bytes) {
    return raw("POST /api/v1" + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: " +
               "application/json\r\nContent-Length: " + std::to_string(bytes) + "\r\n\r\n");
  };
  const Reply command = of("/vehicle/arm", 64 * 1024 + 1);
  EXPECT_EQ(command.status, 413u);
  EXPECT_NE(command.body["detail"].get<std::string>().find("65536"), std::string::npos);
  EXPECT_EQ(of("/missions", 8 * 1024 * 1024 + 1).status, 413u);
  EXPECT_EQ(of("/missions/import", 64 * 1024 * 1024 + 1).status, 413u);
}

/// Only the web thread may let go of a connection: what the thread sanitizer would tell.
TEST_F(BusyApi, AClientThatLeavesBeforeItsAnswerDisturbsNobody) {
  until([this] { return call("GET", "/vehicle").status == 200; }, "a first state");
  // Given commands whose clients do not wait for the answer,
  for (int i = 0; i < 100; ++i) {
    Client hasty(house.port());
    EXPECT_TRUE(hasty.send(
        "POST /api/v1/vehicle/disarm HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n\r\n"));
  }
  // then the next one is served as ever: what stops is not refused for the others.
  EXPECT_EQ(call("POST", "/vehicle/disarm").status, 200u);
}

TEST_F(BusyApi, AStopStopsWhateverItsBodyIsAndHoweverOftenItIsSaid) {
  until([this] { return call("GET", "/vehicle").status == 200; }, "a first state");
  EXPECT_EQ(call("POST", "/vehicle/estop", "{ no JSON", "Content-Type: text/plain\r\n").status,
            200u);
  const auto stopped = [this] { return call("GET", "/vehicle").body["estop"].get<bool>(); };
  EXPECT_TRUE(stopped());
  // The same key gives no old answer in the place of a stop.
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(call("POST", "/vehicle/estop/reset", Json{{"valid_for_s", 5}}).status, 200u);
    ASSERT_FALSE(stopped());
    EXPECT_EQ(call("POST", "/vehicle/estop", "", "Idempotency-Key: stop\r\n").status, 200u);
    EXPECT_TRUE(stopped());
  }
}

}  // namespace
}  // namespace roverd::test
