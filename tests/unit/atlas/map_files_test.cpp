// Maps of ROS's map server: words and picture, both ways, and what is no such map.

#include "atlas/map_files.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace {

using namespace roverd;
using atlas::MapMode;
using atlas::MapWords;
using atlas::Picture;
using nav::chart::CellAt;

constexpr std::string_view kWords =
    "image: shed.pgm\nmode: trinary\nresolution: 0.05\norigin: [-1.5, 2.0, 0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

base::Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string with_line(std::string_view name, std::string_view line) {
  std::string text(kWords);
  const std::size_t begin = text.find(name);
  return text.replace(begin, text.find('\n', begin) - begin, line);
}

std::string problem_of(std::string_view yaml) {
  const auto words = atlas::read_words(yaml);
  if (words) return "none";
  return words.error().fields.empty() ? words.error().detail : words.error().fields[0].pointer;
}

TEST(MapWords, AreReadAndWrittenAsTheyStand) {
  const auto words = atlas::read_words(kWords);
  ASSERT_TRUE(words) << words.error().detail;
  EXPECT_EQ(words->image, "shed.pgm");
  EXPECT_EQ(words->mode, MapMode::Trinary);
  EXPECT_DOUBLE_EQ(words->resolution_m, 0.05);
  EXPECT_DOUBLE_EQ(words->origin.x_m, -1.5);
  EXPECT_DOUBLE_EQ(words->free_thresh, 0.196);
  EXPECT_EQ(atlas::write_words(*words), kWords);
}

TEST(MapWords, NegateIsAnyWordThatYamlHasForTrueAndFalse) {
  for (const char* word : {"1", "true", "True", "TRUE", "yes", "On", "y"}) {
    const auto words = atlas::read_words(with_line("negate", std::string("negate: ") + word));
    ASSERT_TRUE(words) << word;
    EXPECT_TRUE(words->negate) << word;
  }
  for (const char* word : {"0", "false", "False", "no", "NO", "off", "n"}) {
    const auto words = atlas::read_words(with_line("negate", std::string("negate: ") + word));
    ASSERT_TRUE(words) << word;
    EXPECT_FALSE(words->negate) << word;
  }
}

TEST(MapWords, AnOriginInCoordinatesOfACountryIsToldAsSuch) {
  const auto words = atlas::read_words(with_line("origin", "origin: [500000.5, 6470000.25, 0]"));
  ASSERT_FALSE(words);
  EXPECT_EQ(
      words.error().detail,
      "origin must lie within 1000 km of zero: take a corner of the site off coordinates of a "
      "country");
}

TEST(MapWords, OfOlderMapsTakeTheirDefaults) {
  // ROS 1 knew no mode; other programs write other lines, lists over several lines, comments.
  const auto words = atlas::read_words(
      "# by hand\nfree_thresh: 0.196\noccupied_thresh: 6.5e-1\nnegate: 1\norigin:\n  - 0\n  - +1\n"
      "  - 0.5\nresolution: 0.1\nimage: \"my shed.pgm\"\nwritten_by: somebody\n");
  ASSERT_TRUE(words) << words.error().detail;
  EXPECT_EQ(words->mode, MapMode::Trinary);
  EXPECT_TRUE(words->negate);
  EXPECT_DOUBLE_EQ(words->origin.yaw_rad, 0.5);
  EXPECT_DOUBLE_EQ(words->origin.y_m, 1.0);
  EXPECT_EQ(words->image, "my shed.pgm");
  const auto again = atlas::read_words(atlas::write_words(*words));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->image, "my shed.pgm");
  for (const char* name : {"null", "true", "-a.pgm", "k\xC3\xB5mb.pgm", "a: b #c.pgm"}) {
    MapWords odd = *words;
    odd.image = name;
    const auto read = atlas::read_words(atlas::write_words(odd));
    ASSERT_TRUE(read) << name;
    EXPECT_EQ(read->image, name);
  }
}

TEST(MapWords, ThatCannotBeAreNamed) {
  EXPECT_EQ(problem_of(with_line("image", "")), "/image");
  EXPECT_EQ(problem_of(with_line("image", "image: [a, b]")), "/image");
  EXPECT_EQ(problem_of(with_line("image", "image: \xAC\xAC.pgm")), "/image") << "no UTF-8";
  EXPECT_EQ(problem_of(with_line("resolution", "resolution: 0")), "/resolution");
  EXPECT_EQ(problem_of(with_line("resolution", "resolution: .nan")), "/resolution");
  EXPECT_EQ(problem_of(with_line("resolution", "resolution: nan")), "/resolution");
  EXPECT_EQ(problem_of(with_line("origin", "origin: [0, 0]")), "/origin");
  EXPECT_EQ(problem_of(with_line("origin", "origin: [0, nan, 0]")), "/origin");
  EXPECT_EQ(problem_of(with_line("origin", "origin: [0, 1e300, 0]")), "/origin");
  EXPECT_EQ(problem_of(with_line("negate", "negate: maybe")), "/negate");
  EXPECT_EQ(problem_of(with_line("mode", "mode: colourful")), "/mode");
  EXPECT_EQ(problem_of(with_line("occupied_thresh", "occupied_thresh: 1.5")), "/occupied_thresh");
  EXPECT_EQ(problem_of(with_line("occupied_thresh", "occupied_thresh: 0.1")), "/free_thresh");
  EXPECT_EQ(problem_of(std::string(kWords) + "resolution: 0.1\n"), "/resolution") << "twice";
  EXPECT_EQ(problem_of(std::string(kWords) + "by: a\nby: b\n"), "/by") << "twice";
  EXPECT_EQ(problem_of("image: [a"), "line 1");
  EXPECT_EQ(problem_of(""), "line 1");
  EXPECT_EQ(problem_of("just words"), "line 1");
  EXPECT_EQ(atlas::read_words(std::string(70'000, '#')).error().code, base::Code::TooLarge);
  EXPECT_FALSE(atlas::read_words(std::string(60'000, '[')));
}

TEST(Picture, IsReadFromBytesAndFromText) {
  const auto binary = atlas::read_pgm(bytes_of("P5\n# by hand\n3 2\n255\nabcdef"));
  ASSERT_TRUE(binary) << binary.error().detail;
  EXPECT_EQ(binary->columns, 3U);
  EXPECT_EQ(binary->rows, 2U);
  EXPECT_EQ(binary->values, (std::vector<std::uint16_t>{'a', 'b', 'c', 'd', 'e', 'f'}));
  const auto text = atlas::read_pgm(bytes_of("P2 3 2 # head\n9\n0 1 2 # first row\n3 4 9\n"));
  ASSERT_TRUE(text) << text.error().detail;
  EXPECT_EQ(text->values, (std::vector<std::uint16_t>{0, 1, 2, 3, 4, 9}));
  EXPECT_EQ(text->greatest, 9U);
  const auto wide =
      atlas::read_pgm(bytes_of(std::string_view("P5 2 1 1000\n\x01\x02\x03\xE8", 16)));
  ASSERT_TRUE(wide) << wide.error().detail;
  EXPECT_EQ(wide->values, (std::vector<std::uint16_t>{258, 1000}));
  const auto again = atlas::read_pgm(atlas::write_pgm(*wide));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->values, wide->values);
}

std::string byte_of(std::string_view file) {
  const auto picture = atlas::read_pgm(bytes_of(file));
  if (picture) return "none";
  return picture.error().fields.at(0).pointer;
}

TEST(Picture, ThatCannotBeNamesTheByte) {
  EXPECT_EQ(byte_of("P6\n1 1\n255\nabc"), "byte 0");
  EXPECT_EQ(byte_of(""), "byte 0");
  EXPECT_EQ(byte_of("P5\n2 x\n255\n"), "byte 5");
  EXPECT_EQ(byte_of("P5\n2 2\n255\nabc"), "byte 14") << "cut";
  EXPECT_EQ(byte_of("P5\n2 2\n255\nabcde"), "byte 15") << "junk behind it";
  EXPECT_EQ(byte_of("P2\n2 1\n255\n1 2 3"), "byte 15");
  EXPECT_EQ(byte_of("P2\n2 1\n255\n1 256"), "byte 16");
  EXPECT_EQ(byte_of("P2\n2 1\n255\n1 -6 "), "byte 13");
  EXPECT_EQ(byte_of("P5\n2 2\n0\nabcd"), "byte 8");
  EXPECT_EQ(byte_of("P5\n2 2\n70000\nabcd"), "byte 12");
  EXPECT_EQ(byte_of("P5\n0 2\n255\n"), "byte 10");
  EXPECT_EQ(byte_of("P5\n9999999999 2\n255\n"), "byte 12");
  // 10^8 cells are refused before anything is held for them.
  const auto huge = atlas::read_pgm(bytes_of("P5\n10000 10000\n255\n"));
  ASSERT_FALSE(huge);
  EXPECT_EQ(huge.error().code, base::Code::TooLarge);
  EXPECT_EQ(byte_of("P2 6000 6000 255 1 2 3"), "byte 22");
}

// Grey 0, 60, 100, 205, 254, 255 under the three modes; p = 1, 0.765, 0.608, 0.196, 0.004, 0.
std::vector<int> cells_under(const MapWords& words) {
  const auto map = atlas::map_of(words, Picture{6, 1, 255, {0, 60, 100, 205, 254, 255}});
  return {map->cells().begin(), map->cells().end()};
}

TEST(MapModes, SayWhatAGreyValueMeans) {
  MapWords words;
  EXPECT_EQ(cells_under(words), (std::vector<int>{100, 100, -1, -1, 0, 0}));
  words.free_thresh = 0.25;
  EXPECT_EQ(cells_under(words), (std::vector<int>{100, 100, -1, -1, 0, 0}))
      << "205 is what the map server writes for unknown";
  words.mode = MapMode::Scale;
  words.free_thresh = 0.196;
  // (0.6078 - 0.196) / (0.65 - 0.196) = 0.907
  EXPECT_EQ(cells_under(words), (std::vector<int>{100, 100, 91, 0, 0, 0}));
  words.negate = true;
  // p of 60: 0.2353 -> 0.087; of 100: 0.392 -> 0.432
  EXPECT_EQ(cells_under(words), (std::vector<int>{0, 9, 43, 100, 100, 100}));
  words.mode = MapMode::Raw;
  EXPECT_EQ(cells_under(words), (std::vector<int>{0, 60, 100, -1, -1, -1}));
}

//   The map server's grey of "unknown", 205 of 255, in pictures of more shades.
TEST(MapModes, TheGreyOfUnknownIsUnknownInPicturesOfAnyDepth) {
  for (const bool negate : {false, true}) {
    MapWords words;
    words.free_thresh = 0.25;
    words.negate = negate;
    const std::uint32_t grey = negate ? 50 : 205;
    for (const std::uint32_t greatest : {255U, 1023U, 4095U, 65535U}) {
      const auto unknown = static_cast<std::uint16_t>(std::lround(grey * greatest / 255.0));
      const auto lighter = static_cast<std::uint16_t>(negate ? unknown - 3 : unknown + 3);
      const auto map = atlas::map_of(words, Picture{2, 1, greatest, {unknown, lighter}});
      ASSERT_TRUE(map);
      EXPECT_EQ(map->at({0, 0}), -1) << greatest;
      EXPECT_EQ(map->at({1, 0}), 0) << greatest;
    }
  }
}

// The picture's first row is the map's highest.
//   picture  # .        map row 1: 100   0
//            ? #        map row 0:  -1 100
TEST(MapModes, ThePictureStandsOnItsLowestRow) {
  MapWords words;
  words.resolution_m = 1.0;
  words.origin = {10.0, 0.0, 0.0};
  const auto map = atlas::map_of(words, Picture{2, 2, 255, {0, 254, 205, 0}});
  ASSERT_TRUE(map);
  EXPECT_EQ(map->at({0, 1}), 100);
  EXPECT_EQ(map->at({0, 0}), -1);
  EXPECT_EQ(map->cell_of(11.5, 0.5), (CellAt{1, 0}));
}

TEST(MapModes, WriteWhatTheyRead) {
  const Picture drawn{3, 2, 255, {0, 254, 205, 205, 0, 254}};
  for (const bool negate : {false, true}) {
    MapWords words;
    words.negate = negate;
    Picture picture = drawn;
    if (negate) {
      for (auto& value : picture.values) value = static_cast<std::uint16_t>(255 - value);
    }
    const auto map = atlas::map_of(words, picture);
    ASSERT_TRUE(map);
    const auto again = atlas::picture_of(*map, words);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->values, picture.values);
  }
  MapWords raw;
  raw.mode = MapMode::Raw;
  const auto map = atlas::map_of(raw, Picture{3, 1, 255, {0, 37, 255}});
  EXPECT_EQ(atlas::picture_of(*map, raw)->values, (std::vector<std::uint16_t>{0, 37, 255}));
  MapWords scale;
  scale.mode = MapMode::Scale;
  EXPECT_EQ(atlas::picture_of(*map, scale).error().fields.at(0).pointer, "/mode")
      << "unknown cells have no grey value there";
}

}  // namespace
