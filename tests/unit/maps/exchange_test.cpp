// Maps from map servers and back, and what is no such map.

#include "maps/exchange.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace {

using namespace roverd;

std::string yaml(const std::string& more = "", const std::string& origin = "[-1.5, 2, 0.5]") {
  return "image: elsewhere.pgm\nresolution: 0.5\norigin: " + origin +
         "\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n" + more;
}

/// 2 x 2: on top free and unknown, below occupied and free.
const std::string kPicture =
    std::string("P5\n2 2\n255\n") + "\xFE\xCD" + std::string(1, '\0') + "\xFE";

std::string problem_of(std::string_view words, std::string_view picture) {
  const auto read = maps::read_upload(words, picture);
  if (read) return "none";
  EXPECT_EQ(read.error().code, base::Code::Invalid);
  return read.error().fields.empty() ? "" : read.error().fields[0].pointer;
}

std::vector<int> cells_of(std::string_view words, std::string_view picture) {
  const auto read = maps::read_upload(words, picture);
  if (!read) return {};
  return {read->map.cells().begin(), read->map.cells().end()};
}

TEST(MapUpload, IsReadWithWhatItsYamlSaysBesides) {
  const auto read = maps::read_upload(yaml("mode: trinary\nwritten_by: somebody\n"), kPicture);
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->passed_over, std::vector<std::string>{"written_by"});
  EXPECT_DOUBLE_EQ(read->map.shape().origin.yaw_rad, 0.5);
  EXPECT_EQ(cells_of(yaml(), kPicture), (std::vector<int>{100, 0, 0, -1}));
}

TEST(MapUpload, OfEveryKindOfPictureIsTheSame) {
  const std::vector<int> cells{100, 0, 0, -1};
  EXPECT_EQ(cells_of(yaml(), "P2 # by hand\n2 2 # and so on\n255\n254 205\n0 254\n"), cells);
  EXPECT_EQ(cells_of(yaml(), std::string("P5 2 2 510\n\x01\xFC\x01\x36", 15) +
                                 std::string("\0\0\x01\xFC", 4)),
            cells);  // 508, 310 (p 0.39: unknown), 0, 508 of 510
  std::string negated = yaml();
  negated.replace(negated.find("negate: 0"), 9, "negate: 1");
  EXPECT_EQ(cells_of(negated, "P2 2 2 255 1 50 255 1"), cells);
  EXPECT_EQ(cells_of(yaml("mode: raw\n"), "P2 2 2 255 0 101 100 37"),
            (std::vector<int>{100, 37, 0, -1}));
  EXPECT_EQ(cells_of(yaml("mode: scale\n"), "P2 1 1 255 147"), std::vector<int>{50});
}

TEST(MapUpload, ThatCannotBeIsNamedByFileAndPlace) {
  EXPECT_EQ(problem_of("image: a.pgm\n", kPicture), "/yaml/resolution");
  EXPECT_EQ(problem_of(yaml("", "[0, 0]"), kPicture), "/yaml/origin");
  EXPECT_EQ(problem_of(yaml("", "[0, .nan, 0]"), kPicture), "/yaml/origin");
  EXPECT_EQ(problem_of("resolution: 0.05\n", kPicture), "/yaml/image");
  EXPECT_EQ(problem_of("{", kPicture).substr(0, 6), "/yaml/");
  EXPECT_EQ(problem_of("", kPicture), "/yaml/line 1");
  EXPECT_EQ(problem_of(yaml("mode: colours\n"), kPicture), "/yaml/mode");
  EXPECT_EQ(problem_of(yaml("resolution: 0.1\n"), kPicture), "/yaml/resolution");
  EXPECT_EQ(problem_of(yaml(), "GIF89a").substr(0, 11), "/image/byte");
  EXPECT_EQ(problem_of(yaml(), kPicture.substr(0, 12)), "/image/byte 12");
  EXPECT_EQ(problem_of(yaml(), kPicture + "x"), "/image/byte 15");
  EXPECT_EQ(problem_of(yaml(), "P5 10000 10000 255 "), "/image/size");  // not a byte is set aside
  EXPECT_EQ(problem_of(yaml(), "P5 999999999 999999999 255 "), "/image/size");
  EXPECT_EQ(problem_of(yaml(), "P5 1 40001 255 " + std::string(40001, ' ')), "/image");
}

TEST(MapExport, ReadsAsTheMapThatItIsOf) {
  for (const char* words : {"", "mode: raw\n", "mode: scale\n"}) {
    const auto read = maps::read_upload(yaml(words), "P2 3 2 255 0 60 100 204 206 255");
    ASSERT_TRUE(read) << read.error().detail;
    const auto picture = maps::exported_pgm(read->map, {});
    ASSERT_TRUE(picture);
    const std::string text = maps::exported_yaml(read->map, {}, "map-1.pgm");
    const auto again = maps::read_upload(text, *picture);
    ASSERT_TRUE(again) << again.error().detail;
    EXPECT_TRUE(std::ranges::equal(again->map.cells(), read->map.cells())) << words;
    EXPECT_EQ(again->map.shape().origin.x_m, -1.5);
    EXPECT_NE(text.find("image: map-1.pgm\n"), std::string::npos);
  }
}

TEST(MapExport, TellsNameAndAnchorAsComments) {
  const auto read = maps::read_upload(yaml(), kPicture);
  maps::About about;
  about.name = "shed";
  EXPECT_TRUE(maps::exported_yaml(read->map, about, "a.pgm").starts_with("# name: shed\nimage: "));
  about.anchor = maps::Anchor{{58.378, 26.729}, 45.5, 0.25, 1.0};
  const std::string text = maps::exported_yaml(read->map, about, "a.pgm");
  EXPECT_TRUE(
      text.starts_with("# name: shed\n# anchor_lat: 58.378\n# anchor_lon: 26.729\n"
                       "# anchor_heading_deg: 45.5\n# anchor_accuracy_m: 0.25\n"
                       "# anchor_heading_accuracy_deg: 1\nimage: a.pgm\n"))
      << text;
  EXPECT_TRUE(maps::read_upload(text, *maps::exported_pgm(read->map, {})));
}

TEST(MapExport, IsReadBackWithNameAndAnchor) {
  // Given: a map with both, as another program may have passed it on: with a mark, CRLF and more.
  const auto read = maps::read_upload(yaml(), kPicture);
  maps::About about;
  about.name = "shed: the \u00f6ld one";
  about.anchor = maps::Anchor{{58.37802, -26.7289}, 45.5, 0.25, 2.0};
  std::string text =
      "\xEF\xBB\xBF# written by somebody\r\n\r\n" + maps::exported_yaml(read->map, about, "a.pgm");
  // When
  const auto again = maps::read_upload(text, kPicture);
  // Then
  ASSERT_TRUE(again) << again.error().detail;
  EXPECT_EQ(again->name, about.name);
  ASSERT_TRUE(again->anchor);
  EXPECT_EQ(again->anchor->at.lat, 58.37802);
  EXPECT_EQ(again->anchor->at.lon, -26.7289);
  EXPECT_EQ(again->anchor->heading_deg, 45.5);
  EXPECT_EQ(again->anchor->accuracy_m, 0.25);
  EXPECT_EQ(again->anchor->heading_accuracy_deg, 2.0);
  EXPECT_TRUE(again->passed_over.empty());
}

TEST(MapExport, AnAnchorThatCannotBeIsToldAndLeftOut) {
  const auto reads = [](const std::string& comments) {
    const auto read = maps::read_upload(comments + yaml(), kPicture);
    EXPECT_TRUE(read) << comments;
    EXPECT_FALSE(read->anchor) << comments;
    return read->passed_over;
  };
  using Names = std::vector<std::string>;
  const std::string place = "# anchor_lat: 58\n# anchor_lon: 26\n";
  EXPECT_EQ(reads("# a map: of somebody\n#\n###\n# :\n"), Names{});
  EXPECT_EQ(reads(place), Names{"# anchor_heading_deg"});
  EXPECT_EQ(reads(place + "# anchor_heading_deg: north\n"), Names{"# anchor_heading_deg"});
  EXPECT_EQ(reads(place + "# anchor_heading_deg: nan\n"), Names{"# anchor_heading_deg"});
  EXPECT_EQ(reads(place + "# anchor_heading_deg: 9\n# anchor_accuracy_m: -1\n"),
            Names{"# anchor_accuracy_m"});
  EXPECT_EQ(reads(place + "# anchor_heading_deg: 9\n# anchor_lat: 58\n"), Names{"# anchor_lat"});
  EXPECT_EQ(reads("# anchor_lat: 91\n"),
            (Names{"# anchor_lat", "# anchor_lon", "# anchor_heading_deg"}));
  // Behind the first word it is of somebody else.
  const auto below = maps::read_upload(yaml(place + "# anchor_heading_deg: 9\n"), kPicture);
  ASSERT_TRUE(below);
  EXPECT_FALSE(below->anchor);
  EXPECT_EQ(below->name, "");
}

TEST(MapExport, DrawsWhatIsForbidden) {
  const auto read = maps::read_upload(yaml("", "[0, 0, 0]"), kPicture);
  const auto picture = maps::exported_pgm(read->map, {{{0.5, 0}, {1, 0}, {1, 1}, {0.5, 1}}});
  EXPECT_EQ(cells_of(yaml(), *picture), (std::vector<int>{100, 100, 0, 100}));
}

}  // namespace
