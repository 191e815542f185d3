#include <fstream>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "store/tile_shelf.hpp"

namespace roverd::store {
namespace {

using base::Code;
using namespace std::string_literals;

const std::string kPng = "\x89PNG\r\n\x1a\n and a picture";
constexpr TileAddress kThere{2, 1, 0};

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
        "INSERT INTO metadata VALUES ('bounds', '-40,70,-20,75'), "
        "('attribution', 'Land Board')");
    SQLite::Statement tile(db, "INSERT INTO tiles VALUES (2, 1, 3, ?)");
    tile.bind(1, bytes.data(), static_cast<int>(bytes.size()));
    tile.exec();
    return file;
  }

  std::unique_ptr<TileShelf> shelf(const TileShelf::Configured& configured = {},
                                   std::uintmax_t leave_free = 0) {
    auto opened = TileShelf::open(folder_ / "kept", configured, leave_free);
    EXPECT_TRUE(opened) << opened.error().detail;
    return opened ? std::move(*opened) : nullptr;
  }
  std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t files_kept() {
    const std::filesystem::directory_iterator all(folder_ / "kept");
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

  std::filesystem::path folder_;
};

TEST_F(TilesTest, RowsAreCountedFromTheNorthOutside) {
  // Given a tile in the file's uppermost row (3 of 0..3 from the south),
  const auto tiles = shelf({{"farm", make("png", "PNG")}});
  // then it is row 0 of the address.
  const auto tile = tiles->read("farm", kThere);
  ASSERT_TRUE(tile);
  EXPECT_EQ(tile->bytes, "PNG");
  EXPECT_EQ(tile->content_type, "image/png");
  EXPECT_FALSE(tiles->read("farm", {2, 1, 3}));
}

TEST_F(TilesTest, TheSetIsDescribedAlsoWhereItsMetadataAreSilent) {
  const auto tiles = shelf({{"farm", make("jpg", "JPG")}});
  const auto sets = tiles->sets();
  ASSERT_EQ(sets.size(), 1u);
  EXPECT_EQ(sets[0].set, "farm");
  EXPECT_EQ(sets[0].name, "farm");
  EXPECT_EQ(sets[0].min_zoom, 2);
  EXPECT_EQ(sets[0].max_zoom, 2);
  EXPECT_EQ(sets[0].attribution, "Land Board");
  EXPECT_EQ(sets[0].bounds_deg, (std::array{-40.0, 70.0, -20.0, 75.0}));
  EXPECT_FALSE(sets[0].kept);
}

TEST_F(TilesTest, WithoutAFormatTheFirstTileTellsIt) {
  const auto silent = [this](const std::string& bytes) {
    const auto file = make("png", bytes);
    SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
        .exec("DELETE FROM metadata WHERE name = 'format'");
    return file;
  };
  const auto tiles = shelf({{"farm", silent("\xff\xd8\xff\xe0 and so on")}});
  EXPECT_EQ(tiles->sets().at(0).format, "jpg");
  EXPECT_EQ(tiles->read("farm", kThere)->content_type, "image/jpeg");

  std::filesystem::remove(folder_ / "png.mbtiles");
  const std::string unknown = bytes_of(silent("<svg/>"));
  const auto taken = tiles->take("other", {0, unknown.size(), unknown});
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().detail,
            "it does not say the format of its tiles, and they do not show it");
}

/// Zoom 12, column 2352, row 1225 from the north: about 26.7 E, 58.4 N.
class FieldTiles : public TilesTest {
 protected:
  std::filesystem::path with(const std::string& metadata, bool from_north) {
    const auto file = make("png", kPng);
    SQLite::Database db(file.string(), SQLite::OPEN_READWRITE);
    db.exec("DELETE FROM tiles");
    db.exec("DELETE FROM metadata WHERE name = 'bounds'");
    db.exec("INSERT INTO metadata VALUES " + metadata);
    SQLite::Statement tile(db, "INSERT INTO tiles VALUES (12, 2352, ?, ?)");
    tile.bind(1, from_north ? kAt.y : 4095 - kAt.y);
    tile.bind(2, kPng.data(), static_cast<int>(kPng.size()));
    tile.exec();
    return file;
  }
  static constexpr TileAddress kAt{12, 2352, 1225};
};

TEST_F(FieldTiles, RowsFromTheNorthAreFoundWhereTheFileSaysSoOrItsBoundsTellIt) {
  const auto bounds = bounds_of(kAt);
  ASSERT_NEAR(bounds[0], 26.7, 0.1);
  ASSERT_NEAR(bounds[1], 58.4, 0.1);
  for (const std::string metadata :
       {"('scheme', 'xyz')", "('scheme', 'XYZ'), ('bounds', '-180,-85,180,85')",
        "('bounds', '26.7,58.3,26.8,58.5')"}) {
    const auto tiles = shelf({{"farm", with(metadata, true)}});
    EXPECT_TRUE(tiles->read("farm", kAt)) << metadata;
    EXPECT_FALSE(tiles->read("farm", {12, kAt.x, 4095 - kAt.y})) << metadata;
    EXPECT_NEAR(tiles->sets().at(0).bounds_deg->at(1), 58.4, 0.1) << metadata;
    std::filesystem::remove(folder_ / "png.mbtiles");
  }
  const auto usual = shelf({{"farm", with("('bounds', '26.7,58.3,26.8,58.5')", false)}});
  EXPECT_TRUE(usual->read("farm", kAt));
}

TEST_F(FieldTiles, TheTilesTellTheirZoomAndWhereTheyLieAgainstWrongMetadata) {
  for (const std::string bounds : {"26.8,58.5,26.7,58.3", "-100,-20,-90,-10", "here"}) {
    const auto tiles =
        shelf({{"farm",
                with("('minzoom', '3'), ('maxzoom', '9'), ('bounds', '" + bounds + "')", false)}});
    const TileSet about = tiles->sets().at(0);
    EXPECT_EQ(about.min_zoom, 12);
    EXPECT_EQ(about.max_zoom, 12);
    EXPECT_EQ(about.bounds_deg, bounds_of(kAt)) << bounds;
    EXPECT_TRUE(tiles->read("farm", kAt)) << bounds;
    std::filesystem::remove(folder_ / "png.mbtiles");
  }
}

TEST_F(FieldTiles, LieWhereAllZoomsDoThoughTheDeepestIsOfOneCorner) {
  // Given: zoom 5 all over, columns 17 to 18 and rows 9 to 10 from the north, one tile of zoom 12.
  const auto file = [this](const std::string& metadata) {
    auto out = with(metadata, false);
    SQLite::Database db(out.string(), SQLite::OPEN_READWRITE);
    for (const int x : {17, 18}) {
      for (const int y : {9, 10}) {
        db.exec("INSERT INTO tiles SELECT 5, " + std::to_string(x) + ", " + std::to_string(31 - y) +
                ", tile_data FROM tiles WHERE zoom_level = 12");
      }
    }
    return out;
  };
  const auto bounds = [&](const std::string& metadata) {
    const auto out = shelf({{"farm", file(metadata)}})->sets().at(0).bounds_deg;
    std::filesystem::remove(folder_ / "png.mbtiles");
    return out;
  };
  const auto first = bounds_of({5, 17, 9});
  const auto last = bounds_of({5, 18, 10});
  const std::array whole = {first[0], last[1], last[2], first[3]};
  // Then: its bounds are what it says, as far as there are tiles, or those of all tiles.
  EXPECT_EQ(bounds("('bounds', '20,55,30,60')"), (std::array{20.0, 55.0, 30.0, 60.0}));
  EXPECT_EQ(bounds("('bounds', '-100,-20,-90,-10')"), whole);
  EXPECT_EQ(bounds("('scheme', 'tms')"), whole);
}

TEST_F(FieldTiles, LieAlsoWhereTheDeepestZoomAloneIs) {
  // Given: two downloads in one set, of zoom 5 here and of zoom 12 elsewhere.
  const auto file = with("('scheme', 'tms')", false);
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
      .exec("INSERT INTO tiles SELECT 5, 3, 22, tile_data FROM tiles");
  const auto wide = bounds_of({5, 3, 9});
  const auto deep = bounds_of(kAt);
  const std::array all = {std::min(wide[0], deep[0]), std::min(wide[1], deep[1]),
                          std::max(wide[2], deep[2]), std::max(wide[3], deep[3])};
  EXPECT_EQ(shelf({{"farm", file}})->sets().at(0).bounds_deg, all);
}

TEST_F(FieldTiles, TheDeepestZoomTellsWhereTheyLieIfTheOthersAreWhatHoldsIt) {
  const auto file = with("('scheme', 'tms')", false);
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
      .exec("INSERT INTO tiles SELECT 0, 0, 0, tile_data FROM tiles");
  EXPECT_EQ(shelf({{"farm", file}})->sets().at(0).bounds_deg, bounds_of(kAt));
}

TEST_F(TilesTest, TheFormatIsKnownHoweverItIsWritten) {
  for (const char* said : {"PNG", "image/png"}) {
    const auto file = make("png", "PNG");
    SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
        .exec("UPDATE metadata SET value = '" + std::string(said) + "' WHERE name = 'format'");
    const auto tiles = shelf({{"farm", file}});
    EXPECT_EQ(tiles->sets().at(0).format, "png");
    EXPECT_EQ(tiles->read("farm", kThere)->content_type, "image/png");
    std::filesystem::remove(folder_ / "png.mbtiles");
  }
}

TEST_F(TilesTest, WithoutBoundsTheTilesTellThem) {
  const auto file = make("png", kPng);
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
      .exec("DELETE FROM metadata WHERE name = 'bounds'");
  const auto bounds = shelf({{"farm", file}})->sets().at(0).bounds_deg;
  // The second of four columns, the northernmost of four rows.
  ASSERT_TRUE(bounds);
  EXPECT_DOUBLE_EQ((*bounds)[0], -90.0);
  EXPECT_NEAR((*bounds)[1], 66.51326, 1e-5);
  EXPECT_DOUBLE_EQ((*bounds)[2], 0.0);
  EXPECT_NEAR((*bounds)[3], 85.05113, 1e-5);
}

TEST_F(TilesTest, PackedVectorTilesSaySo) {
  const auto tiles = shelf({{"roads", make("pbf", "\x1f\x8b\x08\x00"s)}});
  const auto tile = tiles->read("roads", kThere);
  ASSERT_TRUE(tile);
  EXPECT_EQ(tile->content_encoding, "gzip");
  EXPECT_EQ(tile->content_type, "application/vnd.mapbox-vector-tile");
  const auto other = shelf({{"roads", make("mvt", "\x78\x9c and so on"s)}});
  EXPECT_EQ(other->read("roads", kThere)->content_encoding, "deflate");
}

TEST_F(TilesTest, WhatIsOutsideTheWorldIsNotThere) {
  const auto tiles = shelf({{"farm", make("png", "PNG")}});
  EXPECT_FALSE(tiles->read("sea", kThere));
  EXPECT_FALSE(tiles->read("farm", {2, 4, 0}));
  EXPECT_FALSE(tiles->read("farm", {2, 1, -1}));
  EXPECT_FALSE(tiles->read("farm", {31, 0, 0}));
  EXPECT_FALSE(tiles->read("farm", {-1, 0, 0}));
}

TEST_F(TilesTest, AWrongFileOfTheConfigurationIsNamedAndNothingIsOpened) {
  const auto text = folder_ / "text.mbtiles";
  std::ofstream(text) << "these are no tiles, although the text is longer than a header of SQLite "
                         "which has one hundred bytes";
  const auto empty = folder_ / "empty.mbtiles";
  std::ofstream(empty) << "";
  const auto odd = make("tiff", "TIFF");
  for (const auto& file : {text, empty, odd, folder_ / "missing.mbtiles"}) {
    const auto opened =
        TileShelf::open(folder_ / "kept", {{"good", make("png", "PNG")}, {"bad", file}}, 0);
    std::filesystem::remove(folder_ / "png.mbtiles");
    ASSERT_FALSE(opened) << file;
    EXPECT_NE(opened.error().detail.find("tile set bad, file " + file.string()), std::string::npos);
  }
}

TEST_F(TilesTest, AFileComesInPiecesAndGoesOnAfterARestart) {
  const std::string whole = bytes_of(make("png", kPng));
  const std::size_t half = whole.size() / 2;
  // Given the first half of a file,
  const auto first =
      shelf()->take("farm", {0, whole.size(), std::string_view(whole).substr(0, half)});
  ASSERT_TRUE(first) << first.error().detail;
  EXPECT_FALSE(*first);
  // when the robot starts anew, it knows how far it came,
  const auto tiles = shelf();
  EXPECT_TRUE(tiles->sets().empty());
  ASSERT_EQ(tiles->unfinished().size(), 1u);
  EXPECT_EQ(tiles->unfinished()[0].received_bytes, half);
  // takes no piece that leaves a gap or comes twice,
  for (const std::size_t wrong : {half - 1, half + 1}) {
    const auto gap = tiles->take("farm", {wrong, whole.size(), "x"});
    ASSERT_FALSE(gap);
    EXPECT_EQ(gap.error().code, Code::Conflict);
    EXPECT_NE(gap.error().detail.find("the next byte of farm is " + std::to_string(half)),
              std::string::npos);
  }
  // and with the rest it has the set,
  const auto rest = tiles->take("farm", {half, whole.size(), std::string_view(whole).substr(half)});
  ASSERT_TRUE(rest) << rest.error().detail;
  ASSERT_TRUE(*rest);
  EXPECT_TRUE((*rest)->kept);
  EXPECT_FALSE((*rest)->grows);
  EXPECT_TRUE(tiles->unfinished().empty());
  EXPECT_EQ(tiles->read("farm", kThere)->bytes, kPng);
  // also after the next start.
  const auto later = shelf();
  ASSERT_EQ(later->sets().size(), 1u);
  EXPECT_TRUE(later->sets()[0].kept);
  EXPECT_EQ(later->read("farm", kThere)->bytes, kPng);
}

TEST_F(TilesTest, WhatIsSentAgainTakesThePlaceOfWhatWasThere) {
  const auto tiles = shelf();
  const std::string before = bytes_of(make("png", kPng));
  ASSERT_TRUE(tiles->take("farm", {0, before.size(), before}));
  const std::string after = bytes_of(make("jpg", "\xff\xd8\xff another"));
  ASSERT_TRUE(tiles->take("farm", {0, after.size(), after}));
  ASSERT_EQ(tiles->sets().size(), 1u);
  EXPECT_EQ(tiles->sets()[0].format, "jpg");
  EXPECT_EQ(tiles->read("farm", kThere)->bytes, "\xff\xd8\xff another");
}

TEST_F(TilesTest, WhatIsNoFileOfTilesIsRefusedAndDeleted) {
  const auto tiles = shelf();
  const std::string good = bytes_of(make("png", kPng));
  ASSERT_TRUE(tiles->take("farm", {0, good.size(), good}));
  const auto refused = [&](const std::string& bytes) {
    const auto taken = tiles->take("farm", {0, bytes.size(), bytes});
    EXPECT_TRUE(tiles->unfinished().empty());
    return taken ? std::string("taken") : taken.error().detail;
  };
  EXPECT_NE(refused("GIF89a and so on, no database").find("not a readable MBTiles file"),
            std::string::npos);
  EXPECT_EQ(refused(bytes_of(make("tiff", "TIFF"))), "its tiles have the unknown format \"tiff\"");
  const auto none = make("webp", "RIFF");
  SQLite::Database(none.string(), SQLite::OPEN_READWRITE).exec("DELETE FROM tiles");
  EXPECT_EQ(refused(bytes_of(none)), "there is no tile in it");
  // A file that was cut off: its pages are not there.
  EXPECT_NE(refused(good.substr(0, 4096)), "taken");
  // The one before is there as it was.
  EXPECT_EQ(tiles->read("farm", kThere)->bytes, kPng);
  EXPECT_EQ(files_kept(), 1u);
}

TEST_F(TilesTest, AViewWithoutEndIsAnErrorAndNoHang) {
  const auto file = make("png", kPng);
  {
    SQLite::Database db(file.string(), SQLite::OPEN_READWRITE);
    db.exec("DROP TABLE tiles");
    db.exec(
        "CREATE VIEW tiles AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) "
        "SELECT i AS zoom_level, i AS tile_column, i AS tile_row, 'x' AS tile_data FROM n");
  }
  const std::string bytes = bytes_of(file);
  const auto taken = shelf()->take("farm", {0, bytes.size(), bytes});
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, Code::Malformed);
}

TEST_F(TilesTest, APieceThatCannotBeIsRefused) {
  const auto tiles = shelf({{"fixed", make("png", kPng)}});
  EXPECT_EQ(tiles->take("farm", {0, 3, "four"}).error().code, Code::Invalid);
  EXPECT_EQ(tiles->take("farm", {5, 3, "x"}).error().code, Code::Invalid);
  EXPECT_EQ(tiles->take("farm", {0, 3, ""}).error().code, Code::Invalid);
  EXPECT_EQ(tiles->take("farm", {0, kMostTileFile + 1, "x"}).error().code, Code::Invalid);
  EXPECT_EQ(tiles->take("fixed", {0, 3, "x"}).error().code, Code::Conflict);
  EXPECT_EQ(files_kept(), 0u);
}

TEST_F(TilesTest, ASetGrowsTileByTileAndIsThereAfterARestart) {
  TileSet about;
  about.set = "aerial";
  about.name = "From the air";
  about.format = "png";
  about.attribution = "Land Board";
  {
    const auto tiles = shelf();
    const auto made = tiles->create(about);
    ASSERT_TRUE(made) << made.error().detail;
    EXPECT_TRUE(made->grows && made->kept);
    EXPECT_FALSE(made->bounds_deg);
    EXPECT_EQ(tiles->create(about).error().code, Code::Conflict);
    ASSERT_TRUE(tiles->put("aerial", {18, 147'000, 76'000}, kPng));
    ASSERT_TRUE(tiles->put("aerial", {17, 73'500, 38'000}, kPng));
    ASSERT_TRUE(tiles->put("aerial", {18, 147'001, 76'000}, kPng + "2"));
    ASSERT_TRUE(tiles->put("aerial", {18, 147'001, 76'000}, kPng + "3"));
  }
  const auto tiles = shelf();
  ASSERT_EQ(tiles->sets().size(), 1u);
  const TileSet set = tiles->sets()[0];
  EXPECT_EQ(set.name, "From the air");
  EXPECT_EQ(set.attribution, "Land Board");
  EXPECT_EQ(set.min_zoom, 17);
  EXPECT_EQ(set.max_zoom, 18);
  ASSERT_TRUE(set.bounds_deg);
  EXPECT_EQ((*set.bounds_deg)[0], bounds_of({18, 147'000, 76'000})[0]);
  EXPECT_EQ((*set.bounds_deg)[2], bounds_of({18, 147'001, 76'000})[2]);
  EXPECT_EQ(tiles->read("aerial", {18, 147'001, 76'000})->bytes, kPng + "3");
  // And it grows on.
  EXPECT_TRUE(tiles->put("aerial", {18, 147'002, 76'000}, kPng));
  EXPECT_EQ((*tiles->sets()[0].bounds_deg)[2], bounds_of({18, 147'002, 76'000})[2]);
}

TEST_F(TilesTest, OnlyWhatFitsTheSetIsPutIntoIt) {
  const auto tiles = shelf({{"fixed", make("png", kPng)}});
  TileSet about;
  about.set = about.name = "aerial";
  about.format = "jpg";
  ASSERT_TRUE(tiles->create(about));
  EXPECT_EQ(tiles->put("aerial", kThere, kPng).error().code, Code::Unsupported);
  EXPECT_EQ(tiles->put("aerial", {2, 4, 0}, "\xff\xd8\xff").error().code, Code::Invalid);
  EXPECT_EQ(tiles->put("nowhere", kThere, kPng).error().code, Code::NotFound);
  EXPECT_EQ(tiles->put("fixed", kThere, kPng).error().code, Code::Conflict);
  EXPECT_FALSE(tiles->read("aerial", kThere));
}

TEST_F(TilesTest, AFileThatVanishedAndAFullDiskAreTold) {
  const auto tiles = shelf();
  TileSet about;
  about.set = about.name = "aerial";
  about.format = "png";
  ASSERT_TRUE(tiles->create(about));
  std::filesystem::remove_all(folder_ / "kept");
  EXPECT_EQ(tiles->put("aerial", kThere, kPng).error().code, Code::Unavailable);
  EXPECT_EQ(tiles->take("farm", {0, 10, "x"}).error().code, Code::Unavailable);
  const auto full = shelf({}, std::uintmax_t{1} << 60);
  EXPECT_NE(full->create(about).error().detail.find("MB free"), std::string::npos);
  EXPECT_EQ(full->take("farm", {0, 10, "x"}).error().code, Code::Unavailable);
}

TEST_F(TilesTest, NameAndShiftAreKeptAlsoOfTheConfigurationsSets) {
  const TileShelf::Configured configured{{"farm", make("png", kPng)}};
  {
    const auto tiles = shelf(configured);
    ASSERT_TRUE(tiles->change("farm", {"The farm", std::array{1.5, -0.25}}));
    EXPECT_EQ(tiles->change("farm", {"", std::nullopt}).error().code, Code::Invalid);
    EXPECT_EQ(tiles->change("farm", {std::nullopt, std::array{1001.0, 0.0}}).error().code,
              Code::Invalid);
    EXPECT_EQ(tiles->change("sea", {}).error().code, Code::NotFound);
  }
  const TileSet set = shelf(configured)->sets().at(0);
  EXPECT_EQ(set.name, "The farm");
  EXPECT_EQ(set.shift_m, (std::array{1.5, -0.25}));
}

TEST_F(TilesTest, ASetWhoseNameIsAPathIsNotWrittenAbout) {
  const auto tiles = shelf({{"../farm", make("png", kPng)}});
  EXPECT_EQ(tiles->change("../farm", {"Farm", std::nullopt}).error().code, Code::Conflict);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "farm.json"));
}

TEST_F(TilesTest, WhatWasBroughtMayGoAndTheConfigurationsMayNot) {
  const auto file = make("png", kPng);
  const auto tiles = shelf({{"fixed", file}});
  const std::string bytes = bytes_of(file);
  ASSERT_TRUE(tiles->take("farm", {0, bytes.size(), bytes}));
  ASSERT_TRUE(tiles->take("half", {0, bytes.size(), bytes.substr(0, 100)}));
  ASSERT_TRUE(tiles->change("farm", {"Farm", std::nullopt}));
  EXPECT_TRUE(tiles->remove("farm"));
  EXPECT_TRUE(tiles->remove("half"));
  EXPECT_EQ(tiles->remove("farm").error().code, Code::NotFound);
  EXPECT_EQ(tiles->remove("fixed").error().code, Code::Conflict);
  EXPECT_FALSE(tiles->read("farm", kThere));
  EXPECT_TRUE(tiles->unfinished().empty());
  EXPECT_EQ(files_kept(), 0u);
}

TEST_F(TilesTest, AnUnreadableFileInTheFolderIsLeftAndTold) {
  std::filesystem::create_directories(folder_ / "kept");
  std::ofstream(folder_ / "kept" / "odd.up.mbtiles") << "no database, although it is long enough "
                                                        "to be looked into as if it were one";
  const auto tiles = shelf();
  EXPECT_TRUE(tiles->sets().empty());
  ASSERT_EQ(tiles->troubles().size(), 1u);
  EXPECT_NE(tiles->troubles()[0].find("odd.up.mbtiles"), std::string::npos);
  EXPECT_EQ(files_kept(), 1u);
}

TEST(TileSetName, GoesIntoAnAddressAndAFile) {
  EXPECT_TRUE(is_tile_set_name("farm-2_b"));
  for (const char* no : {"", "Farm", "a/b", "..", "a.b", "ä", "a b"}) {
    EXPECT_FALSE(is_tile_set_name(no)) << no;
  }
  EXPECT_FALSE(is_tile_set_name(std::string(41, 'a')));
}

}  // namespace
}  // namespace roverd::store
