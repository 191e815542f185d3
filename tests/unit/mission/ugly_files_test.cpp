// Files as they come: other encodings and line ends, spreadsheets, unknown versions, other
// coordinates, bombs. Each test names the sentence that its file is made from.

#include <gtest/gtest.h>

#include "files.hpp"
#include "mission/formats/formats.hpp"
#include "mission/json/json.hpp"

namespace roverd::mission {
namespace {

/// ASCII as UTF-16, with or without a byte order mark.
std::string utf16(const std::string& ascii, bool big, bool mark) {
  std::string out;
  const auto put = [&](unsigned char high, unsigned char low) {
    out += static_cast<char>(big ? high : low);
    out += static_cast<char>(big ? low : high);
  };
  if (mark) put(0xFE, 0xFF);
  for (const char c : ascii) put(0, static_cast<unsigned char>(c));
  return out;
}

std::string told(const std::string& text, std::optional<Format> format = std::nullopt) {
  const auto file = import_file(text, format, "");
  if (file) return "taken";
  const auto& fields = file.error().fields;
  return fields.empty() ? file.error().detail : fields[0].pointer + ": " + fields[0].detail;
}

const std::vector<LatLon> kPlaces{{58.378, 26.7289}, {58.3785, 26.729}};

// Unicode, 2.6: "UTF-16 … the byte order mark U+FEFF at the beginning"; XML 1.0, 4.3.3: "Entities
// encoded in UTF-16 MUST … begin with the Byte Order Mark".
TEST(Encodings, Utf16IsReadInEveryFormat) {
  const std::vector<std::string> texts{
      "QGC WPL 110\n0 0 3 16 0 0 0 0 58.378 26.7289 0 1\n1 0 3 16 0 0 0 0 58.3785 26.729 0 1\n",
      "lat,lon\r\n58.378,26.7289\r\n58.3785,26.729\r\n",
      R"({"type":"LineString","coordinates":[[26.7289,58.378],[26.729,58.3785]]})",
      "<?xml version=\"1.0\" encoding=\"UTF-16\"?>\n<gpx version=\"1.1\"><rte><rtept "
      "lat=\"58.378\" "
      "lon=\"26.7289\"/><rtept lat=\"58.3785\" lon=\"26.729\"/></rte></gpx>",
      "<?xml version=\"1.0\" encoding=\"UTF-16\"?><kml><LineString><coordinates>26.7289,58.378 "
      "26.729,58.3785</coordinates></LineString></kml>"};
  for (const std::string& text : texts) {
    for (const bool big : {false, true}) {
      for (const bool mark : {false, true}) {
        const auto file = import_file(utf16(text, big, mark), std::nullopt);
        ASSERT_TRUE(file) << text << file.error().detail;
        EXPECT_EQ(positions(file->plan), kPlaces) << text;
      }
    }
  }
  // A pair of surrogates, one alone, and half a unit at the end.
  std::string name = utf16("lat,lon,", false, true);
  for (const unsigned unit : {0xD83Du, 0xDE9Cu, 0xD83Du}) {
    name += static_cast<char>(unit & 0xFFu);
    name += static_cast<char>(unit >> 8u);
  }
  name += utf16("\n58,26,1\n", false, false) + "x";
  EXPECT_EQ(told(name).substr(0, 6), "line 3");  // the odd byte is a row of its own
  EXPECT_EQ(import_file(name.substr(0, name.size() - 1), std::nullopt)->rows.at(0).what,
            "column \xF0\x9F\x9A\x9C\xEF\xBF\xBD");
}

// XML 1.0, 4.3.3: "Parsed entities which are stored in an encoding other than UTF-8 or UTF-16 MUST
// begin with a text declaration".
TEST(Encodings, XmlOfOneByteACharacterIsReadAndOthersAreRefused) {
  const auto gpx = [](const std::string& encoding) {
    return "<?xml version=\"1.0\" encoding=\"" + encoding +
           "\"?><gpx><rte><name>p\xF5ld</name><rtept lat=\"58.378\" lon=\"26.7289\"/></rte></gpx>";
  };
  for (const char* encoding : {"ISO-8859-1", "windows-1252", "Windows-1257", "iso-8859-15"}) {
    const auto file = import_file(gpx(encoding), std::nullopt);
    ASSERT_TRUE(file) << file.error().detail;
    EXPECT_EQ(file->plan.name, "p\xC3\xB5ld");
  }
  EXPECT_EQ(told(gpx("Shift_JIS")), "line 1: unknown encoding");
  EXPECT_EQ(told(gpx("UTF-8")), "line 1: not well-formed (invalid token)");
}

// RFC 4180, 2.5-2.6: "Fields containing line breaks (CRLF), double quotes, and commas should be
// enclosed in double-quotes."
TEST(Tables, QuotedFieldsMayHoldSeparatorsAndLineEnds) {
  const auto file = import_file(
      "\"Name, of it\",\"Latitude\",\"Longitude\"\r\n"
      "\"the \"\"old\"\" gate,\r\nleft\",\"58.378\", \"26.7289\" \r\n"
      "barn,58.3785,26.729\r\n",
      std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(positions(file->plan), kPlaces);
  EXPECT_EQ(file->rows.at(1).row, "line 2");
  EXPECT_EQ(file->rows.at(2).row, "line 4");
  EXPECT_EQ(told("lat,lon\n58,26\n\"58,26\n58,26\n"), "line 3: opens a quote that is not closed");
}

TEST(Tables, DecimalCommasAreReadWhereTheyCannotBeSeparators) {
  for (const char* text :
       {"lat;lon\n58,378;26,7289\n58,3785;26,729\n", "lat\tlon\n58,378\t26,7289\n58,3785\t26,729\n",
        "sep=;\n\"Breite lat\";\"lon (deg)\"\r58,378;26,7289\r58,3785;26,729\r",
        "lat,lon\n\"58,378\",\"26,7289\"\n\"58,3785\",\"26,729\"\n",
        "58,378;26,7289\n58,3785;26,729", "lon lat\n26,7289 58,378\n26,729\t58,3785\n"}) {
    const auto file = import_file(text, std::nullopt);
    ASSERT_TRUE(file) << text << file.error().detail;
    EXPECT_EQ(positions(file->plan), kPlaces) << text;
  }
  // Two numbers or four? Nobody can say.
  EXPECT_EQ(told("58,3,26,7\n58,4,26,8\n", Format::Csv).substr(0, 29),
            "line 2: has whole numbers alo");
  EXPECT_EQ(told("lat;lon\n1.234,5;26\n"), "line 2: column 1 must be a finite number");
}

TEST(Tables, UnitsAreThoseOfTheHeadLine) {
  const auto first = [](const std::string& text) {
    const auto file = import_file(text, std::nullopt);
    EXPECT_TRUE(file) << file.error().detail;
    return file ? std::get<Waypoint>(file->plan.items.at(0)) : Waypoint{};
  };
  EXPECT_DOUBLE_EQ(*first("lat,lon,speed (knots)\n1,2,1.8\n").speed_mps, 1.8 * 1852.0 / 3600.0);
  EXPECT_DOUBLE_EQ(*first("lat,lon,speed_mph\n1,2,2\n").speed_mps, 0.89408);
  EXPECT_DOUBLE_EQ(*first("lat,lon,speed km/h\n1,2,7.2\n").speed_mps, 2.0);
  EXPECT_DOUBLE_EQ(*first("lat,lon,alt_ft\n1,2,100\n").alt_m, 30.48);
  EXPECT_EQ(first("lat,lon,alt,speed\n1,2,nan,\n").alt_m, std::nullopt);
  EXPECT_EQ(told("lat,lon,lat\n1,2,3\n", Format::Csv).substr(0, 12), "line 1: must");
  EXPECT_EQ(told("lat,lon\n26.7,158.4\n58.4,126.7\n"), "taken");
  EXPECT_EQ(told("lat,lon\n126.7,58.4\n"),
            "line 2: latitude must be from -90 to 90, is 126.7: is it swapped with longitude?");
}

// The follower's form: x, y, z from an origin in metres, yaw in rad, velocity in m/s.
TEST(Follower, HeightsUnknownSpeedsAndFarPlacesComeBack) {
  Plan plan;
  plan.name = "far";
  plan.settings.speed_mps = 1.5;
  const std::vector<LatLon> places{{58.378, 26.729},    {58.3781, 26.7291}, {58.46, 26.729},
                                   {58.378, 26.9},      {59.437, 24.7536},  {-35.36, 149.16},
                                   {58.37801, 26.72901}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    Waypoint waypoint;
    waypoint.at = places[i];
    if (i % 2 == 0) waypoint.alt_m = 10.0 * static_cast<double>(i);
    if (i % 3 == 1) waypoint.speed_mps = 0.5;
    plan.items.emplace_back(waypoint);
  }
  const auto file = import_file(export_file(plan, Format::Follower).content, std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  ASSERT_EQ(file->plan.items.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& was = std::get<Waypoint>(plan.items[i]);
    const auto& is = std::get<Waypoint>(file->plan.items[i]);
    EXPECT_LT(base::distance_bearing(was.at, is.at).distance_m, 1e-5) << i;
    EXPECT_EQ(is.alt_m, was.alt_m) << i;
    EXPECT_EQ(is.speed_mps, was.speed_mps) << i;
  }
  EXPECT_EQ(told("# origin 58 26\nx,y\n20000001,0\n"),
            "line 3: must lie within 20,000 km of the origin");
}

TEST(Follower, AVelocityOfNothingIsToldAndASecondOriginToo) {
  const auto file = import_file(
      "# origin 58.378 26.729\n# origin: 1, 2\nx,y,z,yaw,velocity\n0,0,3.5,0,0\n", std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->rows.at(1).reason, "another origin was given before it");
  EXPECT_EQ(file->rows.back().reason, "a speed of 0 is none of its own");
  EXPECT_EQ(std::get<Waypoint>(file->plan.items.at(0)).alt_m, 3.5);
  EXPECT_EQ(std::get<Waypoint>(file->plan.items.at(0)).speed_mps, std::nullopt);
}

// GeoJSON of 2008, 3: "The value of a member named 'crs' …"; RFC 7946, 4: "The coordinate reference
// system for all GeoJSON coordinates is … WGS 84 … the use of alternative coordinate reference
// systems … was removed."
TEST(GeoJsonCrs, OnlyWgs84IsTaken) {
  const auto with = [](const std::string& crs) {
    return R"({"type":"Point","crs":)" + crs + R"(,"coordinates":[26,58]})";
  };
  const auto name = [&](const std::string& word) {
    return with(R"({"type":"name","properties":{"name":")" + word + "\"}}");
  };
  for (const char* word :
       {"urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "urn:ogc:def:crs:EPSG::4326",
        "http://www.opengis.net/def/crs/EPSG/0/4326", "OGC:CRS84"}) {
    EXPECT_EQ(told(name(word)), "taken") << word;
  }
  EXPECT_EQ(told(with(R"({"type":"EPSG","properties":{"code":4326}})")), "taken");
  const std::string no = "/crs: must be WGS84 (CRS84, EPSG:4326), as RFC 7946 has it";
  for (const char* word :
       {"EPSG:3301", "urn:ogc:def:crs:EPSG::3857", "EPSG:25835", "14326", "CRS:4326x", ""}) {
    EXPECT_EQ(told(name(word)), no) << word;
  }
  EXPECT_EQ(told(with("null")), no);
  EXPECT_EQ(told(with(R"({"type":"link","properties":{"href":"http://x/4326"}})")), no);
  EXPECT_EQ(told(R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},)"
                 R"("geometry":)" +
                 name("EPSG:3301") + "}]}"),
            "/features/0/geometry/crs: must be WGS84 (CRS84, EPSG:4326), as RFC 7946 has it");
}

// KML 2.3, 10.3: a kml:Polygon holds kml:outerBoundaryIs and kml:innerBoundaryIs, no kml:Placemark.
TEST(Kml, APlacemarkInsideAPolygonEndsIt) {
  const std::string ring =
      "<LinearRing><coordinates>26.7,58.3 26.71,58.3 26.71,58.31 26.7,58.3</coordinates>"
      "</LinearRing>";
  const auto file = import_file(
      "<kml><Placemark><Polygon><Placemark/>" + ring + "</Polygon></Placemark></kml>", Format::Kml);
  // Nothing that the ring could belong to is left: it is a line.
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_TRUE(file->areas.empty());
  EXPECT_EQ(file->plan.items.size(), 4u);
}

// GPX 1.1: "version: You must include the version number in your GPX document." KML 2.3: "the
// namespace http://www.opengis.net/kml/2.3".
TEST(Versions, OfOtherXmlAreRefused) {
  EXPECT_EQ(told("<gpx version=\"2.0\"><wpt lat=\"1\" lon=\"2\"/></gpx>"),
            "line 1: is of GPX version 2.0; 1.0 and 1.1 are known");
  EXPECT_EQ(told("<gpx version=\"1.0\"><wpt lat=\"1\" lon=\"2\"/></gpx>"), "taken");
  const auto kml = [](const std::string& version) {
    return "<kml xmlns=\"http://www.opengis.net/kml/" + version +
           "\"><Point><coordinates>1,2</coordinates></Point></kml>";
  };
  EXPECT_EQ(told(kml("2.3")), "taken");
  EXPECT_EQ(told(kml("3.0")), "line 1: is of KML version 3.0; 2.0 to 2.3 are known");
  EXPECT_EQ(told("QGC WPL 100\n0 0 3 16 0 0 0 0 58 26 0 1\n"), "line 1: must be \"QGC WPL 110\"");
}

TEST(Bombs, AreRefusedBeforeTheyFillTheMemory) {
  // Two bytes of text for a value of a hundred.
  std::string lists = R"({"type":"LineString","coordinates":[)";
  while (lists.size() < 24'000'000) lists += "[],[],[],[],[],[],[],[],[],[],";
  const auto file = import_file(lists + "[]]}", std::nullopt);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, base::Code::TooLarge);
  std::string deep;
  for (int i = 0; i < 1'000'000; ++i) deep += R"({"type":)";
  EXPECT_EQ(import_file(deep, Format::GeoJson).error().detail, "nested deeper than 32 levels");
  // A million times the same place: neither items nor an account without end.
  std::string same = "lat,lon\n";
  for (int i = 0; i < 1'000'000; ++i) same += "1,2\n";
  EXPECT_EQ(import_file(same, std::nullopt).error().code, base::Code::TooLarge);
  std::string tuples = "<kml><LineString><coordinates>";
  for (int i = 0; i < 1'000'000; ++i) tuples += "1,2 ";
  EXPECT_EQ(import_file(tuples + "</coordinates></LineString></kml>", std::nullopt).error().code,
            base::Code::TooLarge);
}

TEST(Xml, BlankLinesBeforeItsDeclarationDoNoHarmAndCount) {
  const std::string text = "\r\n\n <?xml version=\"1.0\"?>\n<gpx><wpt lat=\"1\" lon=\"2\"/>\n";
  EXPECT_EQ(told(text + "</gpx>"), "taken");
  EXPECT_EQ(told(text + "<wpt lat=\"x\" lon=\"2\"/></gpx>"),
            "line 5: lat and lon must be finite numbers");
}

}  // namespace
}  // namespace roverd::mission
