#pragma once
// The maps that this robot keeps, and which of them is in use.
//
//   FOLDER/3/about.json      name, anchor, what is forbidden, and which picture holds
//   FOLDER/3/map.2.pgm       the cells, of revision 2
//   FOLDER/3/cells.pcd       its third dimension, where it has one; no edit changes it
//   FOLDER/in_use.json       what a person chose; no such file: the map of the configuration
//
// A change writes a new picture beside the old one, then about.json in one step: after a power cut
// one of both holds. Each map has a name of its own, the configured one that of its file: of those
// that were kept before this was asked for, all but one get another name when it is opened. A map
// is made in a folder of another name (new-3), which is then renamed; one that goes is renamed
// first (gone-3). What such folders were left behind goes with the next start.
//
// Any thread. Whoever reads or writes cells waits for the disk, and for others who do: not on the
// web thread, nor on control's. list(), find() and the choice touch no disk, but keep_choice().

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "maps/about_file.hpp"
#include "maps/words.hpp"
#include "nav/cells/cell_map.hpp"
#include "nav/chart/map.hpp"

namespace roverd::maps {

/// What configuration says: not to be changed here.
struct Configured {
  std::filesystem::path yaml;
  std::optional<Anchor> anchor;
  bool needed = true;  ///< false: where it cannot be read that is told, and no error
};

/// What a new map leaves free on the disk, which recordings and the robot's records share.
inline constexpr std::uintmax_t kLeaveFree = 300'000'000;

class Shelf {
 public:
  /// Makes the folder where it is missing, and looks through it. A map that cannot be read is left
  /// where it is, and told in troubles(); so is the one of the configuration while another one, or
  /// none, was chosen. Errors: Unavailable (the system's reason, of the folder); any other code:
  /// what is wrong with the files of the configuration, with their name.
  /// @param leave_free bytes that a new map leaves on the disk
  static base::Result<std::unique_ptr<Shelf>> open(const std::filesystem::path& folder,
                                                   const std::optional<Configured>& configured,
                                                   std::uintmax_t leave_free = kLeaveFree);

  /// What was wrong when it was opened, one sentence each.
  const std::vector<std::string>& troubles() const noexcept { return troubles_; }

  /// By their numbers, the configured one first; without what is forbidden.
  std::vector<About> list() const;
  /// What is cheap to ask for often. Empty: there is no such map.
  struct Label {
    std::string name;
    std::int64_t revision = 0;
  };
  std::optional<Label> label_of(std::int64_t id) const;
  /// NotFound.
  base::Result<About> find(std::int64_t id) const;
  /// The same, and look whether the files are still there: `problem` of each.
  base::Result<About> look(std::int64_t id) const;
  std::vector<About> look() const;

  /// The cells as a scanner would see them. NotFound: no such map. Unavailable: its files are gone,
  /// or cannot be read any more.
  base::Result<nav::chart::OccupancyMap> read(std::int64_t id) const;

  /// Its third dimension; null: it has none. The same errors.
  base::Result<std::shared_ptr<const nav::cells::CellMap>> read_solid(std::int64_t id) const;
  /// The same as the file that is kept. Conflict: it has none.
  base::Result<std::vector<std::uint8_t>> solid_file(std::int64_t id) const;

  /// Conflict: a map is called so.
  base::Result<void> is_free(const std::string& name) const;
  /// @param name one that people may give
  /// @param solid its third dimension as a PCD file; empty: it has none
  /// @return Conflict: kMostMaps are kept, or another map is called so; Unavailable: the disk
  /// refuses, or is almost full, and nothing was kept
  base::Result<About> add(std::string name, const nav::chart::OccupancyMap& map,
                          const std::optional<Anchor>& anchor, base::WallTime now,
                          base::Bytes solid = {}, IfTaken if_taken = IfTaken::Refuse);
  /// All of it or nothing. NotFound; Conflict: of the configuration, of another revision, or
  /// another map is called so; Invalid: too many areas, or an edit outside of the map; Unavailable.
  base::Result<About> change(std::int64_t id, const Change& change);
  /// NotFound; Conflict: in use, or of the configuration; Unavailable.
  base::Result<void> remove(std::int64_t id);

  /// The one in use; empty: none.
  std::optional<std::int64_t> in_use() const;
  /// Remembers it; kept over a restart with keep_choice(). NotFound, and nothing changes.
  base::Result<void> choose(std::optional<std::int64_t> id);
  /// What is chosen then goes to the disk. Unavailable.
  base::Result<void> keep_choice() const;

 private:
  static constexpr std::int64_t kNoMap = -1;
  Shelf(std::filesystem::path folder, std::uintmax_t leave_free)
      : folder_(std::move(folder)), leave_free_(leave_free) {}
  base::Result<void> take_configured(const Configured& said);
  void look_through();
  void recall_choice();
  void part_names();
  void call_otherwise(std::int64_t id, std::int64_t namesake);
  std::optional<std::int64_t> namesake_of(const std::string& name, std::int64_t but = kNoMap) const;
  base::Result<void> is_free(const std::string& name, std::int64_t but) const;
  std::string free_name(const std::string& wanted) const;
  std::string problem_of(std::int64_t id) const;
  base::Result<void> has_room(std::size_t cells) const;
  void take_in(std::int64_t id);
  std::filesystem::path folder_of(std::int64_t id) const;
  std::filesystem::path solid_of(std::int64_t id) const;
  base::Result<Kept> kept(std::int64_t id) const;
  base::Result<nav::chart::OccupancyMap> cells_of(std::int64_t id, const Kept& kept) const;
  base::Result<void> write_about(std::int64_t id, const Kept& kept) const;
  base::Result<void> write_change(std::int64_t id, const Kept& before, Kept& after,
                                  const Change& change) const;

  const std::filesystem::path folder_;
  const std::uintmax_t leave_free_;
  std::filesystem::path configured_;  ///< yaml; empty: none
  std::vector<std::string> troubles_;
  mutable std::mutex disk_;   ///< before index_
  mutable std::mutex index_;  ///< leaf
  std::map<std::int64_t, Kept> maps_;
  std::optional<std::int64_t> in_use_;
  std::int64_t next_ = 1;
};

}  // namespace roverd::maps
