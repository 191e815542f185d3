// PCD files, in and out.

#include "nav/cells/pcd.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "real_data.hpp"

namespace roverd::nav::cells {
namespace {

using Blob = std::vector<std::uint8_t>;

Blob blob(const std::string& text) {
  return {text.begin(), text.end()};
}

std::string head(const std::string& size, const std::string& data) {
  return "# a comment\nVERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + size +
         "VIEWPOINT 1 2 3 1 0 0 0\nDATA " + data + "\n";
}

std::string refusal(const std::string& text) {
  const auto cloud = read_pcd_cloud(blob(text));
  return cloud ? "" : cloud.error().detail;
}

TEST(Pcd, ReadsText) {
  const auto cloud = read_pcd_cloud(
      blob(head("WIDTH 2\nHEIGHT 1\nPOINTS 2\n", "ascii") + "1 -2.5 3e-3\r\n\nnan 0 1\n"));
  ASSERT_TRUE(cloud) << cloud.error().detail;
  ASSERT_EQ(cloud->size(), 2U);
  EXPECT_EQ((*cloud)[0], Eigen::Vector3f(1.0F, -2.5F, 0.003F));
  EXPECT_TRUE(std::isnan((*cloud)[1].x()));
}

TEST(Pcd, PicksFieldsOfAllTypesOutOfBinaryRows) {
  // Given rows of f64, an array of two u8, i16 and u64,
  Blob file = blob(
      "FIELDS far pad small big\nSIZE 8 1 2 8\nTYPE F U I U\nCOUNT 1 2 1 1\nWIDTH 1\nHEIGHT 2\n"
      "POINTS 2\nDATA binary\n");
  for (const int row : {0, 1}) {
    const double far = 4'000'000.25 + row;
    const auto small = static_cast<std::int16_t>(-7 - row);
    const std::uint64_t big = 1U << 20U;
    std::array<std::uint8_t, 20> bytes{};
    std::memcpy(bytes.data(), &far, 8);
    std::memcpy(bytes.data() + 10, &small, 2);
    std::memcpy(bytes.data() + 12, &big, 8);
    file.insert(file.end(), bytes.begin(), bytes.end());
  }
  // then those asked for come in the order in which they were.
  constexpr std::array<std::string_view, 3> kWanted = {"big", "small", "far"};
  const auto table = read_pcd(file, kWanted);
  ASSERT_TRUE(table) << table.error().detail;
  EXPECT_EQ(table->height, 2U);
  EXPECT_EQ(table->columns[0], (std::vector<float>{1048576.0F, 1048576.0F}));
  EXPECT_EQ(table->columns[1], (std::vector<float>{-7.0F, -8.0F}));
  EXPECT_EQ(table->columns[2], (std::vector<float>{4'000'000.25F, 4'000'001.25F}));
  constexpr std::array<std::string_view, 1> kArray = {"pad"};
  EXPECT_EQ(read_pcd(file, kArray).error().detail, "PCD field pad is an array");
}

TEST(Pcd, WritesWhatItReadsInEveryForm) {
  PcdTable table;
  table.width = 3;
  table.height = 200;
  table.viewpoint = {0.5, 0, -1, 0.5, 0.5, 0.5, 0.5};
  table.names = {"x", "intensity"};
  table.columns.resize(2);
  for (int i = 0; i < 600; ++i) {
    table.columns[0].push_back(std::sin(float(i)));
    table.columns[1].push_back(float(i % 7));
  }
  constexpr std::array<std::string_view, 2> kWanted = {"x", "intensity"};
  for (const PcdData data : {PcdData::Ascii, PcdData::Binary, PcdData::Compressed}) {
    const auto file = write_pcd(table, data);
    ASSERT_TRUE(file);
    const auto again = read_pcd(*file, kWanted);
    ASSERT_TRUE(again) << again.error().detail;
    EXPECT_EQ(again->columns, table.columns);
    EXPECT_EQ(again->viewpoint, table.viewpoint);
    EXPECT_EQ(again->height, 200U);
  }
  table.columns[1].pop_back();
  EXPECT_FALSE(write_pcd(table, PcdData::Binary));
  table.names[1] = "two words";
  EXPECT_FALSE(write_pcd(table, PcdData::Binary));
}

TEST(Pcd, NamesWhatIsWrong) {
  const std::string one = "WIDTH 1\nHEIGHT 1\n";
  EXPECT_EQ(refusal(""), "PCD line 1: ends before DATA");
  EXPECT_EQ(refusal("DATA ascii\n"), "PCD line 1: DATA without FIELDS before it");
  EXPECT_EQ(refusal("FIELDS x\nSIZE 4 4\n"), "PCD line 2: SIZE has not as many values as FIELDS");
  EXPECT_EQ(refusal("FIELDS x\nSIZE 0\n"), "PCD line 2: SIZE of x must be 1 to 4096");
  EXPECT_EQ(refusal("FIELDS x\nSIZE 3\nDATA ascii\n"),
            "PCD line 3: field x has no known TYPE and SIZE");
  EXPECT_EQ(refusal("FIELDS x\nWIDTH -1\n"), "PCD line 2: WIDTH must be one number");
  EXPECT_EQ(refusal("HELLO\n"), "PCD line 1: not a line of a PCD header");
  EXPECT_EQ(refusal("FIELDS x y\nWIDTH 0\nDATA ascii\n"), "PCD has no field z");
  EXPECT_EQ(refusal(head(one, "base64")), "PCD data must be ascii, binary or binary_compressed");
  EXPECT_EQ(refusal(head(one + "POINTS 2\n", "binary")),
            "PCD line 11: POINTS is not WIDTH x HEIGHT");
  EXPECT_EQ(refusal(head(one, "ascii") + "1 2     \n"), "PCD line 11: no number for z");
  EXPECT_EQ(refusal(head(one, "ascii") + "1 2 3 4\n"), "PCD line 11: more values than fields");
  EXPECT_EQ(refusal(head("WIDTH 2\nHEIGHT 1\n", "ascii") + "1 2 3          \n"),
            "PCD line 11: ends before the last point");
}

TEST(Pcd, AllocatesNothingForPointsThatTheFileCannotHold) {
  const std::string many = "WIDTH 10000000\nHEIGHT 1\nPOINTS 10000000\n";
  EXPECT_EQ(refusal(head(many, "ascii") + "1 2 3\n"),
            "PCD line 11: more points than the text can hold");
  EXPECT_NE(refusal(head(many, "binary") + "123456789012").find("ends before the last point"),
            std::string::npos);
  // 120 million bytes packed into four
  const std::string packed("\x04\0\0\0\x00\x0e\x27\x07\0\0\0\0", 12);
  EXPECT_EQ(refusal(head(many, "binary_compressed") + packed),
            "packed data: 4 bytes cannot hold 120000000");
  EXPECT_EQ(refusal(head("WIDTH 4000000000\nHEIGHT 4000000000\n", "binary")),
            "PCD of 16000000000000000000 points: more than 20000000");
}

TEST(PcdRealData, ATableSeenByACamera) {
  ROVERD_REAL_DATA(path, "sensors/clouds/table-organised-640x480.pcd");
  const Blob file = tests::read_file(path);
  const auto cloud = read_pcd_cloud(file);
  ASSERT_TRUE(cloud) << cloud.error().detail;
  ASSERT_EQ(cloud->size(), 640U * 480U);
  std::size_t finite = 0;
  for (const auto& p : *cloud) finite += p.allFinite() ? 1 : 0;
  EXPECT_EQ(finite, 182'292U);
  // and packed again it is the same, and no longer than theirs by much.
  const auto again = write_pcd(pcd_table(*cloud), PcdData::Compressed);
  ASSERT_TRUE(again);
  EXPECT_LT(again->size(), file.size());
  const auto back = read_pcd_cloud(*again);
  ASSERT_TRUE(back);
  EXPECT_EQ(std::memcmp(back->data(), cloud->data(), cloud->size() * sizeof(Eigen::Vector3f)), 0);
}

TEST(PcdRealData, OneRevolutionOfALaser) {
  ROVERD_REAL_DATA(path, "sensors/velodyne/vlp16-one-revolution.pcd");
  const auto file = tests::read_file(path);
  constexpr std::array<std::string_view, 5> kWanted = {"distance", "channel", "x", "y", "z"};
  const auto table = read_pcd(file, kWanted);
  ASSERT_TRUE(table) << table.error().detail;
  ASSERT_EQ(table->columns[0].size(), 14'831U);
  for (std::size_t i = 0; i < 14'831U; ++i) {
    const auto value = [&](std::size_t column) { return table->columns[column][i]; };
    ASSERT_NEAR(value(0), std::hypot(value(2), value(3), value(4)), 1e-3);
    ASSERT_LT(value(1), 16.0F);
  }
}

}  // namespace
}  // namespace roverd::nav::cells
