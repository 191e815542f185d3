// What the guard stops, as scripts and pages see it, and how a hand overrides it.

#include <algorithm>

#include "house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;

Before seeing() {
  Before before;
  before.sees = before.demands = true;
  return before;
}

class GuardedApi : public HouseTest {
 protected:
  GuardedApi() : HouseTest(House::Vehicle::Whole, seeing()) {}

  /// All is free but a wall 0.7 m ahead of the vehicle's middle, 0.2 m before its nose.
  void look() {
    auto s = std::make_shared<robot::Surroundings>();
    s->patch.stamp = base::steady_now();
    s->patch.side = 200;
    s->patch.x0 = s->patch.y0 = -100;
    s->patch.cells.assign(200 * 200, {nav::sense::Known::Free, 0, 0});
    for (std::size_t y = 0; y < 200; ++y) {
      s->patch.cells[y * 200 + 114].known = nav::sense::Known::Occupied;
    }
    base::SensorState state;
    state.name = "front";
    state.kind = "sick";
    state.health = blind ? base::SensorHealth::Blind : base::SensorHealth::Good;
    state.reason = blind ? "its window is blocked" : "";
    state.seen = s->seen = base::steady_now();
    s->sensors = std::make_shared<const std::vector<base::SensorState>>(1, state);
    house.see(std::move(s));
  }

  static Json stick(double speed_mps, bool deadman, bool override_guard) {
    Json drive = {{"speed_mps", speed_mps}, {"yaw_rate_dps", 0}, {"deadman", deadman}};
    if (override_guard) drive["override_guard"] = true;
    return {{"drive", std::move(drive)}};
  }
  static void say(Client& client, const Json& message) { client.send_frame(1, message.dump()); }

  /// Pushes until `claim` holds of GET /vehicle, which is judged by the document.
  Json push(Client& client, bool override_guard, const std::function<bool(const Json&)>& claim) {
    Json seen;
    until(
        [&] {
          look();
          say(client, stick(0.5, true, override_guard));
          seen = call("GET", "/vehicle").body["obstacle"];
          return claim(seen);
        },
        "the guard is as it should be");
    return seen;
  }

  bool has_event(const std::string& kind) {
    const Json items = call("GET", "/events").body["items"];
    return std::any_of(items.begin(), items.end(),
                       [&](const Json& e) { return e["kind"] == kind; });
  }

  bool blind = false;
};

TEST_F(GuardedApi, AHandIsStoppedSeesWhyAndOverridesWhatStopsIt) {
  // Given a robot in MANUAL with its nose before a wall,
  look();
  until_ready();
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  ASSERT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "MANUAL"}}).status, 200u);
  Client client(house.port());
  ASSERT_EQ(client.upgrade("/api/v1/stream"), 101u);
  until(
      [&] {
        say(client, stick(0.0, false, false));
        std::this_thread::sleep_for(20ms);
        return house.snapshot()->teleop.phase == base::TeleopPhase::Ready;
      },
      "the stick is free");
  // when the stick is pushed against it,
  const auto stops = [](const Json& o) { return o.is_object() && o["action"] == "stop"; };
  const Json o = push(client, false, stops);
  // then it is stopped, and told what by; nothing is to be decided for a hand.
  EXPECT_EQ(o["what"], "obstacle");
  EXPECT_EQ(o["sensor"], "front");
  EXPECT_EQ(o["blocked"], false);
  EXPECT_EQ(o["then"], nullptr);
  EXPECT_EQ(o["decides_in_s"], nullptr);
  EXPECT_GE(o["since_s"], 0.0);
  EXPECT_EQ(house.sent().twist.linear_mps, 0.0);
  // And with the guard held off it creeps.
  push(client, true, [this](const Json& n) {
    const double v = house.sent().twist.linear_mps;
    EXPECT_LT(v, 0.1501);
    return n.is_object() && n["action"] == "overridden" && v > 0.1499;
  });
  until([this] { return has_event("guard_overridden"); }, "the event");
  push(client, false, stops);
  until([this] { return has_event("guard_kept"); }, "its end");
}

TEST_F(GuardedApi, ABlindSensorIsTold) {
  blind = true;
  until(
      [&] {
        look();
        const Json checks = call("GET", "/vehicle/checks").body["checks"];
        return std::any_of(checks.begin(), checks.end(),
                           [](const Json& c) { return c["id"] == "sensors" && c["ok"] == false; });
      },
      "the check fails");
  look();
  const Json health = call("GET", "/health").body;
  const bool told = std::any_of(health["problems"].begin(), health["problems"].end(),
                                [](const Json& p) { return p["id"] == "sensor_blind"; });
  EXPECT_TRUE(told) << health;
  EXPECT_EQ(health["status"], "degraded");
}

}  // namespace
}  // namespace roverd::test
