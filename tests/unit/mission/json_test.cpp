#include "mission/json/json.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "mission/json/quick_read.hpp"
#include "mission/text.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

using base::Code;
using nlohmann::json;

/// Pointers of what is wrong in a text that must be refused as Invalid.
std::vector<std::string> wrong_in(const std::string& text) {
  const auto plan = plan_from_text(text);
  EXPECT_FALSE(plan) << text;
  if (plan) return {};
  EXPECT_EQ(plan.error().code, Code::Invalid) << plan.error().detail;
  std::vector<std::string> pointers;
  for (const auto& field : plan.error().fields) pointers.push_back(field.pointer);
  return pointers;
}

std::vector<std::string> wrong_in_item(const std::string& item) {
  return wrong_in(R"({"name":"x","items":[{"type":"wait","seconds":1},)" + item + "]}");
}

using Names = std::vector<std::string>;

TEST(PlanJson, EveryItemSurvivesARoundTripThroughBothForms) {
  const Plan plan = plan_with_every_item();
  ASSERT_TRUE(check_plan(plan));
  EXPECT_EQ(plan_from_text(plan_to_text(plan)).value(), plan);
  EXPECT_EQ(plan_from_json(plan_to_json(plan)).value(), plan);
  EXPECT_EQ(plan_from_text(plan_to_json(plan).dump(2)).value(), plan);
}

TEST(PlanJson, ADrawingIsKeptAsItCameAndAPlanWithoutOneHasNone) {
  Plan plan = plan_with_every_item();
  EXPECT_FALSE(plan_to_json(plan).contains("drawing"));
  EXPECT_EQ(plan_to_text(plan).find("drawing"), std::string::npos);
  plan.drawing = {{"kind", "survey"}, {"wish", {{"spacing_m", 0.1}, {"holes", json::array()}}}};
  ASSERT_TRUE(check_plan(plan));
  EXPECT_EQ(plan_from_text(plan_to_text(plan)).value(), plan);
  EXPECT_EQ(plan_from_json(plan_to_json(plan)).value(), plan);
  EXPECT_TRUE(plan_from_text(R"({"name":"x","items":[],"drawing":null})")->drawing.is_null());
}

TEST(PlanJson, ADrawingThatIsNoneIsRefused) {
  const auto with = [](const std::string& drawing) {
    return R"({"name":"x","items":[],"drawing":)" + drawing + "}";
  };
  for (const char* bad :
       {"5", "[]", "\"survey\"", "{}", R"({"kind":5})", R"({"kind":""})", R"({"kind":"A field"})",
        R"({"kind":"aaaaaaaaaabbbbbbbbbbccccccccccddddddddddx"})"}) {
    EXPECT_EQ(wrong_in(with(bad)), Names{"/drawing"}) << bad;
  }
  // To the byte: {"kind":"a","x":"…"} has 19 besides.
  const auto of_bytes = [&](std::size_t bytes) {
    return with(R"({"kind":"a","x":")" + std::string(bytes - 19, 'x') + "\"}");
  };
  EXPECT_TRUE(plan_from_text(of_bytes(kMaxDrawing)));
  EXPECT_EQ(wrong_in(of_bytes(kMaxDrawing + 1)), Names{"/drawing"});
  Plan plan = plan_with_every_item();
  plan.drawing = json::array();
  EXPECT_FALSE(check_plan(plan));
}

TEST(PlanJson, RandomPlansSurviveARoundTripToTheLastBit) {
  RandomPlans plans(20'240'601);
  for (int i = 0; i < 300; ++i) {
    const Plan plan = plans.next(1 + i % 40);
    ASSERT_TRUE(check_plan(plan)) << check_plan(plan).error().detail;
    EXPECT_EQ(plan_from_text(plan_to_text(plan)).value(), plan);
    EXPECT_EQ(plan_from_json(plan_to_json(plan)).value(), plan);
  }
}

TEST(PlanJson, TheShortWayReadsWhatTheLongOneDoes) {
  RandomPlans plans(7);
  int quick_ones = 0;
  for (int i = 0; i < 300; ++i) {
    const Plan plan = plans.next(1 + i % 20);
    const std::string text = i % 2 == 0 ? plan_to_text(plan) : plan_to_json(plan).dump(1);
    const auto quick = quick_plan(text);
    if (!quick) continue;  // an action's arguments, an escape in a name
    ++quick_ones;
    EXPECT_EQ(*quick, plan_from_json(parse_json(text).value()).value());
  }
  EXPECT_GT(quick_ones, 30);
}

TEST(PlanJson, TheShortWayIsLeftForEverythingElse) {
  const std::string good =
      R"({"name":"x","items":[{"type":"waypoint","lat":1.5,"lon":-2e1,"turn":"arc"}]})";
  ASSERT_TRUE(quick_plan(good));
  // Any one byte changed: it is left, or read as the long way reads it.
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const char c : std::string("\"\\0.-+eE,:{}[] x\n\x80")) {
      std::string text = good;
      text[at] = c;
      const auto quick = quick_plan(text);
      if (!quick) continue;
      const auto value = parse_json(text);
      ASSERT_TRUE(value) << text;
      EXPECT_EQ(plan_from_json(*value).value(), *quick) << text;
    }
  }
  for (const char* text : {
           "",
           "{}",
           "{\"name\":\"x\"}",
           "{\"name\":\"x\",\"items\":[]} x",
           R"({"name":"x","items":[{"type":"wait","seconds":01}]})",
           R"({"name":"x","items":[{"type":"wait","seconds":1.}]})",
           R"({"name":"x","items":[{"type":"wait","seconds":inf}]})",
           R"({"name":"x","items":[{"type":"wait","seconds":1e999}]})",
           R"({"name":"x","items":[{"type":"wait","seconds":1,"seconds":2}]})",
           R"({"name":"x","items":[{"type":"wait","seconds":1,"colour":2}]})",
           R"({"name":"x","items":[{"type":"jump","item":1,"times":0}]})",
           R"({"name":"x","name":"y","items":[]})",
           R"({"name":"x","items":[],"id":"y"})",
       }) {
    EXPECT_FALSE(quick_plan(text)) << text;
  }
}

TEST(PlanJson, ForEverMustBeSaid) {
  const auto times = [](const std::string& jump) {
    const auto plan =
        plan_from_text(R"({"name":"x","items":[{"type":"wait","seconds":1},)" + jump + "]}");
    return plan ? std::get<Jump>(plan->items[1]).times : -1;
  };
  EXPECT_EQ(times(R"({"type":"jump","item":1,"times":3})"), 3);
  EXPECT_EQ(times(R"({"type":"jump","item":1,"times":0})"), 0);
  EXPECT_EQ(times(R"({"type":"jump","item":1,"times":"forever"})"), 0);
  EXPECT_EQ(wrong_in_item(R"({"type":"jump","item":1})"), Names{"/items/1/times"});
  EXPECT_EQ(wrong_in_item(R"({"type":"jump","item":1,"times":null})"), Names{"/items/1/times"});
  EXPECT_EQ(wrong_in_item(R"({"type":"jump","item":1,"times":"often"})"), Names{"/items/1/times"});
  EXPECT_EQ(wrong_in_item(R"({"type":"jump","item":2,"times":1})"), Names{"/items/1/item"});
  const auto back_and_forth =
      plan_from_text(R"({"name":"x","settings":{"at_end":"back_and_forth","times":3},"items":[]})");
  EXPECT_EQ(back_and_forth->settings.times, 3);
  EXPECT_EQ(plan_from_text(plan_to_text(*back_and_forth)).value(), *back_and_forth);
  EXPECT_EQ(wrong_in(R"({"name":"x","settings":{"times":-1},"items":[]})"),
            Names{"/settings/times"});
}

TEST(PlanJson, AMissionMayHaveACorridor) {
  const auto of = [](const std::string& metres) {
    return R"({"name":"x","settings":{"corridor_m":)" + metres + R"(},"items":[]})";
  };
  EXPECT_EQ(plan_from_text(of("0.3"))->settings.corridor_m, 0.3);
  EXPECT_EQ(plan_from_text(plan_to_text(*plan_from_text(of("0.3"))))->settings.corridor_m, 0.3);
  EXPECT_EQ(plan_from_text(of("null"))->settings.corridor_m, std::nullopt);
  for (const char* wrong : {"0", "0.04", "101", "-1", "\"0.3\"", "true", "1e999"}) {
    EXPECT_EQ(wrong_in(of(wrong)), Names{"/settings/corridor_m"}) << wrong;
  }
}

TEST(PlanJson, WhatCountsFromAMapSaysFromWhichOne) {
  const std::string point = R"("items":[{"type":"map_point","x_m":1,"y_m":2}]})";
  const auto plan = plan_from_text(R"({"name":"x","frame":{"map":"shed"},)" + point);
  ASSERT_TRUE(plan) << plan.error().detail;
  EXPECT_EQ(plan->frame->map, "shed");
  EXPECT_EQ(plan->items.at(0), Item(MapPoint{.x_m = 1.0, .y_m = 2.0}));
  EXPECT_EQ(wrong_in(R"({"name":"x",)" + point), Names{"/items/0"});
  EXPECT_EQ(wrong_in(R"({"name":"x","frame":{},)" + point), Names{"/frame/map"});
  EXPECT_EQ(wrong_in(R"({"name":"x","frame":"shed",)" + point), Names{"/frame"});
  EXPECT_EQ(wrong_in(R"({"name":"x","frame":{"map":"shed","id":1},)" + point), Names{"/frame/id"});
  Plan bare = *plan;
  bare.frame.reset();
  EXPECT_FALSE(check_plan(bare));
}

TEST(PlanText, IsFoldedForSearching) {
  EXPECT_EQ(folded("Põld ÕUNAAED Žürii ПОЛЕ Ω 100%"), "põld õunaaed žürii поле ω 100%");
  EXPECT_EQ(folded("\xc3\x97\xff\xc3"), "\xc3\x97\xff\xc3");
}

TEST(PlanJson, IsWrittenInTheWordsOfThePublicInterface) {
  Plan plan;
  plan.name = "North";
  Waypoint first = waypoint_at(58.5, 26.25);
  first.turn = Turn::Through;
  plan.items = {first, Jump{1, 3}, ReturnHome{}, TurnBy{90.0, std::nullopt}};
  EXPECT_EQ(plan_to_json(plan), json::parse(R"({
    "name": "North", "settings": {"at_end": "hold"}, "items": [
      {"type": "waypoint", "lat": 58.5, "lon": 26.25, "turn": "through"},
      {"type": "jump", "item": 1, "times": 3},
      {"type": "return_home"},
      {"type": "turn", "turn_deg": 90}]})"));
}

TEST(PlanJson, AnEmptyMissionIsAMission) {
  const auto plan = plan_from_text(R"({"name":"later","items":[]})");
  ASSERT_TRUE(plan);
  EXPECT_TRUE(plan->items.empty());
  EXPECT_EQ(plan->settings, Settings{});
}

TEST(PlanJson, NullStandsForAnAbsentOptionalMember) {
  const auto plan = plan_from_text(
      R"({"name":"x","home":null,"settings":null,
          "items":[{"type":"waypoint","lat":1,"lon":2,"alt_m":null,"hold_s":null,"turn":null}]})");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->items.at(0), Item(waypoint_at(1.0, 2.0)));
}

TEST(PlanJson, WhatIsNotJsonIsMalformedAndSaysWhere) {
  for (const char* text :
       {"", "{", "nonsense", R"({"name":"x",})", R"({"name":"x"} 1)", "{\"a\":\"\xff\"}",
        R"({"name":NaN})", R"({"name":Infinity})", "[1,2", "\"\x01\""}) {
    const auto plan = plan_from_text(text);
    ASSERT_FALSE(plan) << text;
    EXPECT_EQ(plan.error().code, Code::Malformed) << text;
    EXPECT_EQ(plan.error().fields.at(0).pointer.substr(0, 5), "byte ") << text;
  }
  EXPECT_EQ(plan_from_text(R"({"a":x})").error().fields.at(0).pointer, "byte 5");
}

TEST(PlanJson, ErrorsAboutBytesThatAreNotTextAreText) {
  const auto error = plan_from_text("{\"n\xc3\xff").error();
  EXPECT_NO_THROW(json(error.detail).dump());
}

TEST(PlanJson, AMillionBracketsAreRefusedWithoutHarm) {
  for (const std::string& text : {std::string(1'000'000, '['), std::string(1'000'000, '{'), [] {
                                    std::string s;
                                    for (int i = 0; i < 300'000; ++i) s += "{\"a\":";
                                    return s;
                                  }()}) {
    const auto plan = plan_from_text(text);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, Code::Malformed);
  }
  EXPECT_TRUE(parse_json(std::string(32, '[') + std::string(32, ']')));
  EXPECT_FALSE(parse_json(std::string(33, '[') + std::string(33, ']')));
}

TEST(PlanJson, ANumberTooLargeForADoubleIsNamedByPointer) {
  const auto plan = plan_from_text(
      R"({"name":"x","items":[{"type":"waypoint","lat":1,"lon":2},{"type":"waypoint","lat":1e999,"lon":2}]})");
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, Code::Invalid);
  EXPECT_EQ(plan.error().fields.at(0).pointer, "/items/1/lat");
}

TEST(PlanJson, AMemberThatIsThereTwiceIsRefused) {
  EXPECT_EQ(wrong_in(R"({"name":"x","items":[{"type":"wait","seconds":1,"seconds":2}]})"),
            Names{"/items/0/seconds"});
}

TEST(PlanJson, TheWholeMustBeAnObjectWithNameAndItems) {
  EXPECT_EQ(wrong_in("[]"), Names{""});
  EXPECT_EQ(wrong_in("3"), Names{""});
  EXPECT_EQ(wrong_in("{}"), (Names{"/name", "/items"}));
  EXPECT_EQ(wrong_in(R"({"name":3,"items":{}})"), (Names{"/name", "/items"}));
  EXPECT_EQ(wrong_in(R"({"name":null,"items":null})"), (Names{"/name", "/items"}));
  EXPECT_EQ(wrong_in(R"({"name":"x","items":[],"home":[1,2],"settings":"fast"})"),
            (Names{"/home", "/settings"}));
}

TEST(PlanJson, UnknownMembersAreRefusedByPointer) {
  EXPECT_EQ(wrong_in(R"({"name":"x","items":[],"colour":1,"a/b~c":2})"),
            (Names{"/a~1b~0c", "/colour"}));
  EXPECT_EQ(wrong_in_item(R"({"type":"waypoint","lat":1,"lon":2,"speed":1})"),
            Names{"/items/1/speed"});
  EXPECT_EQ(wrong_in(R"({"name":"x","items":[],"home":{"lat":1,"lon":2,"hight":3}})"),
            Names{"/home/hight"});
  EXPECT_EQ(wrong_in(R"({"name":"x","items":[],"settings":{"end":"hold"}})"),
            Names{"/settings/end"});
}

TEST(PlanJson, EveryWrongValueIsNamedAtOnce) {
  EXPECT_EQ(
      wrong_in(R"({"name":"","home":{"lat":-91,"lon":181},"items":[
    {"type":"waypoint","lat":91,"lon":"26","alt_m":20000,"speed_mps":0,"radius_m":101,
     "hold_s":-1,"reverse":1,"turn":"sharp"}, 7, {"kind":"wait"}, {"type":"fly"}]})"),
      (Names{"/name", "/home/lat", "/home/lon", "/items/0/lat", "/items/0/lon", "/items/0/alt_m",
             "/items/0/speed_mps", "/items/0/radius_m", "/items/0/hold_s", "/items/0/reverse",
             "/items/0/turn", "/items/1", "/items/2/type", "/items/3/type"}));
}

TEST(PlanJson, OfManyWrongValuesTheFirstHundredAreNamed) {
  json items = json::array();
  for (int i = 0; i < 500; ++i) items.push_back({{"type", "wait"}, {"seconds", -1}});
  const auto plan = plan_from_json({{"name", "x"}, {"items", items}});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().fields.size(), kMaxFieldErrors);
  EXPECT_NE(plan.error().detail.find("500 wrong values"), std::string::npos);
}

TEST(PlanJson, RangesEndWhereTheyShould) {
  struct Case {
    const char* item;
    bool good;
  };
  for (const Case& c : std::initializer_list<Case>{
           {R"({"type":"waypoint","lat":90,"lon":180})", true},
           {R"({"type":"waypoint","lat":-90,"lon":-180})", true},
           {R"({"type":"waypoint","lat":90.000000001,"lon":0})", false},
           {R"({"type":"waypoint","lat":0,"lon":-180.000000001})", false},
           {R"({"type":"waypoint","lat":0,"lon":0,"speed_mps":10,"radius_m":100,"hold_s":86400})",
            true},
           {R"({"type":"waypoint","lat":0,"lon":0,"speed_mps":10.1})", false},
           {R"({"type":"waypoint","lat":0,"lon":0,"radius_m":0})", false},
           {R"({"type":"local","east_m":0,"north_m":0,"heading_deg":0})", true},
           {R"({"type":"local","east_m":0,"north_m":0,"heading_deg":360})", false},
           {R"({"type":"local","east_m":10000.1,"north_m":0})", false},
           {R"({"type":"local","east_m":1})", false},
           {R"({"type":"move","forward_m":-3})", true},
           {R"({"type":"move"})", false},
           {R"({"type":"turn","turn_deg":-360})", true},
           {R"({"type":"turn","turn_deg":361})", false},
           {R"({"type":"turn","turn_deg":1,"heading_deg":1})", false},
           {R"({"type":"turn"})", false},
           {R"({"type":"turn","turn_deg":null,"heading_deg":null})", false},
           {R"({"type":"wait","seconds":86400.5})", false},
           {R"({"type":"speed","speed_mps":-1})", false},
           {R"({"type":"row","side":"left"})", true},
           {R"({"type":"row","side":"middle"})", false},
           {R"({"type":"row"})", true},
           {R"({"type":"row","side":"both","speed_mps":0.4,"distance_m":80,"seeing":"rays"})",
            true},
           {R"({"type":"row","distance_m":0})", false},
           {R"({"type":"row","until_lat":58.3,"until_lon":26.7})", true},
           {R"({"type":"row","until_lat":58.3})", false},
           {R"({"type":"row","until_lat":91,"until_lon":26.7})", false},
           {R"({"type":"wall","side":"left","distance_m":1,"until_place":"gate"})", true},
           {R"({"type":"wall","side":"left","distance_m":1,"until_place":7})", false},
           {R"({"type":"row","seeing":"camera"})", false},
           {R"({"type":"wall","side":"right","distance_m":20})", true},
           {R"({"type":"wall","side":"right","distance_m":0})", false},
           {R"({"type":"wall","side":"left","distance_m":1,"speed_mps":0.4,"length_m":12})", true},
           {R"({"type":"wall","side":"left","distance_m":1,"length_m":0})", false},
           {R"({"type":"landmarks","name":"cone","offset_m":-0.7})", true},
           {R"({"type":"wall","side":"left"})", true},
           {R"({"type":"landmarks","name":"cone","side":"right","count":3})", true},
           {R"({"type":"landmarks","name":"cone","side":"both"})", false},
           {R"({"type":"landmarks","name":"cone","side":"right","offset_m":0.7})", false},
           {R"({"type":"landmarks","name":"cone"})", false},
           {R"({"type":"landmarks","name":" ","offset_m":0})", false},
           {R"({"type":"landmarks","name":"any","offset_m":0.7,"speed_mps":0.4,"count":5})", true},
           {R"({"type":"landmarks","name":"any","offset_m":0.7,"count":-1})", false},
           {R"({"type":"landmarks","name":"any","offset_m":0.7,"speed_mps":0})", false},
           {R"({"type":"dock","tag":0,"stand_off_m":0.9})", true},
           {R"({"type":"dock","tag":587})", false},
           {R"({"type":"dock","tag":1.5})", false},
           {R"({"type":"dock","stand_off_m":0.9})", false},
           {R"({"type":"jump","item":1,"times":0})", true},
           {R"({"type":"jump","item":2,"times":1})", false},
           {R"({"type":"jump","item":3,"times":1})", false},
           {R"({"type":"jump","item":0,"times":1})", false},
           {R"({"type":"jump","item":1.5,"times":1})", false},
           {R"({"type":"jump","item":1,"times":-1})", false},
           {R"({"type":"jump","item":1e300,"times":1})", false},
           {R"({"type":"jump","item":99999999999999999999,"times":1})", false},
           {R"({"type":"action","name":"spray","level":{"a":[1]}})", true},
           {R"({"type":"action","level":1})", false},
           {R"({"type":"loiter"})", true},
           {R"({"type":"loiter","lat":58,"lon":26,"seconds":5,"radius_m":0.5})", true},
           {R"({"type":"loiter","lat":58})", false},
           {R"({"type":"loiter","lon":26,"lat":null})", false},
           {R"({"type":"loiter","radius_m":0})", false},
           {R"({"type":"circle","lat":58,"lon":26,"radius_m":3})", true},
           {R"({"type":"circle","lat":58,"lon":26,"radius_m":3,"turns":0.5,"clockwise":true})",
            true},
           {R"({"type":"circle","lat":58,"lon":26,"radius_m":3,"turns":0})", false},
           {R"({"type":"circle","lat":58,"lon":26})", false},
           {R"({"type":"circle","lat":58,"lon":26,"radius_m":0.4})", false},
           {R"({"type":"circle","lat":58,"lon":26,"radius_m":3,"stations":37})", false},
           {R"({"type":"return_home","now":true})", false}}) {
    const auto plan = plan_from_text(R"({"name":"x","items":[{"type":"wait","seconds":1},)" +
                                     std::string(c.item) + "]}");
    EXPECT_EQ(plan.has_value(), c.good) << c.item;
    if (plan) continue;
    EXPECT_EQ(plan.error().fields.size(), 1u) << c.item;
  }
}

/// One member of an item (or of home, or the settings), and the values next to its range.
struct Edge {
  const char* item;    ///< a good one, as JSON
  const char* member;  ///< a number of it
  double below;
  double above;
};

TEST(PlanJson, EveryNumberOfEveryItemHasItsRange) {
  const char* waypoint = R"({"type":"waypoint","lat":1,"lon":2})";
  const char* local = R"({"type":"local","east_m":1,"north_m":2})";
  const std::vector<Edge> edges{
      {waypoint, "lat", -90.1, 90.1},
      {waypoint, "lon", -180.1, 180.1},
      {waypoint, "alt_m", -1000.1, 10'000.1},
      {waypoint, "speed_mps", 0.0, 10.1},
      {waypoint, "radius_m", 0.0, 100.1},
      {waypoint, "hold_s", -0.1, 86'400.1},
      {local, "east_m", -10'000.1, 10'000.1},
      {local, "north_m", -10'000.1, 10'000.1},
      {local, "heading_deg", -0.1, 360.0},
      {R"({"type":"move","forward_m":1})", "forward_m", -10'000.1, 10'000.1},
      {R"({"type":"turn","turn_deg":1})", "turn_deg", -360.1, 360.1},
      {R"({"type":"turn","heading_deg":1})", "heading_deg", -0.1, 360.0},
      {R"({"type":"turn","turn_deg":1})", "radius_m", 0.09, 100.1},
      {R"({"type":"wait","seconds":1})", "seconds", -0.1, 86'400.1},
      {R"({"type":"speed","speed_mps":1})", "speed_mps", 0.0, 10.1},
      {R"({"type":"row","side":"left"})", "gap_m", 0.0, 20.1},
      {R"({"type":"wall","side":"left","distance_m":1})", "distance_m", 0.0, 20.1},
      {R"({"type":"landmarks","name":"x","offset_m":1})", "offset_m", -20.1, 20.1},
      {R"({"type":"dock","tag":1})", "tag", -1.0, 587.0},
      {R"({"type":"dock","tag":1})", "stand_off_m", 0.09, 5.1},
      {R"({"type":"jump","item":1,"times":1})", "item", 0.0, 200'001.0},
      {R"({"type":"jump","item":1,"times":1})", "times", -1.0, 10'001.0}};
  for (const Edge& edge : edges) {
    ASSERT_TRUE(item_from_json(json::parse(edge.item), "")) << edge.item;
    for (const json& value : {json(edge.below), json(edge.above), json(1e308), json(-1e308),
                              json(true), json("1"), json::array({1}), json::object()}) {
      json item = json::parse(edge.item);
      item[edge.member] = value;
      const json plan = {{"name", "x"}, {"items", {{{"type", "wait"}, {"seconds", 1}}, item}}};
      EXPECT_EQ(wrong_in(plan.dump()), Names{std::string("/items/1/") + edge.member})
          << plan.dump();
    }
    // What no JSON number is.
    for (const char* word : {"NaN", "Infinity", "-Infinity", "nan", "1e", "0x1", "01", "+1"}) {
      std::string text = edge.item;
      text.pop_back();
      const std::string own = std::string("\"") + edge.member + "\":";
      const std::size_t at = text.find(own);
      if (at != std::string::npos) text.erase(at - 1, text.find_first_of(",}", at) - at + 1);
      text = R"({"name":"x","items":[)" + text + "," + own + word + "}]}";
      const auto plan = plan_from_text(text);
      ASSERT_FALSE(plan) << text;
      EXPECT_EQ(plan.error().code, Code::Malformed) << text;
      EXPECT_TRUE(plan.error().fields.at(0).pointer.starts_with("byte ")) << text;
    }
  }
  const auto wrong_beside = [](const char* group, const char* member, double value) {
    json plan = {{"name", "x"}, {"items", json::array()}, {"home", {{"lat", 1}, {"lon", 2}}}};
    plan[group][member] = value;
    return wrong_in(plan.dump());
  };
  for (const double value : {-1e308, 1e308}) {
    for (const char* member : {"lat", "lon", "alt_m"}) {
      EXPECT_EQ(wrong_beside("home", member, value), Names{std::string("/home/") + member});
    }
    for (const char* member : {"speed_mps", "times"}) {
      EXPECT_EQ(wrong_beside("settings", member, value), Names{std::string("/settings/") + member});
    }
  }
}

TEST(PlanJson, NamesAreTextThatPeopleCanRead) {
  Plan plan;
  const auto problem = [&](std::string name) {
    plan.name = std::move(name);
    const auto ok = check_plan(plan);
    return ok ? std::string() : ok.error().fields.at(0).detail;
  };
  EXPECT_EQ(problem("Põld 1"), "");
  EXPECT_EQ(problem(std::string(200, 'x')), "");
  std::string umlauts;
  for (int i = 0; i < 200; ++i) umlauts += "ü";
  EXPECT_EQ(problem(umlauts), "");
  EXPECT_EQ(problem(umlauts + "u"), "must have at most 200 characters, has 201");
  EXPECT_EQ(problem("  "), "must not be empty");
  EXPECT_EQ(problem(""), "must not be empty");
  EXPECT_EQ(problem("a\nb"), "must not contain control characters");
  EXPECT_EQ(problem(std::string("a\0b", 3)), "must not contain control characters");
  for (const char* broken : {"\xff", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82"}) {
    EXPECT_EQ(problem(broken), "must be valid UTF-8");
  }
}

TEST(PlanJson, APlanMadeInMemoryIsCheckedByTheSameRules) {
  Plan plan = plan_with_every_item();
  std::get<Waypoint>(plan.items[0]).at.lat = std::nan("");
  std::get<Waypoint>(plan.items[0]).speed_mps = std::numeric_limits<double>::infinity();
  std::get<TurnBy>(plan.items[5]).heading_deg = 3.0;
  std::get<Jump>(plan.items[14]).item = 99;
  plan.settings.at_end = static_cast<AtEnd>(9);
  const auto ok = check_plan(plan);
  ASSERT_FALSE(ok);
  Names pointers;
  for (const auto& field : ok.error().fields) pointers.push_back(field.pointer);
  EXPECT_EQ(pointers, (Names{"/settings/at_end", "/items/0/lat", "/items/0/speed_mps",
                             "/items/5/heading_deg", "/items/14/item"}));
  EXPECT_NO_THROW(plan_to_json(plan).dump());
  EXPECT_NO_THROW(plan_to_text(plan));
}

TEST(PlanJson, MoreItemsThanPossibleAreTooLarge) {
  json items = json::array();
  for (std::size_t i = 0; i <= kMaxItems; ++i) items.push_back(nullptr);
  const auto plan = plan_from_json({{"name", "x"}, {"items", std::move(items)}});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, Code::TooLarge);
}

TEST(PlanJson, OneItemIsReadByItself) {
  const auto item = item_from_json({{"type", "wait"}, {"seconds", 3}}, "/item");
  ASSERT_TRUE(item);
  EXPECT_EQ(*item, Item(Wait{3.0}));
  const auto bad = item_from_json({{"type", "wait"}, {"seconds", "3"}}, "/item");
  EXPECT_EQ(bad.error().fields.at(0).pointer, "/item/seconds");
  EXPECT_EQ(item_from_json(7, "/item").error().fields.at(0).pointer, "/item");
}

}  // namespace
}  // namespace roverd::mission
