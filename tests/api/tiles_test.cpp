// Map tiles over HTTP: sets that grow tile by tile, files in pieces, and what is refused.

#include "store/tiles.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include "house.hpp"

namespace roverd::test {
namespace {

constexpr const char* kBytes = "Content-Type: application/octet-stream\r\n";
constexpr const char* kImage = "Content-Type: image/png\r\n";
const std::string kPng = "\x89PNG\r\n\x1a\n and a picture";

class TilesApi : public HouseTest {
 protected:
  void make(const std::string& set = "farm") {
    const auto made = call("POST", "/tiles", Json{{"set", set}, {"name", "The farm"}});
    ASSERT_EQ(made.status, 201u) << made.body;
  }
  Reply piece(const std::string& set, std::size_t offset, std::size_t size,
              const std::string& bytes) {
    return call("PUT",
                "/tiles/" + set + "/file?offset=" + std::to_string(offset) +
                    "&size=" + std::to_string(size),
                bytes, kBytes);
  }
  Json items() { return call("GET", "/tiles").body["items"]; }

  /// A file of somebody else, with one tile.
  std::string mbtiles() {
    std::string folder = (std::filesystem::temp_directory_path() / "roverd-tile-XXXXXX").string();
    EXPECT_NE(::mkdtemp(folder.data()), nullptr);
    const std::filesystem::path file = std::filesystem::path(folder) / "a.mbtiles";
    store::TileSet about;
    about.name = "Orthophoto";
    about.format = "png";
    {
      auto made = store::TileFile::grow(about, file);
      EXPECT_TRUE(made && (*made)->put({3, 5, 6}, kPng));
    }  // closed: its journal is in it
    std::ifstream in(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::filesystem::remove_all(folder);
    return bytes;
  }
};

TEST_F(TilesApi, ASetIsMadeFilledServedAndDeleted) {
  EXPECT_EQ(items(), Json::array());
  make();
  ASSERT_EQ(call("PUT", "/tiles/farm/3/5/6", kPng, kImage).status, 204u);
  const Json set = items()[0];
  EXPECT_EQ(set["name"], "The farm");
  EXPECT_EQ(set["format"], "png");
  EXPECT_EQ(set["max_zoom"], 3);
  EXPECT_EQ(set["grows"], true);
  EXPECT_EQ(set["shift_m"], Json::array({0.0, 0.0}));
  const auto tile = call("GET", "/tiles/farm/3/5/6.png");
  EXPECT_EQ(tile.status, 200u);
  EXPECT_EQ(tile.raw.body, kPng);
  EXPECT_EQ(tile.raw.header("content-type"), "image/png");
  EXPECT_EQ(
      call("GET", "/tiles/farm/3/5/6", "", "If-None-Match: " + tile.raw.header("etag") + "\r\n")
          .status,
      304u);
  EXPECT_EQ(call("GET", "/tiles/farm/2/1/1").status, 404u);
  EXPECT_EQ(call("GET", "/tiles/sea/3/5/6").status, 404u);
  const auto moved = call("PATCH", "/tiles/farm", Json{{"shift_m", {0.5, -1.25}}});
  EXPECT_EQ(moved.status, 200u);
  EXPECT_EQ(items()[0]["shift_m"], Json::array({0.5, -1.25}));
  EXPECT_EQ(call("DELETE", "/tiles/farm").status, 204u);
  EXPECT_EQ(items(), Json::array());
  EXPECT_EQ(call("DELETE", "/tiles/farm").status, 404u);
}

TEST_F(TilesApi, AFileComesInPieces) {
  const std::string whole = mbtiles();
  const std::size_t half = whole.size() / 2;
  const auto first = piece("ortho", 0, whole.size(), whole.substr(0, half));
  ASSERT_EQ(first.status, 202u) << first.body;
  EXPECT_EQ(first.body["received_bytes"], half);
  EXPECT_EQ(call("GET", "/tiles").body["unfinished"][0]["received_bytes"], half);
  EXPECT_EQ(piece("ortho", half + 1, whole.size(), "x").status, 409u);
  const auto last = piece("ortho", half, whole.size(), whole.substr(half));
  ASSERT_EQ(last.status, 201u) << last.body;
  EXPECT_EQ(last.body["name"], "Orthophoto");
  EXPECT_EQ(last.body["kept"], true);
  EXPECT_EQ(call("GET", "/tiles/ortho/3/5/6").raw.body, kPng);
  EXPECT_EQ(call("PUT", "/tiles/ortho/3/5/7", kPng, kImage).status, 409u);
}

TEST_F(TilesApi, UglyBodiesAreNamedAndNothingIsKept) {
  EXPECT_EQ(piece("ortho", 0, 9, "no tiles!").status, 400u);
  EXPECT_EQ(piece("Ortho", 0, 9, "no tiles!").status, 422u);
  EXPECT_EQ(piece("ortho", 0, 3, "no tiles!").status, 422u);
  EXPECT_EQ(call("PUT", "/tiles/ortho/file?offset=-1&size=x", "x", kBytes).body["errors"].size(),
            2u);
  EXPECT_EQ(piece("ortho", 0, 5 << 20, std::string((4 << 20) + 1, 'x')).status, 413u);
  for (const Json& body :
       {Json::object(), Json{{"set", "../x"}}, Json{{"set", "a"}, {"format", "gif"}},
        Json{{"set", "a"}, {"name", ""}}, Json{{"set", "a"}, {"color", 1}}}) {
    EXPECT_EQ(call("POST", "/tiles", body).status, 422u) << body;
  }
  make();
  EXPECT_EQ(call("POST", "/tiles", Json{{"set", "farm"}}).status, 409u);
  EXPECT_EQ(call("PUT", "/tiles/farm/3/5/6", "GIF89a", kImage).status, 415u);
  EXPECT_EQ(call("PUT", "/tiles/farm/3/8/0", kPng, kImage).status, 422u);
  EXPECT_EQ(call("PUT", "/tiles/sea/3/5/6", kPng, kImage).status, 404u);
  EXPECT_EQ(call("PUT", "/tiles/farm/3/5/6", kPng + std::string(1'000'000, ' '), kImage).status,
            413u);
  EXPECT_EQ(call("PATCH", "/tiles/farm", Json{{"shift_m", {0.5}}}).status, 422u);
  EXPECT_EQ(call("PATCH", "/tiles/farm", Json{{"shift_m", {0.5, 2000.0}}}).status, 422u);
  for (const char* wrong :
       {"/tiles/farm/3/8/0", "/tiles/farm/31/0/0", "/tiles/farm/3/-1/0", "/tiles/farm/x/0/0"}) {
    EXPECT_EQ(call("GET", wrong).status, 422u) << wrong;
  }
  EXPECT_EQ(items().size(), 1u);
  EXPECT_EQ(items()[0]["bounds"], nullptr);
}

TEST_F(TilesApi, WhatTheNetworkOffersIsTold) {
  const Json online = call("GET", "/tiles").body["online"];
  ASSERT_EQ(online.size(), 1u);
  EXPECT_EQ(online[0]["url"], "https://tiles.example.org/{z}/{x}/{y}");
  EXPECT_EQ(online[0]["max_zoom"], 20);
}

}  // namespace
}  // namespace roverd::test
