#pragma once
// Offline map tiles out of MBTiles files (MBTiles specification 1.3): SQLite files with the tables
// tiles (zoom_level, tile_column, tile_row, tile_data) and metadata (name, value). Rows are counted
// from the south there (TMS); the addresses of the interface count from the north (XYZ).
// Opened read-only. One thread at a time may use a TileFolder.

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace roverd::store {

struct TileSet {
  std::string set;     ///< short name, as in the configuration and in addresses
  std::string name;    ///< for people
  std::string format;  ///< png, jpg, webp, pbf
  int min_zoom = 0;
  int max_zoom = 0;
  std::optional<std::array<double, 4>> bounds_deg;  ///< west, south, east, north
  std::string attribution;
};

struct Tile {
  std::string bytes;
  std::string content_type;
  std::string content_encoding;  ///< "gzip" for most vector tiles, otherwise empty
};

class TileFolder {
 public:
  TileFolder();
  ~TileFolder();
  TileFolder(const TileFolder&) = delete;
  TileFolder& operator=(const TileFolder&) = delete;

  /// Opens all of them or none. Errors name the set and the file: missing, not an MBTiles file, an
  /// unknown tile format.
  base::Result<void> open(const std::map<std::string, std::filesystem::path>& sets);

  /// In alphabetical order.
  std::vector<TileSet> sets() const;

  /// XYZ numbering. Empty: no such set or tile, or the file cannot be read any more.
  std::optional<Tile> read(const std::string& set, int zoom, int x, int y);

 private:
  struct File;
  std::map<std::string, std::unique_ptr<File>> files_;
};

}  // namespace roverd::store
