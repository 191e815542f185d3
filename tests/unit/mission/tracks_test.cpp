// Ways that are not connected: GPX, KML and GeoJSON with several lines. Each test names the
// sentence of the format's specification that its file is made from.

#include <gtest/gtest.h>

#include "files.hpp"
#include "mission/formats/formats.hpp"

namespace roverd::mission {
namespace {

ImportedFile taken(const std::string& text, std::string_view name = "") {
  auto file = import_file(text, std::nullopt, name);
  EXPECT_TRUE(file) << file.error().detail;
  return file ? std::move(*file) : ImportedFile{};
}

/// "name: item/item" of each mission, items as latitudes.
std::vector<std::string> missions(const ImportedFile& file) {
  std::vector<std::string> out;
  const auto tell = [&out](const Plan& plan) {
    std::string text = plan.name + ":";
    for (const LatLon at : positions(plan)) text += " " + std::to_string(at.lat).substr(0, 6);
    out.push_back(text);
  };
  if (!file.plan.items.empty()) tell(file.plan);
  for (const Plan& plan : file.more) tell(plan);
  return out;
}

/// The reason of each row that has one.
std::vector<std::string> reasons(const ImportedFile& file) {
  std::vector<std::string> out;
  for (const FileRow& r : file.rows) {
    if (!r.reason.empty()) out.push_back(r.row + ": " + r.reason);
  }
  return out;
}

using Texts = std::vector<std::string>;

std::string gpx(const std::string& inside) {
  return "<?xml version=\"1.0\"?>\n<gpx version=\"1.1\" creator=\"t\" "
         "xmlns=\"http://www.topografix.com/GPX/1/1\">\n" +
         inside + "</gpx>\n";
}
std::string trkpt(double lat, double lon = 26.0) {
  return "<trkpt lat=\"" + std::to_string(lat) + "\" lon=\"" + std::to_string(lon) + "\"/>\n";
}

// GPX 1.1, trksegType: "A Track Segment holds a list of Track Points which are logically connected
// in order. To represent a single GPS track where GPS reception was lost, or the GPS receiver was
// turned off, start a new Track Segment for each continuous span of track data."
TEST(Ways, SegmentsOfATrackWithALostReceptionBetweenThemAreTwoMissions) {
  const auto file =
      taken(gpx("<trk><name>Monday</name>\n<trkseg>" + trkpt(58.000) + trkpt(58.001) +
                "</trkseg>\n<trkseg>" + trkpt(59.400) + trkpt(59.401) + "</trkseg></trk>"),
            "drive.gpx");
  EXPECT_EQ(missions(file),
            (Texts{"drive: Monday: 58.000 58.001", "drive: Monday (2): 59.400 59.401"}));
  ASSERT_EQ(file.rows.size(), 4u);
  EXPECT_EQ(file.rows[2].mission, 2);
  EXPECT_EQ(file.rows[2].item, 1);
  EXPECT_EQ(file.rows[2].outcome, Outcome::Changed);
  EXPECT_EQ(file.rows[2].reason,
            "does not begin where the one before it ends: a mission of its own");
  EXPECT_EQ(file.rows[3].outcome, Outcome::Taken);
}

TEST(Ways, SegmentsThatTouchAreOneMissionAndThePlaceTheyShareIsThereOnce) {
  const auto file =
      taken(gpx("<trk>\n<trkseg>\n" + trkpt(58.000) + trkpt(58.001) + "</trkseg>\n<trkseg>\n" +
                trkpt(58.001) + trkpt(58.002) + "</trkseg>\n<trkseg>\n" + trkpt(58.002004) +
                trkpt(58.003) + "</trkseg></trk>"),
            "drive.gpx");
  EXPECT_EQ(missions(file), (Texts{"drive: 58.000 58.001 58.002 58.002 58.003"}));
  ASSERT_EQ(file.rows.size(), 6u);
  EXPECT_EQ(file.rows[2].outcome, Outcome::LeftOut);
  EXPECT_EQ(file.rows[4].reason, "goes on where the part before it ends: one mission");
}

// "trk represents a track - an ordered list of points describing a path": two of them are two
// paths, also where one ends at the gate at which the other one begins.
TEST(Ways, TwoTracksAreTwoMissionsThoughTheyTouch) {
  const auto file = taken(gpx("<trk><name>out</name><trkseg>" + trkpt(58.000) + trkpt(58.001) +
                              "</trkseg></trk><trk><name>back</name><trkseg>" + trkpt(58.001) +
                              trkpt(58.000) + "</trkseg></trk>"));
  EXPECT_EQ(missions(file), (Texts{"Imported mission: out: 58.000 58.001",
                                   "Imported mission: back: 58.001 58.000"}));
}

// rteType: "an ordered list of waypoints representing a series of turn points leading to a
// destination"; gpxType allows any number of rte.
TEST(Ways, EachRouteIsAMission) {
  const auto route = [](const char* name, double lat) {
    return "<rte><name>" + std::string(name) + "</name><rtept lat=\"" + std::to_string(lat) +
           "\" lon=\"26\"/><rtept lat=\"" + std::to_string(lat + 0.001) + "\" lon=\"26\"/></rte>\n";
  };
  const auto file = taken(gpx(route("a", 58.0) + route("b", 58.1) + route("a", 58.2)), "r.gpx");
  EXPECT_EQ(missions(file),
            (Texts{"r: a: 58.000 58.001", "r: b: 58.100 58.101", "r: a (2): 58.200 58.201"}));
}

TEST(Ways, ASegmentOfOnePositionIsNoWayAndStandingStillIsToldOnce) {
  const auto file =
      taken(gpx("<trk>\n<trkseg>" + trkpt(57.0) + "</trkseg>\n<trkseg>" + trkpt(58.000) +
                trkpt(58.000) + trkpt(58.000) + trkpt(58.001) + "</trkseg></trk>"),
            "t.gpx");
  EXPECT_EQ(missions(file), (Texts{"t: 58.000 58.001"}));
  EXPECT_EQ(file.rows[0].outcome, Outcome::LeftOut);
  EXPECT_EQ(file.rows[0].reason, "a single position is no way");
  EXPECT_EQ(file.rows[2].outcome, Outcome::LeftOut);
  EXPECT_EQ(file.rows[2].reason, "the same place as the position before it");
  EXPECT_EQ(file.rows[4].outcome, Outcome::Taken);
}

// wptType/extensionsType: "You can add extend GPX by adding your own elements from another schema
// here."
TEST(Ways, ExtensionsAreLookedIntoForSpeedsAlone) {
  const auto file = taken(
      gpx("<metadata><author><name>Anna</name></author></metadata><trk><name>t</name><extensions>"
          "<x:trkpt xmlns:x=\"urn:x\" lat=\"1\" lon=\"2\"/><x:name xmlns:x=\"urn:x\">no</x:name>"
          "</extensions><trkseg><trkpt lat=\"58\" lon=\"26\"><ele>x</ele><extensions>"
          "<g:TrackPointExtension xmlns:g=\"urn:g\"><g:speed>1.25</g:speed><g:ele>9</g:ele>"
          "</g:TrackPointExtension></extensions></trkpt></trkseg></trk>"));
  EXPECT_EQ(file.plan.name, "t");
  ASSERT_EQ(positions(file.plan), (std::vector<LatLon>{{58.0, 26.0}}));
  EXPECT_EQ(std::get<Waypoint>(file.plan.items[0]).speed_mps, 1.25);
  EXPECT_EQ(std::get<Waypoint>(file.plan.items[0]).alt_m, std::nullopt);
  EXPECT_EQ(reasons(file).at(0), "line 3: its height is no number");
}

std::string line_string(const std::string& coordinates) {
  return "<LineString><coordinates>" + coordinates + "</coordinates></LineString>\n";
}

// KML 2.2, 10.1: "kml:MultiGeometry: A container for zero or more geometry elements associated with
// the same kml:Placemark."
TEST(Ways, LinesOfPlacemarksAreMissionsOfTheirOwn) {
  const std::string text =
      "<k:kml xmlns:k=\"http://www.opengis.net/kml/2.2\"><k:Document>"
      "<k:name>roads</k:name>\n<k:Placemark><k:name>north</k:name><k:MultiGeometry>\n"
      "<k:LineString><k:coordinates>26,58,1 26,58.001</k:coordinates></k:LineString>\n"
      "<k:LineString><k:coordinates>26,58.001 26,58.002</k:coordinates></k:LineString>\n"
      "<k:LineString><k:coordinates>27,58 27,58.001</k:coordinates></k:LineString>\n"
      "</k:MultiGeometry></k:Placemark>\n<k:Placemark>"
      "<k:LinearRing><k:coordinates>26,57 26,57.1 26.1,57 26,57</k:coordinates></k:LinearRing>"
      "</k:Placemark></k:Document></k:kml>";
  const auto file = taken(text);
  EXPECT_EQ(missions(file),
            (Texts{"roads: north: 58.000 58.001 58.002", "roads: north (2): 58.000 58.001",
                   "roads: 57.000 57.100 57.000 57.000"}));
  EXPECT_EQ(file.rows.at(2).row, "line 4, coordinate 1");
  EXPECT_EQ(file.rows.at(2).outcome, Outcome::LeftOut);
}

// KML 2.3, 12.5: "kml:Track … an array of kml:when and an array of kml:coord elements"; a coord may
// be empty where there was no position. gx:MultiTrack combines several into one Placemark.
TEST(Ways, TracksWithTimesAreReadAndSeparate) {
  const auto track = [](const std::string& coords) {
    return "<gx:Track><when>2026-01-01T00:00:00Z</when>" + coords + "</gx:Track>\n";
  };
  const auto coord = [](const std::string& text) { return "<gx:coord>" + text + "</gx:coord>\n"; };
  const auto file = taken(
      "<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
      "xmlns:gx=\"http://www.google.com/kml/ext/2.2\">"
      "<Placemark><name>w</name><gx:MultiTrack>\n" +
      track(coord("26 58 60.5") + coord("") + coord("26 58.001 61")) +
      track(coord("30 58 0") + coord("30 58.001 0")) + "</gx:MultiTrack></Placemark></kml>");
  EXPECT_EQ(missions(file), (Texts{"Imported mission: w: 58.000 58.001",
                                   "Imported mission: w (2): 58.000 58.001"}));
  EXPECT_EQ(std::get<Waypoint>(file.plan.items[0]).alt_m, 60.5);
  EXPECT_EQ(reasons(file).at(0), "line 3: it has no position");
}

// RFC 7946, 3.1.5: "For type 'MultiLineString', the 'coordinates' member is an array of LineString
// coordinate arrays."
TEST(Ways, LinesOfGeoJsonAreMissionsOfTheirOwn) {
  const auto file = taken(R"({"type":"FeatureCollection","name":"yard","features":[
    {"type":"Feature","properties":{"name":"a"},"geometry":{"type":"MultiLineString","coordinates":
      [[[26,58],[26,58.001]],[[26,58.001],[26,58.002]],[[28,59],[28,59.001]]]}},
    {"type":"Feature","properties":{"name":"b"},"geometry":{"type":"LineString","coordinates":
      [[26,57],[26,57.001]]}},
    {"type":"Feature","properties":{"name":"gate"},"geometry":{"type":"Point","coordinates":[1,2]}}]})");
  EXPECT_EQ(missions(file), (Texts{"yard: a: 58.000 58.001 58.002", "yard: a (2): 59.000 59.001",
                                   "yard: b: 57.000 57.001"}));
  EXPECT_EQ(file.rows.back().outcome, Outcome::LeftOut);
  EXPECT_EQ(file.rows.back().reason, "the file's line is taken instead");
}

// RFC 7946, 3.1.1: "Implementations SHOULD NOT extend positions beyond three elements because the
// semantics of extra elements are unspecified and ambiguous. … parsers MAY ignore additional
// elements."
TEST(Ways, AFourthNumberOfAPositionIsToldInTheAccount) {
  const auto lines = taken(
      R"({"type":"LineString","coordinates":[[26,58,61,1700000000],[26,58.001,62,1700000001]]})");
  EXPECT_EQ(std::get<Waypoint>(lines.plan.items.at(1)).alt_m, 62.0);
  const auto kml =
      taken("<kml><Placemark>" + line_string("26,58,61,17 26,58.001,62,18") + "</Placemark></kml>");
  EXPECT_EQ(std::get<Waypoint>(kml.plan.items.at(1)).alt_m, 62.0);
  for (const ImportedFile* file : {&lines, &kml}) {
    for (const FileRow& r : file->rows) {
      EXPECT_EQ(r.outcome, Outcome::Changed);
      EXPECT_EQ(r.reason, "of its 4 numbers the first three are kept");
    }
  }
}

TEST(Ways, ALegOfMoreThanTenKilometresIsTold) {
  const auto file = taken("lat,lon\n58,26\n58.05,26\n59.4,26\n");
  EXPECT_EQ(reasons(file), (Texts{"line 4: lies 150.4 km from the position before it"}));
}

TEST(Ways, MoreThanAHundredAreRefused) {
  std::string text;
  for (int i = 0; i <= 100; ++i) {
    text += "<trk><trkseg>" + trkpt(50.0 + 0.01 * i) + trkpt(50.001 + 0.01 * i) + "</trkseg></trk>";
  }
  const auto file = import_file(gpx(text), std::nullopt);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, base::Code::TooLarge);
  EXPECT_EQ(file.error().detail, "the file has more than 100 ways that are not connected");
}

// RFC 7946, 3.1.6: "A linear ring is a closed LineString with four or more positions. The first and
// last positions are equivalent"; "the first MUST be the exterior ring, and any others MUST be
// interior rings".
TEST(Areas, PolygonsAreFieldsThatCanBeCovered) {
  const auto file = taken(R"({"type":"FeatureCollection","features":[
    {"type":"Feature","properties":{"name":"barley"},"geometry":{"type":"Polygon","coordinates":
      [[[5,52],[5.01,52],[5.01,52.01],[5,52]],[[5.005,52.001],[5.006,52.001],[5.006,52.002],[5.005,52.001]]]}},
    {"type":"Feature","properties":{},"geometry":{"type":"MultiPolygon","coordinates":
      [[[[6,52],[6.01,52],[6.01,52.01]]],[[[7,52],[7,52]]]]}}]})",
                          "fields.geojson");
  EXPECT_TRUE(file.plan.items.empty());
  EXPECT_EQ(file.plan.name, "fields");
  ASSERT_EQ(file.areas.size(), 2u);
  EXPECT_EQ(file.areas[0].name, "barley");
  EXPECT_EQ(file.areas[0].rings.size(), 2u);
  EXPECT_EQ(file.areas[0].rings[0],
            (std::vector<LatLon>{{52.0, 5.0}, {52.0, 5.01}, {52.01, 5.01}}));
  EXPECT_EQ(file.areas[1].name, "fields");
  EXPECT_EQ(file.areas[1].row, "/features/1/geometry/coordinates/0");
  ASSERT_EQ(file.rows.size(), 3u);
  EXPECT_EQ(file.rows[1].reason,
            "an area to be covered: a survey makes the way; it is not closed in the file: from its "
            "last corner to its first");
  EXPECT_EQ(file.rows[2].outcome, Outcome::LeftOut);
}

// KML 2.2, 10.8: "kml:Polygon … an outer boundary and 0 or more inner boundaries."
TEST(Areas, PolygonsOfKmlKeepTheirHoles) {
  const auto ring = [](const char* which, const char* coordinates) {
    return "<" + std::string(which) + "><LinearRing><coordinates>" + coordinates +
           "</coordinates></LinearRing></" + which + ">";
  };
  const auto file =
      taken("<kml><Placemark><name>plot</name><Polygon>" +
            ring("outerBoundaryIs", "5,52 5.01,52 5.01,52.01 5,52") +
            ring("innerBoundaryIs", "5.005,52.001 5.006,52.001 5.006,52.002 5.005,52.001") +
            "</Polygon></Placemark></kml>");
  ASSERT_EQ(file.areas.size(), 1u);
  EXPECT_EQ(file.areas[0].name, "plot");
  EXPECT_EQ(file.areas[0].rings.size(), 2u);
}

}  // namespace
}  // namespace roverd::mission
