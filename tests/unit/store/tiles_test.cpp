#include "store/tiles.hpp"

#include <fstream>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace roverd::store {
namespace {

class TilesTest : public ::testing::Test {
 protected:
  TilesTest() {
    std::string name = (std::filesystem::temp_directory_path() / "roverd-tiles-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~TilesTest() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  /// A set with one tile: zoom 2, column 1, row 3 counted from the south.
  std::filesystem::path make(const std::string& format, const std::string& bytes) {
    const auto file = folder_ / (format + ".mbtiles");
    SQLite::Database db(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    db.exec("CREATE TABLE metadata (name TEXT, value TEXT)");
    db.exec("CREATE TABLE tiles (zoom_level INT, tile_column INT, tile_row INT, tile_data BLOB)");
    SQLite::Statement meta(db, "INSERT INTO metadata VALUES ('format', ?)");
    meta.bind(1, format);
    meta.exec();
    db.exec(
        "INSERT INTO metadata VALUES ('bounds', '24.5,58.2,24.9,58.5'), "
        "('attribution', 'Land Board')");
    SQLite::Statement tile(db, "INSERT INTO tiles VALUES (2, 1, 3, ?)");
    tile.bind(1, bytes.data(), static_cast<int>(bytes.size()));
    tile.exec();
    return file;
  }

  std::filesystem::path folder_;
};

TEST_F(TilesTest, RowsAreCountedFromTheNorthOutside) {
  // Given a tile in the file's uppermost row (3 of 0..3 from the south),
  TileFolder tiles;
  ASSERT_TRUE(tiles.open({{"farm", make("png", "PNG")}}));
  // then it is row 0 of the address.
  const auto tile = tiles.read("farm", 2, 1, 0);
  ASSERT_TRUE(tile);
  EXPECT_EQ(tile->bytes, "PNG");
  EXPECT_EQ(tile->content_type, "image/png");
  EXPECT_FALSE(tiles.read("farm", 2, 1, 3));
}

TEST_F(TilesTest, TheSetIsDescribedAlsoWhereItsMetadataAreSilent) {
  TileFolder tiles;
  ASSERT_TRUE(tiles.open({{"farm", make("jpg", "JPG")}}));
  const auto sets = tiles.sets();
  ASSERT_EQ(sets.size(), 1u);
  EXPECT_EQ(sets[0].set, "farm");
  EXPECT_EQ(sets[0].name, "farm");
  EXPECT_EQ(sets[0].min_zoom, 2);
  EXPECT_EQ(sets[0].max_zoom, 2);
  EXPECT_EQ(sets[0].attribution, "Land Board");
  EXPECT_EQ(sets[0].bounds_deg, (std::array{24.5, 58.2, 24.9, 58.5}));
}

TEST_F(TilesTest, PackedVectorTilesSaySo) {
  TileFolder tiles;
  ASSERT_TRUE(tiles.open({{"roads", make("pbf", std::string("\x1f\x8b\x08\x00", 4))}}));
  const auto tile = tiles.read("roads", 2, 1, 0);
  ASSERT_TRUE(tile);
  EXPECT_EQ(tile->content_encoding, "gzip");
  EXPECT_EQ(tile->content_type, "application/vnd.mapbox-vector-tile");
}

TEST_F(TilesTest, WhatIsOutsideTheWorldIsNotThere) {
  TileFolder tiles;
  ASSERT_TRUE(tiles.open({{"farm", make("png", "PNG")}}));
  EXPECT_FALSE(tiles.read("sea", 2, 1, 0));
  EXPECT_FALSE(tiles.read("farm", 2, 4, 0));
  EXPECT_FALSE(tiles.read("farm", 2, 1, -1));
  EXPECT_FALSE(tiles.read("farm", 31, 0, 0));
  EXPECT_FALSE(tiles.read("farm", -1, 0, 0));
}

TEST_F(TilesTest, AWrongFileIsNamedAndNothingIsOpened) {
  const auto text = folder_ / "text.mbtiles";
  std::ofstream(text) << "these are no tiles, although the text is longer than a header of SQLite "
                         "which has one hundred bytes";
  const auto empty = folder_ / "empty.mbtiles";
  std::ofstream(empty) << "";
  const auto odd = make("tiff", "TIFF");
  for (const auto& file : {text, empty, odd, folder_ / "missing.mbtiles"}) {
    TileFolder tiles;
    const auto opened = tiles.open({{"good", make("png", "PNG")}, {"bad", file}});
    std::filesystem::remove(folder_ / "png.mbtiles");
    ASSERT_FALSE(opened) << file;
    EXPECT_NE(opened.error().detail.find("tile set bad, file " + file.string()), std::string::npos);
    EXPECT_TRUE(tiles.sets().empty());
  }
}

}  // namespace
}  // namespace roverd::store
