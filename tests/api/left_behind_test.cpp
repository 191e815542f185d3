// A mission that another life of the program left behind: offered as long as it may be meant.

#include <future>

#include "house.hpp"
#include "mission/json/json.hpp"

namespace roverd::test {
namespace {

class LeftBehindApi : public HouseTest {
 protected:
  LeftBehindApi() : HouseTest(House::Vehicle::Whole, {.data = write, .hasty = true}) {}

  /// A mission under way to its second item when the power went.
  static void write(const std::filesystem::path& file) {
    auto store = store::Store::open(file, [](std::function<void()> answer) { answer(); });
    ASSERT_TRUE(store);
    auto plan = mission::plan_from_text(two_waypoints("left").dump());
    ASSERT_TRUE(plan);
    std::promise<std::string> made;
    (*store)->create_mission(*plan, {"test", ""},
                             [&made](auto stored) { made.set_value(stored->id); });
    left_id_ = made.get_future().get();
    store::StoredPlace place;
    place.mission_id = left_id_;
    place.revision = 1;
    place.name = "left";
    place.item = 2;
    place.items = 2;
    place.place.step = 1;
    place.place.driving = true;
    std::promise<bool> kept;
    (*store)->keep_place(place, [&kept](auto done) { kept.set_value(done.has_value()); });
    ASSERT_TRUE(kept.get_future().get());
  }

  Json offer() { return call("GET", "/execution").body["left_behind"]; }
  void load(const std::string& id) {
    ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
  }
  void until_offered() {
    until([this] { return !offer().is_null(); }, "it is offered");
  }

  static inline std::string left_id_;
  const Json soon_ = {{"valid_for_s", 5}};
};

TEST_F(LeftBehindApi, IsOfferedAndGoneOnWithFromItsPlace) {
  //   Whoever asks in the first moment is told so, and never that there is none.
  for (auto first = call("GET", "/execution"); first.status != 200u;
       first = call("GET", "/execution")) {
    ASSERT_EQ(first.status, 503u) << first.body.dump();
  }
  EXPECT_EQ(offer()["mission_id"], left_id_);
  until_ready();
  EXPECT_EQ(offer()["item"], 2);
  EXPECT_EQ(offer()["items"], 2);
  const auto unarmed = call("POST", "/execution/resume", soon_);
  EXPECT_EQ(unarmed.status, 409u);
  EXPECT_EQ(unarmed.body["detail"], "the robot is not armed");
  EXPECT_FALSE(offer().is_null()) << "a refusal takes nothing away";
  ASSERT_EQ(call("POST", "/vehicle/arm", soon_).status, 200u);
  const auto resumed = call("POST", "/execution/resume", soon_);
  ASSERT_EQ(resumed.status, 200u) << resumed.body.dump();
  EXPECT_EQ(resumed.body["state"], "running");
  EXPECT_EQ(resumed.body["current_item"], 2);
  until([this] { return offer().is_null(); }, "it is in hand");
}

TEST_F(LeftBehindApi, IsNotOfferedWhileAnotherIsLoadedAndNeverAfterOneWasBegun) {
  until_ready();
  until_offered();
  const std::string other = make_mission("other");
  load(other);
  until([this] { return offer().is_null(); }, "another is loaded");
  ASSERT_EQ(call("POST", "/vehicle/arm", soon_).status, 200u);
  EXPECT_EQ(call("POST", "/execution/resume", soon_).status, 409u);
  load(left_id_);
  until_offered();
  load(other);
  Json start = soon_;
  start["mission_id"] = other;
  start["revision"] = 1;
  ASSERT_EQ(call("POST", "/execution/start", start).status, 200u);
  ASSERT_EQ(call("POST", "/execution/stop").status, 200u);
  load(left_id_);
  EXPECT_TRUE(offer().is_null());
}

TEST_F(LeftBehindApi, TheStreamTellsItToo) {
  until_ready();
  until_offered();
  Client client(house.port());
  ASSERT_EQ(client.upgrade("/api/v1/stream"), 101u);
  client.send_frame(1, R"({"subscribe": {"execution": 0, "vehicle": 5}})");
  const auto next = [&client](const std::string& topic) {
    while (const auto frame = client.frame()) {
      if (frame->opcode != 1) continue;
      const Json message = Json::parse(frame->payload);
      if (message["topic"] == topic) return message;
    }
    ADD_FAILURE() << "no message of " << topic;
    return Json();
  };
  (void)next("vehicle");  // the subscription is in force
  load(left_id_);
  const Json message = next("execution");
  EXPECT_EQ(message["data"]["state"], "loaded");
  EXPECT_EQ(message["data"]["left_behind"]["mission_id"], left_id_);
}

}  // namespace
}  // namespace roverd::test
