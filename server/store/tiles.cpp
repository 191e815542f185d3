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

std::string content_type_of(std::string_view format) {
  if (format == "png") return "image/png";
  if (format == "jpg" || format == "jpeg") return "image/jpeg";
  if (format == "webp") return "image/webp";
  if (format == "pbf") return "application/vnd.mapbox-vector-tile";
  return {};
}

/// "24.5,58.2,24.9,58.5"; empty unless it is four numbers in range.
std::optional<std::array<double, 4>> read_bounds(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::array<double, 4> out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    char comma = ',';
    if (i > 0 && !(in >> comma)) return std::nullopt;
    if (comma != ',' || !(in >> out[i])) return std::nullopt;
    const double limit_deg = i % 2 == 0 ? 180.0 : 90.0;
    if (!(out[i] >= -limit_deg && out[i] <= limit_deg)) return std::nullopt;
  }
  return out;
}

/// From the south.
std::int64_t row_of(const TileAddress& at) {
  return (std::int64_t{1} << at.zoom) - 1 - at.y;
}

int is_over(void* strides) {
  return ++*static_cast<int*>(strides) > kMostStrides ? 1 : 0;
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
    sqlite3_progress_handler(db.getHandle(), kStride, is_over, &strides);
  }
  std::string meta(const char* name) {
    strides = 0;
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
  int number(const char* sql) {
    strides = 0;
    return db.execAndGet(sql).getInt();
  }
  /// What the tiles say where the metadata are silent (the specification lets them be).
  int zoom(const char* name, const char* fallback_sql) {
    const std::string text = meta(name);
    const int said = text.empty() ? number(fallback_sql) : std::atoi(text.c_str());
    return std::clamp(said, 0, kMostZoom);
  }
  /// What the first tile is, for whoever wrote no format (the specification wants it, many files
  /// have none). Empty: there is no tile, or it is nothing known.
  std::string first_format() {
    strides = 0;
    SQLite::Statement row(db, "SELECT tile_data FROM tiles WHERE length(tile_data) > 0 LIMIT 1");
    return row.executeStep() ? std::string(format_of(row.getColumn(0).getString())) : std::string{};
  }
  /// Around all tiles of the deepest zoom; empty: there are none.
  std::optional<std::array<double, 4>> extent(int zoom) {
    strides = 0;
    SQLite::Statement row(db,
                          "SELECT min(tile_column), max(tile_column), min(tile_row), "
                          "max(tile_row) FROM tiles WHERE zoom_level = ?");
    row.bind(1, zoom);
    if (!row.executeStep() || row.getColumn(0).isNull()) return std::nullopt;
    const int last = static_cast<int>((std::int64_t{1} << zoom) - 1);
    const TileAddress north_west{zoom, row.getColumn(0).getInt(), last - row.getColumn(3).getInt()};
    const TileAddress south_east{zoom, row.getColumn(1).getInt(), last - row.getColumn(2).getInt()};
    if (!north_west.possible() || !south_east.possible()) return std::nullopt;
    const auto a = bounds_of(north_west);
    const auto b = bounds_of(south_east);
    return std::array{a[0], b[1], b[2], a[3]};
  }
  std::uintmax_t bytes() const {
    std::error_code ec;
    const auto size = std::filesystem::file_size(file, ec);
    return ec ? 0 : size;
  }

  std::filesystem::path file;
  int strides = 0;
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
  about_.format = db.meta("format");
  if (about_.format.empty()) about_.format = db.first_format();
  content_type_ = content_type_of(about_.format);
  if (content_type_.empty()) {
    if (about_.format.empty())
      return "it does not say the format of its tiles, and they do not show it";
    return "its tiles have the unknown format \"" + about_.format + "\"";
  }
  about_.min_zoom = db.zoom("minzoom", "SELECT ifnull(min(zoom_level), 0) FROM tiles");
  about_.max_zoom = db.zoom("maxzoom", "SELECT ifnull(max(zoom_level), 0) FROM tiles");
  about_.bounds_deg = read_bounds(db.meta("bounds"));
  if (!about_.bounds_deg) about_.bounds_deg = db.extent(about_.max_zoom);
  about_.attribution = db.meta("attribution");
  about_.bytes = db.bytes();
  return {};
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

std::optional<Tile> TileFile::read(const TileAddress& at) {
  if (!at.possible()) return std::nullopt;
  try {
    SQLite::Statement& select = *db_->select;
    db_->strides = 0;
    select.reset();
    select.bind(1, at.zoom);
    select.bind(2, at.x);
    select.bind(3, row_of(at));
    if (!select.executeStep()) return std::nullopt;
    Tile tile{select.getColumn(0).getString(), content_type_, {}};
    if (tile.bytes.starts_with("\x1f\x8b")) tile.content_encoding = "gzip";
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
    db_->strides = 0;
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
