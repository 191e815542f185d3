#include "maps/shelf.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "maps/edit.hpp"
#include "maps/files.hpp"
#include "maps/solid.hpp"

namespace roverd::maps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using base::Code;
using base::Error;
using base::Result;
using nav::chart::OccupancyMap;

constexpr const char* kAbout = "about.json";
constexpr const char* kSolid = "cells.pcd";
constexpr const char* kChoice = "in_use.json";
constexpr std::uintmax_t kLargestChoice = 4096;
constexpr std::int64_t kHighest = 1'000'000'000;  ///< number of a map

auto no_such_map(std::int64_t id) {
  return base::fail(Code::NotFound, "there is no map " + std::to_string(id));
}

auto of_the_configuration() {
  return base::fail(Code::Conflict, "the map of the configuration (map.file) is changed there");
}

/// "12"; empty: no name of ours.
std::optional<std::int64_t> number_of(const std::string& name) {
  std::int64_t id = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, ec] = std::from_chars(name.data(), end, id);
  if (ec != std::errc{} || stop != end || id < 1 || id > kHighest) return std::nullopt;
  return std::to_string(id) == name ? std::optional(id) : std::nullopt;
}

base::Bytes bytes_of(const std::string& text) noexcept {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string picture_name(std::int64_t revision) {
  return "map." + std::to_string(revision) + ".pgm";
}

Result<void> write_picture(const fs::path& folder, Kept& kept, const OccupancyMap& map) {
  atlas::MapWords words = words_for(map);
  kept.mode = words.mode;
  kept.image = picture_name(kept.about.revision);
  const auto picture = atlas::picture_of(map, words);
  if (!picture) return tl::unexpected<Error>(picture.error());
  const auto file = atlas::write_pgm(*picture);
  if (auto done = replace_file(folder / kept.image, file); !done) return done;
  kept.about.size_bytes = file.size();
  return {};
}

/// Without what is forbidden, which may be long.
About brief(const About& a) {
  return {a.id,     a.name, a.created,    a.revision, a.shape,
          a.anchor, {},     a.size_bytes, a.solid,    a.problem};
}

void remove_quietly(const fs::path& path) {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

}  // namespace

Result<std::unique_ptr<Shelf>> Shelf::open(const fs::path& folder,
                                           const std::optional<Configured>& configured,
                                           std::uintmax_t leave_free) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return base::fail(Code::Unavailable, folder.string() + ": " + error.message());
  std::unique_ptr<Shelf> shelf(new Shelf(folder, leave_free));
  Result<void> read;
  if (configured) read = shelf->take_configured(*configured);
  shelf->look_through();
  shelf->recall_choice();
  shelf->part_names();
  if (read) return shelf;
  if (configured->needed && shelf->in_use_ == kConfigured) {
    return tl::unexpected<Error>(read.error());
  }
  if (shelf->in_use_ == kConfigured) shelf->in_use_.reset();
  shelf->troubles_.push_back("the map of the configuration cannot be read: " + read.error().detail);
  return shelf;
}

Result<void> Shelf::take_configured(const Configured& said) {
  configured_ = said.yaml;
  Kept& kept = maps_[kConfigured];
  kept.about.name = said.yaml.stem().string();
  kept.about.anchor = said.anchor;
  const auto map = read_map_files(said.yaml);
  if (!map) {
    kept.about.problem = map.error().detail;
    return tl::unexpected<Error>(map.error());
  }
  kept.about.solid = is_solid(said.yaml);
  kept.about.shape = map->shape();
  kept.about.size_bytes = map->cells().size();
  return {};
}

Result<void> Shelf::write_about(std::int64_t id, const Kept& kept) const {
  return replace_file(folder_of(id) / kAbout, bytes_of(about_text(kept)));
}

void Shelf::look_through() {
  std::error_code error;
  std::vector<fs::path> left_behind;
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with("new-") || name.starts_with("gone-")) left_behind.push_back(at->path());
    if (const auto id = number_of(name)) take_in(*id);
  }
  if (error) troubles_.push_back(folder_.string() + ": " + error.message());
  for (const fs::path& path : left_behind) remove_quietly(path);
}

/// One of the folder.
void Shelf::take_in(std::int64_t id) {
  next_ = std::max(next_, id + 1);  // also of one that cannot be read: it keeps its number
  const fs::path file = folder_of(id) / kAbout;
  const auto told = [&](const std::string& why) {
    troubles_.push_back("map " + std::to_string(id) + " cannot be read: " + why);
  };
  const auto text = file_bytes(file, kLargestAbout);
  if (!text) return told(text.error().detail);
  auto kept = about_from({reinterpret_cast<const char*>(text->data()), text->size()});
  if (!kept) return told(file.string() + ": " + kept.error().detail);
  std::error_code error;
  const auto size = fs::file_size(folder_of(id) / kept->image, error);
  if (error) told((folder_of(id) / kept->image).string() + ": " + error.message());
  kept->about.id = id;
  kept->about.size_bytes = error ? 0 : size;
  std::error_code none;
  if (const auto solid = fs::file_size(solid_of(id), none); !none) {
    kept->about.solid = true;
    kept->about.size_bytes += solid;
  }
  maps_.emplace(id, std::move(*kept));
  if (error) return;  // another picture may be all that is left
  // Of a change that was cut off.
  for (fs::directory_iterator at(folder_of(id), error), end; !error && at != end;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    const bool ours = name.starts_with("map.") || name.ends_with(".new");
    if (ours && name != maps_.at(id).image) remove_quietly(at->path());
  }
}

/// Of a choice that cannot hold any more none is in use: another map would be another place.
void Shelf::recall_choice() {
  if (maps_.contains(kConfigured)) in_use_ = kConfigured;
  const fs::path file = folder_ / kChoice;
  std::error_code error;
  if (!fs::exists(file, error)) return;
  in_use_.reset();
  const auto text = file_bytes(file, kLargestChoice);
  const Json json = text ? Json::parse(text->begin(), text->end(), nullptr, false) : Json();
  const auto chosen = json.is_object() ? json.find("map") : json.end();
  if (!json.is_object() || chosen == json.end() ||
      !(chosen->is_null() || chosen->is_number_integer())) {
    troubles_.push_back(file.string() + " cannot be read: no map is in use");
    return;
  }
  if (chosen->is_null()) return;
  const auto id = chosen->get<std::int64_t>();
  if (maps_.contains(id)) {
    in_use_ = id;
  } else {
    if (id > 0 && id < kHighest)
      next_ = std::max(next_, id + 1);  // no other one is what was chosen
    troubles_.push_back("map " + std::to_string(id) +
                        ", which was in use, is gone: no map is in use");
  }
}

fs::path Shelf::folder_of(std::int64_t id) const {
  return folder_ / std::to_string(id);
}

std::vector<About> Shelf::list() const {
  const std::lock_guard lock(index_);
  std::vector<About> out;
  out.reserve(maps_.size());
  for (const auto& [id, kept] : maps_) out.push_back(brief(kept.about));
  return out;
}

std::optional<Shelf::Label> Shelf::label_of(std::int64_t id) const {
  const std::lock_guard lock(index_);
  const auto at = maps_.find(id);
  if (at == maps_.end()) return std::nullopt;
  return Label{at->second.about.name, at->second.about.revision};
}

Result<Kept> Shelf::kept(std::int64_t id) const {
  const std::lock_guard lock(index_);
  const auto at = maps_.find(id);
  if (at == maps_.end()) return no_such_map(id);
  return at->second;
}

Result<About> Shelf::find(std::int64_t id) const {
  auto found = kept(id);
  if (!found) return tl::unexpected<Error>(found.error());
  return std::move(found->about);
}

Result<About> Shelf::look(std::int64_t id) const {
  auto found = find(id);
  if (found) found->problem = problem_of(id);
  return found;
}

std::vector<About> Shelf::look() const {
  std::vector<About> out = list();
  for (About& about : out) about.problem = problem_of(about.id);
  return out;
}

/// Whether its files are there; of the configured one also what was wrong with them at the start.
std::string Shelf::problem_of(std::int64_t id) const {
  fs::path file = configured_;
  std::string known;
  {
    const std::lock_guard lock(index_);
    const auto at = maps_.find(id);
    if (at == maps_.end()) return {};  // it went meanwhile
    known = at->second.about.problem;
    if (id != kConfigured) file = folder_of(id) / at->second.image;
  }
  std::error_code error;
  (void)fs::file_size(file, error);
  return error ? file.string() + ": " + error.message() : known;
}

/// With the disk held.
Result<OccupancyMap> Shelf::cells_of(std::int64_t id, const Kept& kept) const {
  // Whoever asks has sent nothing wrong, and asks for a map that there is.
  const auto refuse = [](const std::string& why) { return base::fail(Code::Unavailable, why); };
  if (id == kConfigured) {
    auto map = read_map_files(configured_);
    if (map) return map;
    return refuse(map.error().detail);
  }
  const fs::path file = folder_of(id) / kept.image;
  const auto bytes = file_bytes(file, kLargestPicture);
  if (!bytes) return refuse(bytes.error().detail);
  const auto picture = atlas::read_pgm(*bytes);
  auto map = picture ? atlas::map_of(kept.words(), *picture)
                     : Result<OccupancyMap>(tl::unexpected<Error>(picture.error()));
  if (map) return map;
  return refuse(file.string() + ": " + map.error().detail);
}

/// A cell becomes a byte. A disk that cannot be asked refuses by itself.
Result<void> Shelf::has_room(std::size_t cells) const {
  std::error_code error;
  const fs::space_info disk = fs::space(folder_, error);
  if (error || disk.available >= leave_free_ + cells) return {};
  return base::fail(Code::Unavailable,
                    "the disk is almost full: " + std::to_string(disk.available / 1'000'000) +
                        " MB are free, and a map leaves " +
                        std::to_string(leave_free_ / 1'000'000) + " of them");
}

Result<OccupancyMap> Shelf::read(std::int64_t id) const {
  const std::lock_guard disk(disk_);
  const auto found = kept(id);
  if (!found) return tl::unexpected<Error>(found.error());
  return cells_of(id, *found);
}

/// Its file, whether it is there or not.
fs::path Shelf::solid_of(std::int64_t id) const {
  return id == kConfigured ? configured_ : folder_of(id) / kSolid;
}

Result<std::shared_ptr<const nav::cells::CellMap>> Shelf::read_solid(std::int64_t id) const {
  const std::lock_guard disk(disk_);
  const auto found = kept(id);
  if (!found) return tl::unexpected<Error>(found.error());
  if (!found->about.solid) return nullptr;
  auto solid = maps::read_solid(solid_of(id));
  if (!solid) return base::fail(Code::Unavailable, solid.error().detail);
  return std::make_shared<const nav::cells::CellMap>(std::move(*solid));
}

Result<std::vector<std::uint8_t>> Shelf::solid_file(std::int64_t id) const {
  const std::lock_guard disk(disk_);
  const auto found = kept(id);
  if (!found) return tl::unexpected<Error>(found.error());
  if (!found->about.solid) {
    return base::fail(Code::Conflict, "the map is one of the plane: it has no third dimension");
  }
  auto bytes = file_bytes(solid_of(id), kLargestSolid);
  if (!bytes) return base::fail(Code::Unavailable, bytes.error().detail);
  return bytes;
}

Result<About> Shelf::add(std::string name, const OccupancyMap& map,
                         const std::optional<Anchor>& anchor, base::WallTime now, base::Bytes solid,
                         IfTaken if_taken) {
  const std::lock_guard disk(disk_);
  if (if_taken == IfTaken::Number) name = free_name(name);
  if (auto free = is_free(name); !free) return tl::unexpected<Error>(free.error());
  if (auto room = has_room(map.cells().size() + solid.size()); !room)
    return tl::unexpected<Error>(room.error());
  Kept made;
  {
    const std::lock_guard lock(index_);
    if (maps_.size() >= kMostMaps) {
      return base::fail(Code::Conflict,
                        std::to_string(kMostMaps) + " maps are kept already: delete one first");
    }
    made.about.id = next_++;
  }
  made.about.name = std::move(name);
  made.about.created = now;
  made.about.shape = map.shape();
  made.about.anchor = anchor;
  const fs::path begun = folder_ / ("new-" + std::to_string(made.about.id));
  const auto give_up = [&begun](Error why) {
    remove_quietly(begun);
    return tl::unexpected<Error>(std::move(why));
  };
  std::error_code error;
  fs::create_directory(begun, error);
  if (error) return give_up({Code::Unavailable, begun.string() + ": " + error.message(), {}});
  if (auto done = write_picture(begun, made, map); !done) return give_up(done.error());
  if (!solid.empty()) {
    if (auto done = replace_file(begun / kSolid, solid); !done) return give_up(done.error());
    made.about.solid = true;
    made.about.size_bytes += solid.size();
  }
  if (auto done = replace_file(begun / kAbout, bytes_of(about_text(made))); !done) {
    return give_up(done.error());
  }
  fs::rename(begun, folder_of(made.about.id), error);
  if (error) return give_up({Code::Unavailable, begun.string() + ": " + error.message(), {}});
  sync_folder(folder_);
  const std::lock_guard lock(index_);
  maps_[made.about.id] = made;
  return std::move(made.about);
}

/// With the disk held. @param after what the change does not name is set already
Result<void> Shelf::write_change(std::int64_t id, const Kept& before, Kept& after,
                                 const Change& change) const {
  const bool cells =
      std::ranges::any_of(change.edits, [](const Edit& e) { return e.kind != Edit::Kind::Forbid; });
  if (cells) {
    auto map = cells_of(id, before);
    if (!map) return tl::unexpected<Error>(map.error());
    for (const Edit& e : change.edits) edit(*map, e);
    if (auto done = write_picture(folder_of(id), after, *map); !done) return done;
    std::error_code none;
    const auto solid = fs::file_size(solid_of(id), none);
    if (before.about.solid && !none) after.about.size_bytes += solid;
  }
  auto done = write_about(id, after);
  if (cells) remove_quietly(folder_of(id) / (done ? before : after).image);
  return done;
}

Result<About> Shelf::change(std::int64_t id, const Change& change) {
  if (id == kConfigured && kept(id)) return of_the_configuration();
  const std::lock_guard disk(disk_);
  const auto before = kept(id);
  if (!before) return tl::unexpected<Error>(before.error());
  if (change.of_revision && *change.of_revision != before->about.revision) {
    return base::fail(Code::Conflict, "the map was changed meanwhile");
  }
  if (change.name) {
    if (auto free = is_free(*change.name, id); !free) return tl::unexpected<Error>(free.error());
  }
  for (std::size_t i = 0; i < change.edits.size(); ++i) {
    if (!lies_outside(before->about.shape, change.edits[i].area)) continue;
    const std::string at = "/edits/" + std::to_string(i) + "/polygon";
    const std::string detail = "lies outside of the map: it would change nothing";
    return base::fail(Code::Invalid, at + " " + detail, {{at, detail}});
  }
  Kept after = *before;
  ++after.about.revision;
  if (change.name) after.about.name = *change.name;
  if (change.changes_anchor) after.about.anchor = change.anchor;
  if (change.forbidden) after.about.forbidden = *change.forbidden;
  for (const Edit& e : change.edits) {
    if (e.kind == Edit::Kind::Forbid) after.about.forbidden.push_back(e.area);
  }
  if (after.about.forbidden.size() > kMostForbidden) {
    const std::string detail = "a map has at most " + std::to_string(kMostForbidden) + " areas";
    return base::fail(Code::Invalid, detail, {{"/edits", detail}});
  }
  if (auto done = write_change(id, *before, after, change); !done) {
    return tl::unexpected<Error>(done.error());
  }
  const std::lock_guard lock(index_);
  maps_[id] = after;
  return std::move(after.about);
}

Result<void> Shelf::remove(std::int64_t id) {
  if (id == kConfigured && kept(id)) return of_the_configuration();
  const std::lock_guard disk(disk_);
  const fs::path gone = folder_ / ("gone-" + std::to_string(id));
  Kept taken;
  {
    const std::lock_guard lock(index_);
    const auto at = maps_.find(id);
    if (at == maps_.end()) return no_such_map(id);
    if (in_use_ == id) {
      return base::fail(Code::Conflict, "the map is in use: use another one, or none, first");
    }
    taken = std::move(at->second);  // from now on nobody can choose it
    maps_.erase(at);
  }
  std::error_code error;
  fs::rename(folder_of(id), gone, error);
  if (error && error != std::errc::no_such_file_or_directory) {
    const std::lock_guard lock(index_);
    maps_.emplace(id, std::move(taken));
    return base::fail(Code::Unavailable, folder_of(id).string() + ": " + error.message());
  }
  sync_folder(folder_);
  remove_quietly(gone);
  return {};
}

std::optional<std::int64_t> Shelf::in_use() const {
  const std::lock_guard lock(index_);
  return in_use_;
}

Result<void> Shelf::choose(std::optional<std::int64_t> id) {
  const std::lock_guard lock(index_);
  if (id && !maps_.contains(*id)) return no_such_map(*id);
  in_use_ = id;
  return {};
}

Result<void> Shelf::keep_choice() const {
  const std::lock_guard disk(disk_);
  const auto id = in_use();
  const std::string text = Json{{"map", id ? Json(*id) : Json(nullptr)}}.dump() + "\n";
  return replace_file(folder_ / kChoice, bytes_of(text));
}

}  // namespace roverd::maps
