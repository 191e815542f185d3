// Receivers that go bad while the robot drives, and bad starts: what is wrong is named and counted,
// and the estimate stays with the true pose.

#include <cstdio>
#include <functional>
#include <string>

#include "figures.hpp"

namespace roverd::loop {
namespace {

using Fields = std::vector<std::string>;
/// Changes one sentence; the first field is its address, "GNGGA".
using Change = std::function<void(Fields&)>;

Fields split(const std::string& body) {
  Fields out(1);
  for (const char c : body) {
    if (c == ',') {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

std::string sentence_of(const Fields& fields) {
  std::string body;
  for (const auto& f : fields) body += (body.empty() ? "" : ",") + f;
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char tail[8];
  std::snprintf(tail, sizeof tail, "*%02X\r\n", sum);
  return "$" + body + tail;
}

bool is_kind(const Fields& f, const char* kind) {
  return f[0].size() == 5 && f[0].substr(2) == kind;
}

/// From now on the receiver's sentences go through `change`.
void tamper(Rig& rig, Change change) {
  rig.plant.on_gnss = [hear = rig.plant.on_gnss, change](base::Bytes bytes, Time t) {
    const std::string text(bytes.begin(), bytes.end());
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
      const auto end = text.find('\n', at);
      const auto star = text.find('*', at);
      Fields fields = split(text.substr(at + 1, star - at - 1));
      change(fields);
      out += sentence_of(fields);
      at = end == std::string::npos ? text.size() : end + 1;
    }
    hear({reinterpret_cast<const std::uint8_t*>(out.data()), out.size()}, t);
  };
}

std::uint64_t refused(const Rig& rig, base::Refusal why) {
  return rig.state()->estimator.refusals[static_cast<std::size_t>(why)];
}
/// What the driver counted, by its words.
std::uint64_t counted(const Rig& rig, const std::string& what) {
  for (const auto& d : rig.state()->drivers) {
    if (d.name != "gnss" || !d.detail) continue;
    const auto at = d.detail->counts.find(what);
    return at == d.detail->counts.end() ? 0 : at->second;
  }
  return 0;
}

/// Largest error of the position while the time passes.
double worst_error_m(Rig& rig, double seconds) {
  double worst_m = 0.0;
  for (int i = 0; i < seconds * 50.0; ++i) {
    rig.tick();
    worst_m = std::max(worst_m, rig.position_error_m());
  }
  return worst_m;
}

/// On its way north for 60 m, with 8 m behind it.
struct Underway {
  Rig rig{field_of(3)};
  Underway() {
    rig.arm_and_start(rig.plan_of({{0, 30}, {0, 60}}));
    drive_on(rig, 8.0);
  }
};

TEST(BadStart, FiveMetresAsideOfTheRouteItComesBackToIt) {
  Rig rig(field_of(2));
  rig.arm_and_start(rig.plan_of({{5, 4}, {5, 24}}));
  ASSERT_TRUE(rig.finish(120.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({5, 4}), 0.4);
  EXPECT_LT(rig.distance_to_m({5, 24}), 0.3);
}

TEST(BadStart, ACompassWrongByHalfATurnIsFoundOut) {
  RigOptions o = field_of(2);
  o.plant.compass.bias_deg = 175.0;
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({{0, 20}}));
  ASSERT_TRUE(rig.holds_until_a_person_looked(90.0)) << rig.state()->mission.reason;
  EXPECT_LT(std::abs(rig.yaw_error_deg()), 3.0);
  ASSERT_TRUE(rig.finish(150.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.distance_to_m({0, 20}), 0.3);
}

TEST(BadReceiver, ZeroZeroWithAFixIsNeverFused) {
  Underway u;
  tamper(u.rig, [](Fields& f) {
    const std::size_t at = is_kind(f, "GGA") ? 2 : is_kind(f, "RMC") ? 3 : 0;
    if (at == 0) return;
    f[at] = "0000.0000000";
    f[at + 2] = "00000.0000000";
  });
  EXPECT_LT(worst_error_m(u.rig, 6.0), 0.25);
  EXPECT_GT(counted(u.rig, "position 0, 0") + refused(u.rig, base::Refusal::Zero), 10u);
}

/// @param date of RMC: ddmmyy.
void expect_date_is_named(const std::string& date) {
  Underway u;
  tamper(u.rig, [&](Fields& f) {
    if (is_kind(f, "RMC")) f[9] = date;
  });
  EXPECT_LT(worst_error_m(u.rig, 6.0), 0.25) << date;
  EXPECT_GT(counted(u.rig, "impossible date") + refused(u.rig, base::Refusal::Date), 10u) << date;
  EXPECT_EQ(u.rig.state()->estimator.resets, 0u);
}

TEST(BadReceiver, ADateOfNineteenEightyIsNamed) {
  expect_date_is_named("060180");
}

TEST(BadReceiver, AWeekRolloverIsNamed) {
  expect_date_is_named("121006");  // 1024 weeks before the simulator's day
}

TEST(BadReceiver, ALeapSecondMovesNothing) {
  Underway u;
  std::optional<double> midnight_s;
  const auto time_of = [](const std::string& t) {
    return 3600.0 * std::stod(t.substr(0, 2)) + 60.0 * std::stod(t.substr(2, 2)) +
           std::stod(t.substr(4));
  };
  // The clock reads 23:59:60 from two seconds on for one second, and is one behind after it.
  tamper(u.rig, [&](Fields& f) {
    if (!is_kind(f, "GGA") && !is_kind(f, "RMC") && !is_kind(f, "GST")) return;
    const double s = time_of(f[1]);
    if (!midnight_s) midnight_s = s + 2.0;
    const double after_s = s - *midnight_s;
    const double clock_s = after_s < 0.0   ? 86'400.0 + after_s
                           : after_s < 1.0 ? 86'400.0 + after_s
                                           : after_s - 1.0;
    const bool leap = clock_s >= 86'400.0;
    const double shown_s = leap ? clock_s - 86'400.0 + 60.0 : clock_s;
    const int hours = leap ? 23 : static_cast<int>(shown_s / 3600.0);
    const int minutes = leap ? 59 : static_cast<int>(shown_s / 60.0) % 60;
    const double seconds = leap ? shown_s : shown_s - 3600.0 * hours - 60.0 * minutes;
    char text[16];
    std::snprintf(text, sizeof text, "%02d%02d%05.2f", hours, minutes, seconds);
    f[1] = text;
    if (is_kind(f, "RMC")) f[9] = after_s < 1.0 ? "310526" : "010626";
  });
  EXPECT_LT(worst_error_m(u.rig, 10.0), 0.25);
  EXPECT_EQ(u.rig.state()->estimator.resets, 0u);
  EXPECT_LT(std::abs(u.rig.yaw_error_deg()), 2.0);
  EXPECT_LT(u.rig.state()->estimator.free_m, 1.0) << "positions are used again";
}

TEST(BadReceiver, AnotherTalkerInTheMiddleIsTheSameReceiver) {
  Underway u;
  const auto before = u.rig.state()->estimator.rejected;
  tamper(u.rig, [](Fields& f) { f[0].replace(0, 2, "GP"); });
  EXPECT_LT(worst_error_m(u.rig, 10.0), 0.1);
  EXPECT_EQ(u.rig.state()->estimator.rejected, before);
  EXPECT_EQ(u.rig.state()->estimator.resets, 0u);
}

/// North by so many metres.
void shift_north(Fields& f, double north_m) {
  const std::size_t at = is_kind(f, "GGA") ? 2 : is_kind(f, "RMC") ? 3 : 0;
  if (at == 0) return;
  const double minutes = std::stod(f[at].substr(2)) + north_m / 1855.0;
  char text[24];
  std::snprintf(text, sizeof text, "%s%010.7f", f[at].substr(0, 2).c_str(), minutes);
  f[at] = text;
}

TEST(BadReceiver, AnAntennaThatChangesItsPlaceIsAJumpUntilItStays) {
  Underway u;
  tamper(u.rig, [](Fields& f) { shift_north(f, 1.5); });
  EXPECT_LT(worst_error_m(u.rig, 5.0), 0.5);
  EXPECT_GT(refused(u.rig, base::Refusal::Jump) + refused(u.rig, base::Refusal::Outvoted), 10u);
  EXPECT_TRUE(u.rig.has_condition("sensor_left_out"));
  EXPECT_EQ(u.rig.execution(), ExecutionState::Running);
  u.rig.run(12.0);
  EXPECT_TRUE(u.rig.has_condition("base_moved")) << "whoever steers is asked";
  EXPECT_EQ(u.rig.execution(), ExecutionState::Paused);
  ASSERT_TRUE(u.rig.ask(robot::SettleShift{false}));
  u.rig.run(1.0);
  EXPECT_NEAR(u.rig.position_error_m(), 1.5, 0.2) << "it is where the receiver says, from then on";
}

TEST(BadReceiver, TwoThatMeanPlacesFiftyMetresApartAreNamedAndNoneIsFused) {
  Underway u;
  bool other = false;
  tamper(u.rig, [&](Fields& f) {
    if (is_kind(f, "GGA")) other = !other;
    if (other) shift_north(f, 50.0);
  });
  EXPECT_LT(worst_error_m(u.rig, 6.0), 0.5);
  EXPECT_TRUE(u.rig.state()->estimator.receivers_disagree);
  EXPECT_GT(refused(u.rig, base::Refusal::Receivers), 10u);
  EXPECT_EQ(u.rig.state()->estimator.resets, 0u);
}

}  // namespace
}  // namespace roverd::loop
