#include "badge/badge.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace roverd::badge {
namespace {

/// WCAG 2.1, relative luminance of "#rrggbb".
double luminance(std::string_view rgb) {
  const double weights[] = {0.2126, 0.7152, 0.0722};
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const int byte = std::stoi(std::string(rgb.substr(1 + 2 * i, 2)), nullptr, 16);
    const double c = byte / 255.0;
    sum += weights[i] * (c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return sum;
}

TEST(Badge, WhiteStandsOutOnEveryColourAndNoneIsThereTwice) {
  std::set<std::string_view> names;
  std::set<std::string_view> values;
  for (const Colour& colour : kColours) {
    EXPECT_GE(1.05 / (luminance(colour.rgb) + 0.05), 4.5) << colour.name;
    names.insert(colour.name);
    values.insert(colour.rgb);
  }
  EXPECT_EQ(names.size(), kColours.size());
  EXPECT_EQ(values.size(), kColours.size());
}

TEST(Badge, TheNameChoosesTheColourWhereNobodyDoes) {
  EXPECT_EQ(colour_of("pink", "kask")->name, "pink");
  EXPECT_EQ(colour_of("", "kask")->name, colour_of("", "kask")->name);
  EXPECT_NE(colour_of("", "kask")->name, colour_of("", "kask-2")->name);
  std::set<std::string_view> seen;
  for (char c = 'a'; c <= 'z'; ++c) seen.insert(colour_of("", std::string("robot ") + c)->name);
  EXPECT_EQ(seen.size(), kColours.size());
  const auto wrong = colour_of("red", "kask");
  ASSERT_FALSE(wrong);
  EXPECT_TRUE(wrong.error().detail.starts_with("must be one of blue, green"))
      << wrong.error().detail;
}

TEST(Badge, ANameIsOneLineOfText) {
  for (const char* good : {"", "kask", "Põllu robot 2", "žuk", "机器人", "🚜"})
    EXPECT_TRUE(check_name(good)) << good;
  for (const std::string& bad :
       {std::string("two\nlines"), std::string("\xff"), std::string("\xc3"), std::string("a\x7f"),
        std::string(" a"), std::string("a "), std::string(41, 'x'), std::string("a\0b", 3)}) {
    EXPECT_FALSE(check_name(bad)) << bad;
  }
}

TEST(Badge, TheLabelIsADnsName) {
  for (const auto& [name, label] : {std::pair{"kask", "kask"},
                                    {"Põllu robot 2", "pollu-robot-2"},
                                    {"ŽUK", "zuk"},
                                    {"--a//b--", "a-b"},
                                    {"机器人", "robot"},
                                    {"", "robot"},
                                    {"\xff", "robot"}}) {
    EXPECT_EQ(label_of(name), label) << name;
  }
  EXPECT_EQ(label_of(std::string(70, 'a')).size(), 50U);
  EXPECT_EQ(label_of(std::string(49, 'a') + " b"), std::string(49, 'a'));
}

TEST(Badge, InitialsAreOfTwoWordsOrTheFirstTwoLetters) {
  for (const auto& [name, letters] : {std::pair{"kask", "KA"},
                                      {"Kask 2", "K2"},
                                      {"north-field tractor", "NF"},
                                      {"k", "K"},
                                      {"", "R"},
                                      {"õun", "õU"}}) {
    EXPECT_EQ(initials_of(name), letters) << name;
  }
}

TEST(Badge, APictureIsServedAsWhatItIs) {
  const auto png = picture_of("\x89PNG\r\n\x1a\nrest");
  ASSERT_TRUE(png);
  const Badge badge{"kask", kColours[1], std::make_shared<const Picture>(*png)};
  EXPECT_EQ(picture_path(badge), "/robot.png");
  EXPECT_EQ(file_at("/robot.png", badge)->content_type, "image/png");
  EXPECT_EQ(file_at("/robot.png", badge)->body, png->bytes);
  EXPECT_FALSE(file_at("/robot.jpg", badge));
  EXPECT_EQ(picture_of("\xFF\xD8\xFF\xE0")->path, "/robot.jpg");
  EXPECT_EQ(picture_of("RIFF....WEBPVP8 ")->path, "/robot.webp");
  // A drawing can hold scripts.
  for (const char* other : {"", "<svg", "GIF89a", "RIFF....WAVE"})
    EXPECT_FALSE(picture_of(other)) << other;
}

TEST(Badge, WithoutAPictureItIsDrawn) {
  const Badge badge{"<& x", kColours[1]};
  EXPECT_EQ(picture_path(badge), "/robot.svg");
  EXPECT_FALSE(file_at("/robot.png", badge));
  const std::string svg = file_at("/robot.svg", Badge{"kask", kColours[1]})->body;
  EXPECT_NE(svg.find("fill=\"#146c2e\""), std::string::npos) << svg;
  EXPECT_NE(svg.find(">KA</text>"), std::string::npos) << svg;
}

TEST(Badge, OnAHomeScreenTheRobotHasItsOwnNameAndPicture) {
  const auto file = file_at("/roverd.webmanifest", Badge{R"(Anna's "kask" \ 2)", kColours[1]});
  ASSERT_TRUE(file);
  EXPECT_EQ(file->content_type, "application/manifest+json");
  EXPECT_EQ(file->body, R"({"name":"Anna's \"kask\" \\ 2","short_name":"Anna's \"kask\" \\ 2",)"
                        R"("start_url":"/","display":"standalone","background_color":"#f3f1ea",)"
                        R"("theme_color":"#146c2e",)"
                        R"("icons":[{"src":"/robot.svg","sizes":"any","type":"image/svg+xml"}]})"
                        "\n");
  const auto png = picture_of("\x89PNG\r\n\x1a\nrest");
  const auto shown = manifest_of({"kask", kColours[1], std::make_shared<const Picture>(*png)});
  EXPECT_NE(shown.find(R"("src":"/robot.png","sizes":"any","type":"image/png")"),
            std::string::npos);
}

}  // namespace
}  // namespace roverd::badge
