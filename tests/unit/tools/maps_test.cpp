// roverd align and roverd map.

#include "tools/maps.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "atlas/map_files.hpp"
#include "atlas/unpack.hpp"
#include "real_data.hpp"

namespace roverd {
namespace {

std::filesystem::path own_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "roverd-maps-XXXXXX").string();
  return mkdtemp(name.data());
}

/// A corner of three walls and a step, as text.
void write_corner(const std::filesystem::path& file, double x_m) {
  std::ofstream out(file);
  out << "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 12000\nHEIGHT 1\nDATA ascii\n";
  for (int i = 0; i < 3000; ++i) {
    const double u = (i % 60) * 0.1;
    const double v = (i / 60) * 0.1;
    out << u - x_m << " " << v << " 0\n" << u - x_m << " 0 " << v << "\n";
    out << -x_m << " " << u << " " << v << "\n";
    out << 3.0 + 0.3 * u - x_m << " " << 2.0 + 0.1 * u << " " << 0.4 * v << "\n";
  }
}

TEST(Align, SaysWhereAndHowSure) {
  const auto folder = own_folder();
  write_corner(folder / "target.pcd", 0.0);
  write_corner(folder / "source.pcd", 0.4);
  AlignCommand command;
  command.source = folder / "source.pcd";
  command.target = folder / "target.pcd";
  const auto out = aligned(command);
  ASSERT_TRUE(out) << out.error().detail;
  EXPECT_EQ((*out)["verdict"], "good") << out->dump(2);
  EXPECT_NEAR((*out)["matrix"][0][3].get<double>(), 0.4, 0.02);
  EXPECT_NEAR((*out)["matrix"][1][3].get<double>(), 0.0, 0.02);
  EXPECT_GT((*out)["deviation_m"][0].get<double>(), 0.005);
  EXPECT_GT((*out)["overlap"].get<double>(), 0.9);
  std::filesystem::remove_all(folder);
}

TEST(Align, NamesTheFileThatIsNoCloud) {
  const auto folder = own_folder();
  std::ofstream(folder / "no.pcd") << "FIELDS a\nWIDTH 0\nHEIGHT 0\nDATA ascii\n";
  AlignCommand command;
  command.source = folder / "no.pcd";
  EXPECT_EQ(aligned(command).error().detail, (folder / "no.pcd").string() + ": PCD has no field x");
  command.source = folder / "none.pcd";
  EXPECT_EQ(aligned(command).error().code, base::Code::NotFound);
  EXPECT_EQ(align_clouds(command), 2);
  std::filesystem::remove_all(folder);
}

TEST(Map, RefusesALogWithoutAScan) {
  const auto folder = own_folder();
  std::ofstream(folder / "empty.log") << "# nothing\nFLASER 2 1\n";
  MapCommand command;
  command.log = folder / "empty.log";
  command.into = folder / "map";
  const auto out = mapped(command);
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().detail.find("holds no scan; line 2"), std::string::npos)
      << out.error().detail;
  EXPECT_FALSE(std::filesystem::exists(folder / "map.pgm"));
  std::filesystem::remove_all(folder);
}

TEST(MapRealData, AnOfficeAsTheMapServerKeepsIt) {
  ROVERD_REAL_DATA(path, "sensors/carmen/intel-corrected.log.gz");
  const auto folder = own_folder();
  // The first minutes of it: the whole is a test of its own.
  std::string log;
  atlas::Unpacker unpacker([&](base::Bytes part) { log.append(part.begin(), part.end()); });
  ASSERT_TRUE(unpacker.feed(tests::read_file(path)));
  std::ofstream(folder / "part.log") << log.substr(0, 400'000);
  MapCommand command;
  command.log = folder / "part.log";
  command.into = folder / "office";
  command.resolution_m = 0.1;
  const auto out = mapped(command);
  ASSERT_TRUE(out) << out.error().detail;
  EXPECT_GT((*out)["scans"], 50);
  EXPECT_LT((*out)["unfit"], 3);
  EXPECT_GT((*out)["way_m"], 20.0);
  std::ifstream yaml(folder / "office.yaml");
  const std::string text((std::istreambuf_iterator<char>(yaml)), std::istreambuf_iterator<char>());
  const auto words = atlas::read_words(text);
  ASSERT_TRUE(words) << words.error().detail;
  EXPECT_EQ(words->image, "office.pgm");
  const auto picture = atlas::read_pgm(tests::read_file(folder / "office.pgm"));
  ASSERT_TRUE(picture);
  const auto map = atlas::map_of(*words, *picture);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->columns(), (*out)["columns"]);
  // The first pose is free.
  EXPECT_EQ(map->at(*map->cell_of(0.60027, -0.03203)), nav::chart::kFree);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace roverd
