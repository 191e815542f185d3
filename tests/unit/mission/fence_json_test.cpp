// A fence in the words of the public interface.

#include "mission/fence/fence_json.hpp"

#include <gtest/gtest.h>

namespace roverd::mission {
namespace {

constexpr const char* kGood = R"({"name": "Põld", "areas": [
  {"kind": "inclusion", "polygon": [{"lat": 58.0, "lon": 26.0}, {"lat": 58.0, "lon": 26.01},
                                    {"lat": 58.01, "lon": 26.01}]},
  {"kind": "exclusion", "circle": {"lat": 58.001, "lon": 26.002, "radius_m": 12.5}}],
  "rally": [{"lat": 58.002, "lon": 26.003, "alt_m": 60}, {"lat": 58.0, "lon": 26.0}]})";

TEST(FenceJson, SurvivesARoundTrip) {
  const auto fence = fence_from_text(kGood);

  ASSERT_TRUE(fence) << fence.error().detail;
  EXPECT_EQ(fence->areas.size(), 2u);
  EXPECT_EQ(std::get<FenceCircle>(fence->areas[1].shape).radius_m, 12.5);
  EXPECT_EQ(fence->rally.at(0).alt_m, 60.0);
  EXPECT_EQ(fence_from_json(fence_to_json(*fence)).value(), *fence);
}

/// The first pointer of what is wrong after a change of the good one.
std::string wrong_with(const char* pointer, const nlohmann::json& value) {
  auto text = nlohmann::json::parse(kGood);
  text[nlohmann::json::json_pointer(pointer)] = value;
  const auto fence = fence_from_json(text);
  if (fence) return "taken";
  return fence.error().fields.empty() ? fence.error().detail : fence.error().fields[0].pointer;
}

TEST(FenceJson, NamesEveryMemberThatCannotBe) {
  EXPECT_EQ(wrong_with("/name", 5), "/name");
  EXPECT_EQ(wrong_with("/extra", 5), "/extra");
  EXPECT_EQ(wrong_with("/areas", 5), "/areas");
  EXPECT_EQ(wrong_with("/areas", nlohmann::json::array_t(101, 5)), "/areas");
  EXPECT_EQ(wrong_with("/areas/0", nullptr), "/areas/0");
  EXPECT_EQ(wrong_with("/areas/0/kind", "both"), "/areas/0/kind");
  EXPECT_EQ(wrong_with("/areas/0/circle", {{"lat", 0}}), "/areas/0/polygon");
  EXPECT_EQ(wrong_with("/areas/0/polygon", nlohmann::json::array()), "/areas/0/polygon");
  EXPECT_EQ(wrong_with("/areas/0/polygon/1", "x"), "/areas/0/polygon/1");
  EXPECT_EQ(wrong_with("/areas/0/polygon/1/lat", 1e308), "/areas/0/polygon/1/lat");
  EXPECT_EQ(wrong_with("/areas/0/polygon/1/lat", nullptr), "/areas/0/polygon/1/lat");
  EXPECT_EQ(wrong_with("/areas/1/circle/radius_m", -1), "/areas/1/circle/radius_m");
  EXPECT_EQ(wrong_with("/areas/1/circle/size", 1), "/areas/1/circle/size");
  EXPECT_EQ(wrong_with("/rally/0/alt_m", 1e9), "/rally/0/alt_m");
  EXPECT_EQ(wrong_with("/rally/1/lon", 500), "/rally/1/lon");
  EXPECT_EQ(fence_from_text("[]").error().fields.at(0).pointer, "");
}

}  // namespace
}  // namespace roverd::mission
