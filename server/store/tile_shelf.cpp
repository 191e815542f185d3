#include "store/tile_shelf.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace roverd::store {

namespace {

namespace fs = std::filesystem;
using base::Code;
using base::Result;
using Json = nlohmann::json;

constexpr std::string_view kSent = ".up.mbtiles";
constexpr std::string_view kOwn = ".own.mbtiles";
constexpr double kMostShift_m = 1000.0;
constexpr std::size_t kMostTileName = 100;

struct Handle {
  int fd;
  ~Handle() {
    if (fd >= 0) ::close(fd);
  }
};

tl::unexpected<base::Error> disk_refuses() {
  return base::fail(Code::Unavailable, std::string("the disk refuses: ") + std::strerror(errno));
}

Result<void> to_disk(const fs::path& file) {
  const Handle handle{::open(file.c_str(), O_RDONLY | O_CLOEXEC)};
  if (handle.fd < 0 || ::fsync(handle.fd) != 0) return disk_refuses();
  return {};
}

/// Of a set, whatever there is.
void delete_files(const fs::path& folder, const std::string& set) {
  std::error_code ignored;
  for (const std::string_view end : {kSent, kOwn}) {
    const std::string file = (folder / set).string() + std::string(end);
    for (const char* more : {"", "-wal", "-shm", "-journal"}) fs::remove(file + more, ignored);
  }
  fs::remove(folder / (set + ".part"), ignored);
  fs::remove(folder / (set + ".json"), ignored);
}

/// What people said of it; a file that cannot be read says nothing.
void read_words(const fs::path& file, TileSet& about) {
  std::ifstream in(file);
  const Json said = Json::parse(in, nullptr, false);
  if (!said.is_object()) return;
  const auto name = said.find("name");
  if (name != said.end() && name->is_string()) about.name = name->get<std::string>();
  const auto shift = said.find("shift_m");
  if (shift == said.end() || !shift->is_array() || shift->size() != 2) return;
  for (std::size_t i = 0; i < 2; ++i) {
    const Json& metres = (*shift)[i];
    if (!metres.is_number() || !(std::abs(metres.get<double>()) <= kMostShift_m)) return;
  }
  about.shift_m = {(*shift)[0].get<double>(), (*shift)[1].get<double>()};
}

Result<void> write_words(const fs::path& file, const TileSet& about) {
  fs::path next = file;
  next += ".new";
  {
    std::ofstream out(next, std::ios::trunc);
    out << Json{{"name", about.name}, {"shift_m", about.shift_m}}.dump() << '\n';
    if (!out.flush()) return disk_refuses();
  }
  if (auto done = to_disk(next); !done) return done;
  if (::rename(next.c_str(), file.c_str()) != 0) return disk_refuses();
  return {};
}

}  // namespace

bool is_tile_set_name(std::string_view name) noexcept {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  return !name.empty() && name.size() <= 40 && std::ranges::all_of(name, fits);
}

Result<std::unique_ptr<TileShelf>> TileShelf::open(const fs::path& folder,
                                                   const Configured& configured,
                                                   std::uintmax_t leave_free) {
  std::unique_ptr<TileShelf> out(new TileShelf(folder, leave_free));
  for (const auto& [set, path] : configured) {
    auto file = TileFile::open(set, path);
    if (!file) {
      return base::fail(file.error().code,
                        "tile set " + set + ", file " + path.string() + ": " + file.error().detail);
    }
    out->tell(set, std::move(*file));
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    return base::fail(Code::Unavailable, folder.string() + ": " + error.message());
  }
  out->look_through();
  return out;
}

void TileShelf::look_through() {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename().string();
    const std::string set = name.substr(0, name.find('.'));
    if (!is_tile_set_name(set)) continue;
    if (name.ends_with(kSent) || name.ends_with(kOwn)) take_in(set, entry.path());
    if (name == set + ".part") {
      const auto size = entry.file_size(error);
      parts_[set] = error ? 0 : size;
    }
  }
}

void TileShelf::take_in(const std::string& set, const fs::path& path) {
  const std::string who = "the tiles " + path.filename().string() + " are left out: ";
  if (files_.contains(set)) {
    troubles_.push_back(who + "there is another set " + set);
    return;
  }
  TileSet about;
  about.set = set;
  const bool own = path.string().ends_with(kOwn);
  auto file = own ? TileFile::grow(about, path) : TileFile::open(set, path);
  if (!file) {
    troubles_.push_back(who + file.error().detail);
    return;
  }
  tell(set, std::move(*file));
  sets_[set].kept = true;
}

/// Under disk_. From now on it is listed.
void TileShelf::tell(const std::string& set, std::unique_ptr<TileFile> file) {
  TileSet about = file->about();
  read_words(folder_ / (set + ".json"), about);
  files_[set] = std::move(file);
  std::lock_guard lock(index_);
  sets_[set] = std::move(about);
}

std::vector<TileSet> TileShelf::sets() const {
  std::lock_guard lock(index_);
  std::vector<TileSet> out;
  out.reserve(sets_.size());
  for (const auto& [set, about] : sets_) out.push_back(about);
  return out;
}

std::vector<Unfinished> TileShelf::unfinished() const {
  std::lock_guard lock(index_);
  std::vector<Unfinished> out;
  for (const auto& [set, bytes] : parts_) out.push_back({set, bytes});
  return out;
}

std::optional<Tile> TileShelf::read(const std::string& set, const TileAddress& at) {
  std::lock_guard lock(disk_);
  const auto found = files_.find(set);
  return found == files_.end() ? std::nullopt : found->second->read(at);
}

Result<void> TileShelf::has_room(std::uintmax_t bytes) const {
  std::error_code error;
  const fs::space_info disk = fs::space(folder_, error);
  if (error || disk.available >= leave_free_ + bytes) return {};
  return base::fail(Code::Unavailable, "the disk has only " +
                                           std::to_string(disk.available / 1'000'000) +
                                           " MB free; map tiles leave " +
                                           std::to_string(leave_free_ / 1'000'000) + " of them");
}

Result<TileSet> TileShelf::create(const TileSet& about) {
  std::lock_guard lock(disk_);
  if (files_.contains(about.set)) {
    return base::fail(Code::Conflict, "there is a set " + about.set + " already");
  }
  if (files_.size() >= kMostTileSets) {
    return base::fail(Code::Conflict,
                      "there are " + std::to_string(kMostTileSets) + " sets: delete one first");
  }
  if (auto room = has_room(0); !room) return tl::unexpected(room.error());
  auto file = TileFile::grow(about, folder_ / (about.set + std::string(kOwn)));
  if (!file) {
    delete_files(folder_, about.set);
    return tl::unexpected(file.error());
  }
  tell(about.set, std::move(*file));
  std::lock_guard index(index_);
  TileSet& listed = sets_[about.set];
  listed.kept = true;
  return listed;
}

Result<void> TileShelf::put(const std::string& set, const TileAddress& at, std::string_view bytes) {
  std::lock_guard lock(disk_);
  const auto found = files_.find(set);
  if (found == files_.end()) return base::fail(Code::NotFound, "there is no set " + set);
  TileFile& file = *found->second;
  if (!file.about().grows) {
    return base::fail(Code::Conflict, "the set " + set + " is a whole file: it takes no tiles");
  }
  if (!at.possible()) return base::fail(Code::Invalid, "there is no such tile address");
  if (format_of(bytes) != file.about().format) {
    return base::fail(Code::Unsupported,
                      "it is no " + file.about().format + ", of which the set " + set + " is");
  }
  if (auto room = has_room(bytes.size()); !room) return room;
  if (auto done = file.put(at, bytes); !done) return done;
  std::lock_guard index(index_);
  TileSet& listed = sets_[set];
  const TileSet& now = file.about();
  listed.min_zoom = now.min_zoom;
  listed.max_zoom = now.max_zoom;
  listed.bounds_deg = now.bounds_deg;
  listed.bytes = now.bytes;
  return {};
}

Result<void> TileShelf::append(const std::string& set, const TilePiece& piece) {
  std::error_code none;
  const fs::path part = part_of(set);
  const std::uintmax_t have = fs::exists(part, none) ? fs::file_size(part, none) : 0;
  if (piece.offset != 0 && piece.offset != have) {
    return base::fail(Code::Conflict, "the next byte of " + set + " is " + std::to_string(have) +
                                          ", not " + std::to_string(piece.offset));
  }
  if (auto room = has_room(piece.offset == 0 ? piece.size : piece.bytes.size()); !room) return room;
  std::ofstream out(part, piece.offset == 0 ? std::ios::binary | std::ios::trunc
                                            : std::ios::binary | std::ios::app);
  out.write(piece.bytes.data(), static_cast<std::streamsize>(piece.bytes.size()));
  const bool written = static_cast<bool>(out.flush());
  out.close();
  if (!written) fs::resize_file(part, piece.offset, none);  // what came before holds
  std::lock_guard lock(index_);
  parts_[set] = piece.offset + (written ? piece.bytes.size() : 0);
  return written ? Result<void>{} : disk_refuses();
}

Result<std::optional<TileSet>> TileShelf::take(const std::string& set, const TilePiece& piece) {
  std::lock_guard lock(disk_);
  const auto there = files_.find(set);
  if (there != files_.end()) {
    std::lock_guard index(index_);
    if (!sets_[set].kept) {
      return base::fail(Code::Conflict, "the set " + set + " is of the configuration");
    }
  } else if (files_.size() >= kMostTileSets) {
    return base::fail(Code::Conflict,
                      "there are " + std::to_string(kMostTileSets) + " sets: delete one first");
  }
  if (piece.size > kMostTileFile || piece.offset > piece.size ||
      piece.bytes.size() > piece.size - piece.offset || piece.bytes.empty()) {
    return base::fail(Code::Invalid, "the piece is empty, or reaches beyond the file's end",
                      {{"size", "must be the length of the whole file, at most " +
                                    std::to_string(kMostTileFile)}});
  }
  if (auto done = append(set, piece); !done) return tl::unexpected(done.error());
  if (piece.offset + piece.bytes.size() < piece.size) return std::nullopt;
  return finish(set);
}

Result<std::optional<TileSet>> TileShelf::finish(const std::string& set) {
  const fs::path part = part_of(set);
  const auto forget = [&] {
    std::error_code ignored;
    fs::remove(part, ignored);
    std::lock_guard lock(index_);
    parts_.erase(set);
  };
  auto seen = TileFile::open(set, part);
  if (seen && (*seen)->empty()) seen = base::fail(Code::Malformed, "there is no tile in it");
  if (!seen) {
    forget();
    return tl::unexpected(seen.error());
  }
  seen->reset();
  if (auto done = to_disk(part); !done) return tl::unexpected(done.error());
  const fs::path whole = folder_ / (set + std::string(kSent));
  const auto before = files_.find(set);
  const bool replaces_own = before != files_.end() && before->second->about().grows;
  if (::rename(part.c_str(), whole.c_str()) != 0) return disk_refuses();
  files_.erase(set);  // closed before its file goes
  if (replaces_own) {
    std::error_code ignored;
    const std::string own = (folder_ / set).string() + std::string(kOwn);
    for (const char* more : {"", "-wal", "-shm"}) fs::remove(own + more, ignored);
  }
  forget();
  auto file = TileFile::open(set, whole);
  if (!file) return tl::unexpected(file.error());
  tell(set, std::move(*file));
  std::lock_guard lock(index_);
  TileSet& listed = sets_[set];
  listed.kept = true;
  return listed;
}

Result<TileSet> TileShelf::change(const std::string& set, const TileChange& change) {
  std::lock_guard lock(disk_);
  TileSet next;
  {
    std::lock_guard index(index_);
    const auto found = sets_.find(set);
    if (found == sets_.end()) return base::fail(Code::NotFound, "there is no set " + set);
    next = found->second;
  }
  if (!is_tile_set_name(set)) {  // of the configuration: it would be the name of a file here
    return base::fail(Code::Conflict,
                      "the set " + set + " needs a name of a-z, 0-9, - and _ first");
  }
  std::vector<base::FieldError> wrong;
  if (change.name) {
    if (change.name->empty() || change.name->size() > kMostTileName) {
      wrong.push_back({"name", "must have 1 to " + std::to_string(kMostTileName) + " bytes"});
    }
    next.name = *change.name;
  }
  if (change.shift_m) {
    for (const double metres : *change.shift_m) {
      if (std::abs(metres) <= kMostShift_m) continue;
      wrong.push_back({"shift_m", "must be metres to the east and to the north, up to 1000"});
      break;
    }
    next.shift_m = *change.shift_m;
  }
  if (!wrong.empty()) return base::fail(Code::Invalid, "it cannot be so", std::move(wrong));
  if (auto done = write_words(folder_ / (set + ".json"), next); !done) {
    return tl::unexpected(done.error());
  }
  std::lock_guard index(index_);
  return sets_[set] = next;
}

Result<void> TileShelf::remove(const std::string& set) {
  std::lock_guard lock(disk_);
  {
    std::lock_guard index(index_);
    const auto found = sets_.find(set);
    if (found == sets_.end() && !parts_.contains(set)) {
      return base::fail(Code::NotFound, "there is no set " + set);
    }
    if (found != sets_.end() && !found->second.kept) {
      return base::fail(Code::Conflict, "the set " + set + " is of the configuration");
    }
    sets_.erase(set);
    parts_.erase(set);
  }
  files_.erase(set);
  delete_files(folder_, set);
  std::error_code ignored;
  for (const std::string_view end : {kSent, kOwn}) {
    if (fs::exists((folder_ / set).string() + std::string(end), ignored)) return disk_refuses();
  }
  return {};
}

}  // namespace roverd::store
