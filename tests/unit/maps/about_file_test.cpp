// about.json, as it is written and as somebody or a bad disk left it.

#include "maps/about_file.hpp"

#include <string>

#include <gtest/gtest.h>

namespace {

using namespace roverd;
using maps::about_from;
using maps::about_text;
using maps::Kept;

Kept shed() {
  Kept kept;
  kept.about.name = "Schuppen \xC3\xBC";
  kept.about.created = base::kYoungest + std::chrono::milliseconds(1234);
  kept.about.revision = 7;
  kept.about.shape = {380, 320, 0.05, {-5.0, -6.0, 0.1}};
  kept.about.anchor = maps::Anchor{{58.37802, 26.7289}, 91.5, 0.2, 0.7};
  kept.about.forbidden = {{{1.25, 2.0}, {3.0, 2.0}, {3.0, 4.5}}};
  kept.image = "map.7.pgm";
  kept.mode = atlas::MapMode::Raw;
  return kept;
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = about_text(shed());
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string problem_of(const std::string& text) {
  const auto read = about_from(text);
  if (read) return "none";
  return read.error().fields.empty() ? read.error().detail : read.error().fields[0].pointer;
}

TEST(AboutFile, IsReadAsItWasWritten) {
  const auto read = about_from(about_text(shed()));
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->about.name, shed().about.name);
  EXPECT_EQ(read->about.created, shed().about.created);
  EXPECT_EQ(read->about.revision, 7);
  EXPECT_EQ(read->about.shape.rows, 320);
  EXPECT_EQ(read->about.shape.origin.yaw_rad, 0.1);
  EXPECT_EQ(read->about.anchor->heading_deg, 91.5);
  EXPECT_EQ(read->about.anchor->at.lat, 58.37802);
  ASSERT_EQ(read->about.forbidden.size(), 1u);
  EXPECT_EQ(read->about.forbidden[0][2].y_m, 4.5);
  EXPECT_EQ(read->mode, atlas::MapMode::Raw);
  EXPECT_EQ(about_text(*read), about_text(shed()));
}

TEST(AboutFile, OfAMapWithoutAnchorSaysNull) {
  Kept kept = shed();
  kept.about.anchor.reset();
  const auto read = about_from(about_text(kept));
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->about.anchor);
}

TEST(AboutFile, ThatCannotBeIsNamed) {
  EXPECT_EQ(problem_of(""), "is no JSON object");
  EXPECT_EQ(problem_of("[]"), "is no JSON object");
  EXPECT_EQ(problem_of(about_text(shed()).substr(0, 100)), "is no JSON object");
  EXPECT_EQ(problem_of("{}"), "/name");
  EXPECT_EQ(problem_of(with("\"columns\": 380", "\"columns\": 0")), "/columns");
  EXPECT_EQ(problem_of(with("\"columns\": 380", "\"columns\": 1e300")), "/columns");
  EXPECT_EQ(problem_of(with("\"columns\": 380", "\"columns\": \"380\"")), "/columns");
  EXPECT_EQ(problem_of(with("map.7.pgm", "../../key.pem")), "/image");
  EXPECT_EQ(problem_of(with("map.7.pgm", "..")), "/image");
  EXPECT_EQ(problem_of(with("\"raw\"", "\"colours\"")), "/mode");
  EXPECT_EQ(problem_of(with("58.37802", "158.37802")), "/anchor");
  EXPECT_EQ(problem_of(with("1.25", "null")), "/forbidden");
  EXPECT_EQ(problem_of(with("1.25", "1e99")), "/forbidden");
}

}  // namespace
