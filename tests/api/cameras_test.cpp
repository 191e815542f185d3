// Pictures over the interface, from a camera that a test plays.

#include "house.hpp"

namespace roverd::test {
namespace {

base::PicturePtr picture_of(std::uint64_t count, base::Duration age) {
  auto out = std::make_shared<base::Picture>();
  out->camera = "front";
  out->stamp = base::steady_now() - age;
  out->count = count;
  out->width = 640;
  out->height = 480;
  out->jpeg = {0xFF, 0xD8, static_cast<std::uint8_t>(count), 0xFF, 0xD9};
  return out;
}

std::string header_of(const Answer& answer, const std::string& name) {
  return answer.header(name);
}

class CamerasApi : public HouseTest {};

TEST_F(CamerasApi, ACameraIsListedWithItsAgeAndGivesItsNewestPicture) {
  until([&] { return house.snapshot() != nullptr; }, "the first tick");
  Json listed = call("GET", "/cameras").body["items"];
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0]["name"], "front");
  EXPECT_TRUE(listed[0]["age_s"].is_null());
  EXPECT_EQ(call("GET", "/cameras/front/snapshot").status, 503U) << "none came yet";
  house.shows(picture_of(7, std::chrono::milliseconds(2500)));
  listed = call("GET", "/cameras").body["items"];
  EXPECT_EQ(listed[0]["width"], 640);
  EXPECT_GE(listed[0]["age_s"].get<double>(), 2.5);
  const auto got = call("GET", "/cameras/front/snapshot");
  EXPECT_EQ(got.status, 200U);
  EXPECT_EQ(got.raw.body, std::string("\xFF\xD8\x07\xFF\xD9", 5)) << "as it came";
  EXPECT_EQ(header_of(got.raw, "picture-count"), "7");
  // A camera that hangs: what it gave last is as old as it is.
  EXPECT_GE(std::stoi(header_of(got.raw, "picture-age-ms")), 2500);
}

TEST_F(CamerasApi, WhoHasTheNewestPictureHearsItsAgeOnly) {
  until([&] { return house.snapshot() != nullptr; }, "the first tick");
  house.shows(picture_of(8, std::chrono::milliseconds(1200)));
  const auto same = call("GET", "/cameras/front/snapshot?after=8");
  EXPECT_EQ(same.status, 204U);
  EXPECT_TRUE(same.raw.body.empty());
  EXPECT_GE(std::stoi(header_of(same.raw, "picture-age-ms")), 1200);
  EXPECT_EQ(call("GET", "/cameras/front/snapshot?after=7").status, 200U);
  EXPECT_EQ(call("GET", "/cameras/front/snapshot?after=9").status, 200U)
      << "a camera that began anew";
}

TEST_F(CamerasApi, WhatThereIsNotIsRefused) {
  until([&] { return house.snapshot() != nullptr; }, "the first tick");
  EXPECT_EQ(call("GET", "/cameras/back/snapshot").status, 404U);
  const auto odd = call("GET", "/cameras/front/snapshot?divisor=3&after=x");
  EXPECT_EQ(odd.status, 422U);
  EXPECT_EQ(odd.body["errors"].size(), 2U) << odd.body;
  EXPECT_EQ(call("POST", "/cameras/front/snapshot").status, 405U);
}

}  // namespace
}  // namespace roverd::test
