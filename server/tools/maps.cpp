#include "tools/maps.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "atlas/carmen.hpp"
#include "atlas/map_files.hpp"
#include "atlas/unpack.hpp"
#include "base/angle.hpp"
#include "nav/cells/align.hpp"
#include "nav/cells/map_file.hpp"
#include "nav/mapping/mapper.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;
using Blob = std::vector<std::uint8_t>;

constexpr std::uintmax_t kLargest_bytes = std::uintmax_t{1} << 30U;
constexpr std::size_t kBlock_bytes = 65'536;

base::Error named(const std::filesystem::path& file, base::Error error) {
  error.detail = file.string() + ": " + error.detail;
  return error;
}

base::Result<Blob> bytes_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return base::fail(base::Code::NotFound, file.string() + ": " + error.message());
  if (size > kLargest_bytes) {
    return base::fail(base::Code::TooLarge, file.string() + ": larger than 1 GB");
  }
  Blob out(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
  if (!in) return base::fail(base::Code::NotFound, file.string() + ": cannot be read");
  return out;
}

base::Result<nav::cells::Relief> relief_of(const std::filesystem::path& file, double cell_m) {
  const auto bytes = bytes_of(file);
  if (!bytes) return tl::unexpected<base::Error>(bytes.error());
  const auto map = nav::cells::read_map(*bytes, cell_m);
  if (!map) return tl::unexpected<base::Error>(named(file, map.error()));
  return nav::cells::Relief(*map);
}

Json rows_of(const Eigen::Matrix4d& m) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < 4; ++i) rows.push_back({m(i, 0), m(i, 1), m(i, 2), m(i, 3)});
  return rows;
}

/// Square roots of three of the diagonal's.
Json deviations(const nav::cells::Matrix6d& covariance, Eigen::Index from, double unit) {
  Json out = Json::array();
  for (Eigen::Index i = from; i < from + 3; ++i) out.push_back(unit * std::sqrt(covariance(i, i)));
  return out;
}

/// The log through the mapper, block by block.
base::Result<void> drive(const std::filesystem::path& log, nav::mapping::Mapper& mapper) {
  base::Result<void> taken;
  atlas::CarmenReader reader([&](const atlas::CarmenScan& s) {
    if (taken) taken = mapper.add(atlas::scan_of(s, {}), s.odometry);
  });
  atlas::Unpacker unpacker([&](base::Bytes part) { reader.feed(part); });
  std::ifstream in(log, std::ios::binary);
  if (!in) return base::fail(base::Code::NotFound, "cannot be read");
  Blob block(kBlock_bytes);
  while (in && taken) {
    in.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    const auto got = static_cast<std::size_t>(in.gcount());
    if (auto fed = unpacker.feed(base::Bytes(block).first(got)); !fed) return fed;
  }
  if (!taken) return taken;
  if (auto ended = unpacker.finish(); !ended) return ended;
  reader.finish();
  if (taken && reader.scans() == 0) {
    return base::fail(
        base::Code::Malformed,
        "holds no scan" +
            (reader.first_refused().empty() ? std::string() : "; " + reader.first_refused()));
  }
  mapper.finish();
  return taken;
}

base::Result<void> write_file(const std::filesystem::path& file, base::Bytes bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) return base::fail(base::Code::Unavailable, file.string() + ": cannot be written");
  return {};
}

std::filesystem::path with_ending(std::filesystem::path name, const char* ending) {
  return name += ending;
}

base::Result<void> write_map_files(const nav::chart::OccupancyMap& map,
                                   const std::filesystem::path& into) {
  const auto image = with_ending(into, ".pgm");
  atlas::MapWords words;
  words.image = image.filename().string();
  words.resolution_m = map.resolution_m();
  words.origin = map.shape().origin;
  const auto picture = atlas::picture_of(map, words);
  if (!picture) return tl::unexpected<base::Error>(picture.error());
  if (auto written = write_file(image, atlas::write_pgm(*picture)); !written) return written;
  const std::string text = atlas::write_words(words);
  return write_file(with_ending(into, ".yaml"),
                    {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

int told(const base::Result<Json>& result, bool (*good)(const Json&)) {
  if (!result) {
    std::fprintf(stderr, "roverd: %s\n", result.error().detail.c_str());
    return result.error().code == base::Code::Unavailable ? 1 : 2;
  }
  std::printf("%s\n", result->dump(2).c_str());
  return good(*result) ? 0 : 1;
}

}  // namespace

base::Result<Json> aligned(const AlignCommand& c) {
  const auto source = relief_of(c.source, c.cell_m);
  if (!source) return tl::unexpected<base::Error>(source.error());
  const auto target = relief_of(c.target, c.cell_m);
  if (!target) return tl::unexpected<base::Error>(target.error());
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.linear() = Eigen::AngleAxisd(base::rad_from_deg(c.start_yaw_deg), Eigen::Vector3d::UnitZ())
                       .toRotationMatrix();
  start.translation() = Eigen::Vector3d(c.start_x_m, c.start_y_m, c.start_z_m);
  nav::cells::AlignParams params;
  params.search_m = c.search_m;
  const auto a = nav::cells::align(*source, *target, start, params);
  Json out;
  out["verdict"] = std::string(nav::cells::to_string(a.verdict));
  out["matrix"] = rows_of(a.x_ts.matrix());
  out["deviation_m"] = deviations(a.covariance, 0, 1.0);
  out["deviation_deg"] = deviations(a.covariance, 3, base::deg_from_rad(1.0));
  out["overlap"] = a.overlap;
  out["upright"] = a.upright;
  out["fit_m"] = a.fit_m;
  out["rival"] = a.rival;
  out["cells"] = {source->surfels().size(), target->surfels().size()};
  return out;
}

base::Result<Json> mapped(const MapCommand& c) {
  nav::mapping::Mapper mapper;
  if (auto driven = drive(c.log, mapper); !driven) {
    return tl::unexpected<base::Error>(named(c.log, driven.error()));
  }
  const auto map = mapper.draw({.resolution_m = c.resolution_m});
  if (!map) return tl::unexpected<base::Error>(named(c.log, map.error()));
  if (auto written = write_map_files(*map, c.into); !written) {
    return tl::unexpected<base::Error>(written.error());
  }
  const auto counts = mapper.counts();
  double way_m = 0.0;
  const auto path = mapper.path();
  for (std::size_t i = 1; i < path.size(); ++i) {
    way_m += std::hypot(path[i].x_m - path[i - 1].x_m, path[i].y_m - path[i - 1].y_m);
  }
  return Json{{"scans", counts.scans},     {"nodes", counts.nodes}, {"loops", counts.loops},
              {"dropped", counts.dropped}, {"unfit", counts.unfit}, {"way_m", way_m},
              {"columns", map->columns()}, {"rows", map->rows()}};
}

int align_clouds(const AlignCommand& c) {
  return told(aligned(c), [](const Json& j) { return j["verdict"] == "good"; });
}

int make_map(const MapCommand& c) {
  return told(mapped(c), [](const Json&) { return true; });
}

}  // namespace roverd
