// KMZ, in and out, and what others may have put into an archive.

#include <gtest/gtest.h>
#include <zip.h>

#include "mission/formats/formats.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

/// An archive of such entries, deflated.
std::string archive_of(const std::vector<std::pair<std::string, std::string>>& entries) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* memory = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_source_keep(memory);
  zip_t* archive = zip_open_from_source(memory, ZIP_TRUNCATE, &error);
  for (const auto& [name, content] : entries) {
    zip_source_t* text = zip_source_buffer(archive, content.data(), content.size(), 0);
    EXPECT_GE(zip_file_add(archive, name.c_str(), text, 0), 0);
  }
  EXPECT_EQ(zip_close(archive), 0);
  zip_stat_t size;
  zip_stat_init(&size);
  zip_source_stat(memory, &size);
  std::string out(size.size, '\0');
  zip_source_open(memory);
  zip_source_read(memory, out.data(), out.size());
  zip_source_close(memory);
  zip_source_free(memory);
  return out;
}

std::string kml_with(const std::string& coordinates) {
  return "<kml><Placemark><LineString><coordinates>" + coordinates +
         "</coordinates></LineString></Placemark></kml>";
}

TEST(Kmz, SurvivesARoundTrip) {
  Plan plan;
  plan.name = "Põld";
  for (int i = 0; i < 100; ++i) plan.items.emplace_back(waypoint_at(58.0 + i * 1e-5, 26.0));
  const ExportedFile file = export_file(plan, Format::Kmz);
  EXPECT_TRUE(file.binary);
  EXPECT_EQ(file.file_name, "P_ld.kmz");
  EXPECT_EQ(file.content, export_file(plan, Format::Kmz).content);

  const auto back = import_file(file.content, std::nullopt);

  ASSERT_TRUE(back) << back.error().detail;
  EXPECT_EQ(back->format, Format::Kmz);
  EXPECT_EQ(back->plan.items, plan.items);
}

TEST(Kmz, TheDocumentIsFoundAmongOtherFiles) {
  const auto file = import_file(archive_of({{"images/a.png", "x"},
                                            {"../../etc/evil.kml", kml_with("1,2 3,4 5,6")},
                                            {"doc.kml", kml_with("26,58 27,58")}}),
                                std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->plan.items.size(), 2u);
  // A name that leads elsewhere is a name: nothing is ever written.
  EXPECT_EQ(import_file(archive_of({{"../../etc/evil.KML", kml_with("1,2 3,4 5,6")}}), std::nullopt)
                ->plan.items.size(),
            3u);
}

//   As GDAL writes it: the first document links to one of each layer.
TEST(Kmz, LinksAreFollowedInsideOfTheArchive) {
  const auto link = [](const std::string& to) {
    return "<NetworkLink><Link><href>" + to + "</href></Link></NetworkLink>";
  };
  const auto file = import_file(
      archive_of({{"doc.kml", "<kml><Document>" + link("layers/a.kml") + link("./layers/a.kml#x") +
                                  link("https://example.org/b.kml") + link("doc.kml") +
                                  "</Document></kml>"},
                  {"layers/a.kml", kml_with("26,58 26.001,58 26.002,58")}}),
      std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->plan.items.size(), 3u);
  EXPECT_TRUE(file->more.empty());
  std::string told;
  for (const FileRow& row : file->rows) {
    told += row.row + " " + (row.outcome == Outcome::LeftOut ? row.reason : "taken") + "\n";
  }
  EXPECT_EQ(told,
            "layers/a.kml, line 1, coordinate 1 taken\n"
            "layers/a.kml, line 1, coordinate 2 taken\n"
            "layers/a.kml, line 1, coordinate 3 taken\n"
            "line 1 what it links to is not in the archive\n"
            "line 1 what it links to is not in the archive\n");
  // A document alone has no archive.
  EXPECT_EQ(import_file("<kml><Document>" + link("a.kml") + "</Document></kml>", std::nullopt)
                .error()
                .detail,
            "the file has no position that could be driven to: its NetworkLink leads to another "
            "file, which is not read");
}

TEST(Kmz, AFewBytesBehindTheEndDoNoHarm) {
  const std::string archive = archive_of({{"doc.kml", kml_with("26,58 26.001,58")}});
  for (const std::string& tail :
       {std::string("\n"), std::string("\r\n\0\0", 4), std::string(100, '\0')}) {
    const auto file = import_file(archive + tail, std::nullopt);
    ASSERT_TRUE(file) << file.error().detail;
    EXPECT_EQ(file->plan.items.size(), 2u);
  }
}

//   As a program leaves it that does not know yet what will come: checksum and sizes stand behind
//   the entry and in the directory at the end.
TEST(Kmz, HeadersThatWereWrittenBeforeTheirEntriesMayBeOpen) {
  std::string archive = archive_of({{"doc.kml", kml_with("26,58 26.001,58")}});
  for (std::size_t i = 14; i < 26; ++i) archive[i] = '\0';
  const auto file = import_file(archive, std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->plan.items.size(), 2u);
}

TEST(Kmz, BombsAndDamageAreRefused) {
  const std::string bomb =
      archive_of({{"doc.kml", kml_with(std::string(std::size_t{80} << 20, ' '))}});
  ASSERT_LT(bomb.size(), std::size_t{200'000});
  EXPECT_EQ(import_file(bomb, std::nullopt).error().code, base::Code::TooLarge);

  std::vector<std::pair<std::string, std::string>> many;
  for (int i = 0; i < 1001; ++i) many.emplace_back("f" + std::to_string(i), "x");
  EXPECT_FALSE(import_file(archive_of(many), std::nullopt));
  EXPECT_FALSE(import_file(archive_of({{"readme.txt", "x"}}), std::nullopt));
  EXPECT_EQ(
      import_file(archive_of({{"doc.kml", "<!DOCTYPE a [<!ENTITY b \"c\">]><kml/>"}}), std::nullopt)
          .error()
          .fields.at(0)
          .pointer,
      "line 1");

  const std::string good = archive_of({{"doc.kml", kml_with("26,58 27,58")}});
  for (std::size_t length = 0; length < good.size(); ++length) {
    EXPECT_FALSE(import_file(good.substr(0, length), Format::Kmz)) << length;
  }
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x41);
    (void)import_file(bad, Format::Kmz);  // refused or read, never worse
  }
}

}  // namespace
}  // namespace roverd::mission
