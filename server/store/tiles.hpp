#pragma once
// One file of map tiles: MBTiles (specification 1.3), an SQLite file with the tables tiles
// (zoom_level, tile_column, tile_row, tile_data) and metadata (name, value). Rows are counted from
// the south there (TMS), but by some programs from the north, which is told by `scheme` or, where
// that is not said, by the bounds; the addresses of the interface count from the north (XYZ). Zooms
// and bounds are those of the tiles: what the metadata say is believed of sets too large to look
// at.
//
// Not thread-safe. A file of somebody else is opened to be read only; what it asks of SQLite is
// bounded, so that a view without end is an error and no hang.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.hpp"

namespace roverd::store {

inline constexpr int kMostZoom = 30;

struct TileSet {
  std::string set;     ///< short name, as in the configuration and in addresses
  std::string name;    ///< for people
  std::string format;  ///< png, jpg, webp, pbf
  int min_zoom = 0;
  int max_zoom = 0;
  std::optional<std::array<double, 4>> bounds_deg;  ///< west, south, east, north
  std::string attribution;
  bool kept = false;   ///< brought by people: it may be deleted; false: of the configuration
  bool grows = false;  ///< tile by tile
  std::array<double, 2> shift_m{};  ///< east, north: so much its pictures are to be moved
  std::uintmax_t bytes = 0;         ///< of its file
};

struct Tile {
  std::string bytes;
  std::string content_type;
  std::string content_encoding;  ///< "gzip" or "deflate" for most vector tiles, otherwise empty
};

/// XYZ numbering.
struct TileAddress {
  int zoom = 0;
  int x = 0;
  int y = 0;

  bool possible() const noexcept {
    const std::int64_t side = std::int64_t{1} << (zoom >= 0 && zoom <= kMostZoom ? zoom : 0);
    return zoom >= 0 && zoom <= kMostZoom && x >= 0 && y >= 0 && x < side && y < side;
  }
};

/// West, south, east, north of a tile; degrees (Web Mercator).
std::array<double, 4> bounds_of(const TileAddress& at) noexcept;
/// "png", "jpg", "webp", "pbf" by the first bytes; empty: none of them.
std::string_view format_of(std::string_view bytes) noexcept;

class TileFile {
 public:
  /// To be read. NotFound: no such file; Malformed: no MBTiles file; Unsupported: its tiles have an
  /// unknown format.
  static base::Result<std::unique_ptr<TileFile>> open(const std::string& set,
                                                      const std::filesystem::path& path);
  /// A new one, or one that was made so, to be filled tile by tile. What is put into it is there
  /// after a power cut, but for the last seconds of it. Unavailable: the disk refuses.
  static base::Result<std::unique_ptr<TileFile>> grow(const TileSet& about,
                                                      const std::filesystem::path& path);
  ~TileFile();

  const TileSet& about() const noexcept { return about_; }
  /// No tile is in it.
  bool empty();
  /// Empty: no such tile, or the file cannot be read any more.
  std::optional<Tile> read(const TileAddress& at);
  /// Replaces one that is there. Unavailable: the disk refuses, or the file is gone. Only of one
  /// that grows.
  base::Result<void> put(const TileAddress& at, std::string_view bytes);

 private:
  struct Db;
  TileFile();
  std::string describe();
  void place();
  std::int64_t row_of(const TileAddress& at) const noexcept;
  void widen(const TileAddress& at);

  std::unique_ptr<Db> db_;
  TileSet about_;
  std::string content_type_;
  bool from_north_ = false;  ///< rows are counted so in the file
};

}  // namespace roverd::store
