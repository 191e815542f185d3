#pragma once
// The sets of map tiles: those of the configuration, and those that people brought.
//
//   FOLDER/farm.up.mbtiles    a whole file that was sent
//   FOLDER/farm.own.mbtiles   filled tile by tile
//   FOLDER/farm.part          a file that is being sent, as far as it came
//   FOLDER/farm.json          how people call it, and how far its pictures are to be moved
//
// Any thread. What reads or writes waits for the disk, and for others who do: not on the web
// thread. sets() and unfinished() touch no disk.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "store/tiles.hpp"

namespace roverd::store {

/// What a change leaves free on the disk, which recordings and the robot's records share.
inline constexpr std::uintmax_t kTilesLeaveFree = 300'000'000;
inline constexpr std::size_t kMostTileSets = 100;
inline constexpr std::size_t kMostTileBytes = 1'000'000;  ///< of one tile
inline constexpr std::uintmax_t kMostTileFile = 64'000'000'000;

struct Unfinished {
  std::string set;
  std::uintmax_t received_bytes = 0;
};

/// A piece of a file that is being sent.
struct TilePiece {
  std::uintmax_t offset = 0;  ///< 0 begins anew
  std::uintmax_t size = 0;    ///< of the whole file
  std::string_view bytes;
};

struct TileChange {
  std::optional<std::string> name;
  std::optional<std::array<double, 2>> shift_m;
};

/// Lower case letters, digits, "-" and "_"; up to 40.
bool is_tile_set_name(std::string_view name) noexcept;

class TileShelf {
 public:
  using Configured = std::map<std::string, std::filesystem::path>;

  /// Makes the folder where it is missing. Errors name the set and the file of the configuration:
  /// missing, not an MBTiles file, an unknown tile format. A file in the folder that cannot be read
  /// is left where it is, and told in troubles(); so is one whose name the configuration took.
  static base::Result<std::unique_ptr<TileShelf>> open(const std::filesystem::path& folder,
                                                       const Configured& configured,
                                                       std::uintmax_t leave_free = kTilesLeaveFree);

  const std::vector<std::string>& troubles() const noexcept { return troubles_; }

  /// In alphabetical order.
  std::vector<TileSet> sets() const;
  std::vector<Unfinished> unfinished() const;

  /// Empty: no such set or tile, or the file cannot be read any more.
  std::optional<Tile> read(const std::string& set, const TileAddress& at);

  /// An empty one, to be filled. Conflict: there is one of that name, or as many as may be;
  /// Unavailable: the disk refuses.
  base::Result<TileSet> create(const TileSet& about);
  /// Replaces one that is there. NotFound: no such set; Conflict: it does not grow; Invalid: no
  /// such address; Unsupported: another format than the set's; Unavailable: the disk refuses, or is
  /// almost full.
  base::Result<void> put(const std::string& set, const TileAddress& at, std::string_view bytes);
  /// The next piece of a file. With the last one the file is looked at, and taken in place of the
  /// one that was there; what cannot be is deleted.
  /// @return the set, once it is whole
  /// @throws nothing; Conflict: the piece does not follow what came (see unfinished()), or the set
  /// is of the configuration; Malformed, Unsupported: it is no file of map tiles; Invalid: the
  /// piece is longer than the file; Unavailable: the disk
  base::Result<std::optional<TileSet>> take(const std::string& set, const TilePiece& piece);
  /// NotFound; Conflict: its name is none for a file; Invalid; Unavailable.
  base::Result<TileSet> change(const std::string& set, const TileChange& change);
  /// What was brought, or came in part. NotFound; Conflict: it is of the configuration.
  base::Result<void> remove(const std::string& set);

 private:
  TileShelf(std::filesystem::path folder, std::uintmax_t leave_free)
      : folder_(std::move(folder)), leave_free_(leave_free) {}
  std::filesystem::path part_of(const std::string& set) const { return folder_ / (set + ".part"); }
  void look_through();
  void take_in(const std::string& set, const std::filesystem::path& path);
  void tell(const std::string& set, std::unique_ptr<TileFile> file);
  base::Result<void> has_room(std::uintmax_t bytes) const;
  base::Result<std::optional<TileSet>> finish(const std::string& set);
  base::Result<void> append(const std::string& set, const TilePiece& piece);

  const std::filesystem::path folder_;
  const std::uintmax_t leave_free_;
  std::vector<std::string> troubles_;
  mutable std::mutex disk_;                                 ///< before index_
  mutable std::mutex index_;                                ///< leaf
  std::map<std::string, std::unique_ptr<TileFile>> files_;  ///< under disk_
  std::map<std::string, TileSet> sets_;                     ///< under index_
  std::map<std::string, std::uintmax_t> parts_;             ///< under index_
};

}  // namespace roverd::store
