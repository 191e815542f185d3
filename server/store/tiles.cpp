#include "store/tiles.hpp"

#include <cstdint>
#include <sstream>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>

namespace roverd::store {

namespace {

constexpr int kMostZoom = 30;
constexpr int kBusy_ms = 200;

std::string content_type_of(const std::string& format) {
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

}  // namespace

struct TileFolder::File {
  explicit File(const std::filesystem::path& path)
      : db(path.string(), SQLite::OPEN_READONLY, kBusy_ms),
        select(db,
               "SELECT tile_data FROM tiles WHERE zoom_level = ? AND tile_column = ? AND "
               "tile_row = ?") {}

  std::string meta(const char* name) {
    SQLite::Statement row(db, "SELECT value FROM metadata WHERE name = ?");
    row.bind(1, name);
    return row.executeStep() ? row.getColumn(0).getString() : std::string{};
  }
  /// What the tiles say where the metadata are silent (the specification lets them be).
  int zoom(const char* name, const char* fallback_sql) {
    const std::string text = meta(name);
    if (!text.empty()) return std::atoi(text.c_str());
    return db.execAndGet(fallback_sql).getInt();
  }
  /// @return what is wrong with the file, or nothing.
  std::string describe(const std::string& set);

  SQLite::Database db;
  SQLite::Statement select;
  TileSet about;
  std::string content_type;
};

std::string TileFolder::File::describe(const std::string& set) {
  about.set = set;
  about.name = meta("name");
  if (about.name.empty()) about.name = set;
  about.format = meta("format");
  content_type = content_type_of(about.format);
  if (content_type.empty()) {
    return "its tiles have the unknown format \"" + about.format + "\"";
  }
  about.min_zoom = zoom("minzoom", "SELECT ifnull(min(zoom_level), 0) FROM tiles");
  about.max_zoom = zoom("maxzoom", "SELECT ifnull(max(zoom_level), 0) FROM tiles");
  about.bounds_deg = read_bounds(meta("bounds"));
  about.attribution = meta("attribution");
  return {};
}

TileFolder::TileFolder() = default;
TileFolder::~TileFolder() = default;

base::Result<void> TileFolder::open(const std::map<std::string, std::filesystem::path>& sets) {
  std::map<std::string, std::unique_ptr<File>> opened;
  for (const auto& [set, path] : sets) {
    const std::string who = "tile set " + set + ", file " + path.string() + ": ";
    std::error_code ec;
    if (!std::filesystem::is_regular_file(path, ec)) {
      return base::fail(base::Code::NotFound, who + "there is no such file");
    }
    try {
      auto file = std::make_unique<File>(path);
      if (const std::string problem = file->describe(set); !problem.empty()) {
        return base::fail(base::Code::Unsupported, who + problem);
      }
      opened.emplace(set, std::move(file));
    } catch (const SQLite::Exception& error) {
      return base::fail(base::Code::Malformed,
                        who + "not a readable MBTiles file (" + error.what() + ")");
    }
  }
  files_ = std::move(opened);
  return {};
}

std::vector<TileSet> TileFolder::sets() const {
  std::vector<TileSet> out;
  out.reserve(files_.size());
  for (const auto& [set, file] : files_) out.push_back(file->about);
  return out;
}

std::optional<Tile> TileFolder::read(const std::string& set, int zoom, int x, int y) {
  const auto found = files_.find(set);
  if (found == files_.end() || zoom < 0 || zoom > kMostZoom) return std::nullopt;
  const std::int64_t side = std::int64_t{1} << zoom;
  if (x < 0 || y < 0 || x >= side || y >= side) return std::nullopt;
  File& file = *found->second;
  try {
    file.select.reset();
    file.select.bind(1, zoom);
    file.select.bind(2, x);
    file.select.bind(3, side - 1 - y);  // from the south
    if (!file.select.executeStep()) return std::nullopt;
    Tile tile{file.select.getColumn(0).getString(), file.content_type, {}};
    if (tile.bytes.starts_with("\x1f\x8b")) tile.content_encoding = "gzip";
    file.select.reset();
    return tile;
  } catch (const SQLite::Exception&) {
    return std::nullopt;  // the file was changed or taken away under us
  }
}

}  // namespace roverd::store
