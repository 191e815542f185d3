#include "store/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

namespace roverd::store {

namespace {

using base::Code;
using base::Result;

constexpr int kTilesBusy_ms = 200;
// No tile is larger, whatever a file says that somebody made up.
constexpr int kMostValue_bytes = 64 << 20;
/// Steps of SQLite's machine between two looks, and how many looks one question may last. To count
/// the zooms of a million tiles without an index takes 20 million steps.
constexpr int kStride = 100'000;
constexpr int kMostStrides = 500;
/// For what the metadata say as well: of a set so large that this is too little they are believed.
constexpr int kFewStrides = 100;

std::string small_letters(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

/// One of ours, for how people write it: "PNG", "image/png"; what is not known stays as it is.
std::string plain_format(std::string said) {
  said = small_letters(std::move(said));
  if (said.starts_with("image/")) said.erase(0, 6);
  if (said == "jpeg") return "jpg";
  if (said == "mvt" || said == "application/vnd.mapbox-vector-tile" ||
      said == "application/x-protobuf") {
    return "pbf";
  }
  return said;
}

std::string content_type_of(std::string_view format) {
  if (format == "png") return "image/png";
  if (format == "jpg") return "image/jpeg";
  if (format == "webp") return "image/webp";
  if (format == "pbf") return "application/vnd.mapbox-vector-tile";
  return {};
}

using Bounds = std::array<double, 4>;

/// What both hold; empty: they have no ground in common.
std::optional<Bounds> common(const Bounds& a, const Bounds& b) {
  const Bounds out = {std::max(a[0], b[0]), std::max(a[1], b[1]), std::min(a[2], b[2]),
                      std::min(a[3], b[3])};
  if (!(out[0] < out[2] && out[1] < out[3])) return std::nullopt;
  return out;
}

/// What holds both.
Bounds hull(const Bounds& a, const Bounds& b) {
  return {std::min(a[0], b[0]), std::min(a[1], b[1]), std::max(a[2], b[2]), std::max(a[3], b[3])};
}

/// "24.5,58.2,24.9,58.5"; empty unless it is four numbers in range, west before east and south
/// before north.
std::optional<Bounds> read_bounds(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  Bounds out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    char comma = ',';
    if (i > 0 && !(in >> comma)) return std::nullopt;
    if (comma != ',' || !(in >> out[i])) return std::nullopt;
    const double limit_deg = i % 2 == 0 ? 180.0 : 90.0;
    if (!(out[i] >= -limit_deg && out[i] <= limit_deg)) return std::nullopt;
  }
  if (!(out[0] < out[2] && out[1] < out[3])) return std::nullopt;
  return out;
}

/// Where tiles of a zoom lie. @param seen first and last column, first and last row of the file
/// @param from_north its rows are counted so
std::optional<Bounds> bounds_between(int zoom, const std::array<int, 4>& seen, bool from_north) {
  const std::int64_t last = (std::int64_t{1} << zoom) - 1;
  if (std::ranges::any_of(seen, [last](int at) { return at < 0 || at > last; })) {
    return std::nullopt;
  }
  const auto& [west, east, first, end] = seen;
  const int whole = static_cast<int>(last);
  const auto a = bounds_of({zoom, west, from_north ? first : whole - end});
  const auto b = bounds_of({zoom, east, from_north ? end : whole - first});
  return Bounds{a[0], b[1], b[2], a[3]};
}

/// Are the coarse tiles those that hold the fine ones, and no more? Then the fine ones tell more
/// closely where all lie: a tile of zoom 0 is the whole earth. @param zooms between them
bool is_pyramid(const std::array<int, 4>& coarse, const std::array<int, 4>& fine, int zooms) {
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    if (fine[i] >> zooms != coarse[i]) return false;
  }
  return true;
}

/// RFC 1950: deflate, and a check of the first two bytes.
bool is_zlib(std::string_view bytes) noexcept {
  if (bytes.size() < 2) return false;
  const auto first = static_cast<unsigned char>(bytes[0]);
  const auto second = static_cast<unsigned char>(bytes[1]);
  return (first & 0x0FU) == 8U && first <= 0x78U && (first * 256U + second) % 31U == 0;
}

int is_over(void* strides_left) {
  return --*static_cast<int*>(strides_left) < 0 ? 1 : 0;
}

}  // namespace

std::array<double, 4> bounds_of(const TileAddress& at) noexcept {
  const double side = std::ldexp(1.0, at.zoom);
  const auto east = [side](double x) { return x / side * 360.0 - 180.0; };
  const auto north = [side](double y) {
    return std::atan(std::sinh(std::numbers::pi * (1.0 - 2.0 * y / side))) * 180.0 /
           std::numbers::pi;
  };
  return {east(at.x), north(at.y + 1.0), east(at.x + 1.0), north(at.y)};
}

std::string_view format_of(std::string_view bytes) noexcept {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return "png";
  if (bytes.starts_with("\xff\xd8\xff"sv)) return "jpg";
  if (bytes.starts_with("RIFF"sv) && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP"sv) {
    return "webp";
  }
  if (bytes.starts_with("\x1f\x8b"sv)) return "pbf";
  return {};
}

struct TileFile::Db {
  Db(const std::filesystem::path& path, int flags)
      : file(path), db(path.string(), flags, kTilesBusy_ms) {
    db.exec("PRAGMA trusted_schema = OFF");
    sqlite3_limit(db.getHandle(), SQLITE_LIMIT_LENGTH, kMostValue_bytes);
    sqlite3_progress_handler(db.getHandle(), kStride, is_over, &strides_left);
  }
  std::string meta(const char* name) {
    strides_left = kMostStrides;
    SQLite::Statement row(db, "SELECT value FROM metadata WHERE name = ?");
    row.bind(1, name);
    return row.executeStep() ? row.getColumn(0).getString() : std::string{};
  }
  void tell(const char* name, const std::string& value) {
    SQLite::Statement row(db, "INSERT INTO metadata (name, value) VALUES (?, ?)");
    row.bind(1, name);
    row.bind(2, value);
    row.exec();
  }
  int number(const char* sql, int strides = kMostStrides) {
    strides_left = strides;
    return db.execAndGet(sql).getInt();
  }
  /// `ask(strides)`, of which the metadata say something, too; empty: there is too much to look at.
  template <class Ask>
  auto if_cheap(Ask ask) -> std::optional<decltype(ask(0))> {
    try {
      return ask(kFewStrides);
    } catch (const SQLite::Exception& error) {
      if (error.getErrorCode() != SQLITE_INTERRUPT) throw;
      return std::nullopt;
    }
  }
  /// The tiles' own; what the metadata say is often of another state of the file, and is believed
  /// where there are too many tiles to look at.
  int zoom(const char* name, const char* sql) {
    const auto found = if_cheap([&](int strides) { return number(sql, strides); });
    const std::string said = found ? std::string() : meta(name);
    const int is = found ? *found : said.empty() ? number(sql) : std::atoi(said.c_str());
    return std::clamp(is, 0, kMostZoom);
  }
  /// What the first tile is, for whoever wrote no format (the specification wants it, many files
  /// have none). Empty: there is no tile, or it is nothing known.
  std::string first_format() {
    strides_left = kMostStrides;
    SQLite::Statement row(db, "SELECT tile_data FROM tiles WHERE length(tile_data) > 0 LIMIT 1");
    return row.executeStep() ? std::string(format_of(row.getColumn(0).getString())) : std::string{};
  }
  /// First and last column, first and last row of a zoom, as the file counts them; empty: it has
  /// no tiles.
  std::optional<std::array<int, 4>> extent(int zoom, int strides) {
    strides_left = strides;
    SQLite::Statement row(db,
                          "SELECT min(tile_column), max(tile_column), min(tile_row), "
                          "max(tile_row) FROM tiles WHERE zoom_level = ?");
    row.bind(1, zoom);
    if (!row.executeStep() || row.getColumn(0).isNull()) return std::nullopt;
    return std::array{row.getColumn(0).getInt(), row.getColumn(1).getInt(),
                      row.getColumn(2).getInt(), row.getColumn(3).getInt()};
  }
  std::uintmax_t bytes() const {
    std::error_code ec;
    const auto size = std::filesystem::file_size(file, ec);
    return ec ? 0 : size;
  }

  std::filesystem::path file;
  int strides_left = kMostStrides;
  SQLite::Database db;
  std::optional<SQLite::Statement> select;
  std::optional<SQLite::Statement> insert;
};

TileFile::TileFile() = default;
TileFile::~TileFile() = default;

std::string TileFile::describe() {
  Db& db = *db_;
  db.select.emplace(db.db,
                    "SELECT tile_data FROM tiles WHERE zoom_level = ? AND tile_column = ? AND "
                    "tile_row = ?");
  about_.name = db.meta("name");
  if (about_.name.empty()) about_.name = about_.set;
  about_.format = plain_format(db.meta("format"));
  if (content_type_of(about_.format).empty()) {
    if (const std::string shown = db.first_format(); !shown.empty()) about_.format = shown;
  }
  content_type_ = content_type_of(about_.format);
  if (content_type_.empty()) {
    if (about_.format.empty())
      return "it does not say the format of its tiles, and they do not show it";
    return "its tiles have the unknown format \"" + about_.format + "\"";
  }
  about_.min_zoom = db.zoom("minzoom", "SELECT ifnull(min(zoom_level), 0) FROM tiles");
  about_.max_zoom = db.zoom("maxzoom", "SELECT ifnull(max(zoom_level), 0) FROM tiles");
  place();
  about_.attribution = db.meta("attribution");
  about_.bytes = db.bytes();
  return {};
}

/// Where its tiles lie, and which way their rows are counted. Many programs write rows from the
/// north, which the specification has no word for, and say so in `scheme` or nowhere: then the
/// bounds tell it by the deepest zoom, the smallest tiles. Bounds that are of somewhere else say
/// nothing.
void TileFile::place() {
  Db& db = *db_;
  const auto said = read_bounds(db.meta("bounds"));
  const int zoom = about_.max_zoom;
  auto extent = db.if_cheap([&](int strides) { return db.extent(zoom, strides); });
  if (!extent && !said) extent = db.extent(zoom, kMostStrides);
  const std::string scheme = small_letters(db.meta("scheme"));
  from_north_ = scheme == "xyz";
  about_.bounds_deg = said;
  if (!extent || !*extent) return;
  const auto seen = [&](bool from_north) { return bounds_between(zoom, **extent, from_north); };
  const auto fits = [&](bool from_north) {
    const auto tiles = seen(from_north);
    return said && tiles ? common(*said, *tiles) : std::nullopt;
  };
  if (scheme.empty() && !fits(false) && fits(true)) from_north_ = true;
  // All of the deepest zoom may be one corner of what the others show.
  const int least = about_.min_zoom;
  const auto coarse = db.if_cheap([&](int strides) { return db.extent(least, strides); });
  const auto deepest = seen(from_north_);
  auto all = deepest;
  if (coarse && *coarse && zoom >= least && !is_pyramid(**coarse, **extent, zoom - least)) {
    const auto wide = bounds_between(least, **coarse, from_north_);
    if (wide) all = deepest ? hull(*wide, *deepest) : *wide;
  }
  const auto both = said && all && fits(from_north_) ? common(*said, *all) : std::nullopt;
  about_.bounds_deg = both ? both : all ? all : deepest;
}

Result<std::unique_ptr<TileFile>> TileFile::open(const std::string& set,
                                                 const std::filesystem::path& path) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(path, ec)) {
    return base::fail(Code::NotFound, "there is no such file");
  }
  std::unique_ptr<TileFile> out(new TileFile);
  out->about_.set = set;
  try {
    out->db_ = std::make_unique<Db>(path, SQLite::OPEN_READONLY);
    if (const std::string wrong = out->describe(); !wrong.empty()) {
      return base::fail(Code::Unsupported, wrong);
    }
  } catch (const SQLite::Exception& error) {
    return base::fail(Code::Malformed,
                      "not a readable MBTiles file (" + std::string(error.what()) + ")");
  }
  return out;
}

Result<std::unique_ptr<TileFile>> TileFile::grow(const TileSet& about,
                                                 const std::filesystem::path& path) {
  std::unique_ptr<TileFile> out(new TileFile);
  out->about_.set = about.set;
  try {
    out->db_ = std::make_unique<Db>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    Db& db = *out->db_;
    db.db.exec("PRAGMA journal_mode = WAL");
    db.db.exec("PRAGMA synchronous = NORMAL");
    if (!db.db.tableExists("tiles")) {
      SQLite::Transaction whole(db.db);
      db.db.exec("CREATE TABLE metadata (name TEXT, value TEXT)");
      db.db.exec(
          "CREATE TABLE tiles (zoom_level INTEGER, tile_column INTEGER, tile_row INTEGER, "
          "tile_data BLOB)");
      db.db.exec("CREATE UNIQUE INDEX tile ON tiles (zoom_level, tile_column, tile_row)");
      db.tell("name", about.name);
      db.tell("format", about.format);
      db.tell("attribution", about.attribution);
      whole.commit();
    }
    if (const std::string wrong = out->describe(); !wrong.empty()) {
      return base::fail(Code::Unsupported, wrong);
    }
    db.insert.emplace(db.db, "INSERT OR REPLACE INTO tiles VALUES (?, ?, ?, ?)");
    out->about_.grows = true;
  } catch (const SQLite::Exception& error) {
    return base::fail(Code::Unavailable, error.what());
  }
  return out;
}

std::int64_t TileFile::row_of(const TileAddress& at) const noexcept {
  return from_north_ ? at.y : (std::int64_t{1} << at.zoom) - 1 - at.y;
}

std::optional<Tile> TileFile::read(const TileAddress& at) {
  if (!at.possible()) return std::nullopt;
  try {
    SQLite::Statement& select = *db_->select;
    db_->strides_left = kMostStrides;
    select.reset();
    select.bind(1, at.zoom);
    select.bind(2, at.x);
    select.bind(3, row_of(at));
    if (!select.executeStep()) return std::nullopt;
    Tile tile{select.getColumn(0).getString(), content_type_, {}};
    if (tile.bytes.starts_with("\x1f\x8b")) tile.content_encoding = "gzip";
    if (about_.format == "pbf" && is_zlib(tile.bytes)) tile.content_encoding = "deflate";
    select.reset();
    return tile;
  } catch (const SQLite::Exception&) {
    return std::nullopt;  // the file was changed or taken away under us
  }
}

bool TileFile::empty() {
  try {
    return db_->number("SELECT count(*) FROM (SELECT 1 FROM tiles LIMIT 1)") == 0;
  } catch (const SQLite::Exception&) {
    return true;
  }
}

Result<void> TileFile::put(const TileAddress& at, std::string_view bytes) {
  std::error_code ec;
  if (!std::filesystem::exists(db_->file, ec)) {  // SQLite would write into what nobody finds again
    return base::fail(Code::Unavailable, "its file " + db_->file.filename().string() + " is gone");
  }
  try {
    SQLite::Statement& insert = *db_->insert;
    db_->strides_left = kMostStrides;
    insert.reset();
    insert.bind(1, at.zoom);
    insert.bind(2, at.x);
    insert.bind(3, row_of(at));
    insert.bindNoCopy(4, bytes.data(), static_cast<int>(bytes.size()));
    insert.exec();
    insert.clearBindings();
  } catch (const SQLite::Exception& error) {
    return base::fail(Code::Unavailable, std::string("the disk refuses: ") + error.what());
  }
  widen(at);
  return {};
}

void TileFile::widen(const TileAddress& at) {
  const bool first = !about_.bounds_deg;
  about_.min_zoom = first ? at.zoom : std::min(about_.min_zoom, at.zoom);
  const auto tile = bounds_of(at);
  if (first || at.zoom > about_.max_zoom) {
    about_.bounds_deg = tile;
    about_.max_zoom = at.zoom;
  } else if (at.zoom == about_.max_zoom) {
    auto& all = *about_.bounds_deg;
    all = {std::min(all[0], tile[0]), std::min(all[1], tile[1]), std::max(all[2], tile[2]),
           std::max(all[3], tile[3])};
  }
  about_.bytes = db_->bytes();
}

}  // namespace roverd::store
