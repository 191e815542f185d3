// Formats of plain positions: CSV in both forms, GeoJSON, GPX, KML.

#include <cmath>

#include <gtest/gtest.h>

#include "base/geo.hpp"
#include "mission/formats/formats.hpp"
#include "mission/json/json.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

constexpr std::array kPositionFormats{Format::Gpx, Format::Kml, Format::GeoJson, Format::Csv,
                                      Format::Follower};

Plan line_plan() {
  Plan plan;
  plan.name = "a < b & \"c\"";
  Waypoint first = waypoint_at(58.378020123, 26.728900987);
  first.alt_m = 61.25;
  first.speed_mps = 0.8;
  plan.items = {first, waypoint_at(58.3781, -0.000000001), waypoint_at(58.3782, 26.7291)};
  std::get<Waypoint>(plan.items[1]).at.lon = 26.7290000011;
  return plan;
}

/// "row: reason" of everything that was not taken as it is.
std::string losses(const std::vector<FileRow>& rows) {
  std::string out;
  for (const FileRow& row : rows) {
    if (row.outcome != Outcome::Taken) out += row.row + " " + row.what + ": " + row.reason + "\n";
  }
  return out;
}

std::string refusal(std::string_view content, std::optional<Format> format = std::nullopt) {
  const auto file = import_file(content, format);
  if (file) return "taken";
  const auto& fields = file.error().fields;
  return fields.empty() ? file.error().detail : fields[0].pointer + ": " + fields[0].detail;
}

TEST(Positions, ComeBackWhateverTheFormat) {
  const Plan plan = line_plan();
  for (const Format format : kPositionFormats) {
    const ExportedFile out = export_file(plan, format);
    // Detected by what it holds, not by its name.
    const auto back = import_file(out.content, std::nullopt);
    ASSERT_TRUE(back) << out.content << back.error().detail;
    EXPECT_EQ(back->format, format == Format::Follower ? Format::Csv : format);
    ASSERT_EQ(back->plan.items.size(), plan.items.size());
    for (std::size_t i = 0; i < plan.items.size(); ++i) {
      const auto& was = std::get<Waypoint>(plan.items[i]);
      const auto& is = std::get<Waypoint>(back->plan.items[i]);
      EXPECT_NEAR(is.at.lat, was.at.lat, 1e-9) << out.content;
      EXPECT_NEAR(is.at.lon, was.at.lon, 1e-9);
      EXPECT_EQ(is.alt_m, was.alt_m);
      const bool has_speed = format != Format::Gpx && format != Format::Kml;
      EXPECT_EQ(is.speed_mps, has_speed ? was.speed_mps : std::nullopt);
    }
    const bool has_name = format != Format::Csv && format != Format::Follower;
    EXPECT_EQ(back->plan.name, has_name ? plan.name : "Imported mission");
  }
}

TEST(Positions, GeoJsonKeepsEveryWaypointWhole) {
  Plan plan = line_plan();
  auto& last = std::get<Waypoint>(plan.items.back());
  last.hold_s = 3.0;
  last.turn = Turn::Pivot;
  last.reverse = true;
  EXPECT_EQ(import_file(export_file(plan, Format::GeoJson).content, std::nullopt)->plan, plan);
}

TEST(Positions, WhatAFormatCannotHoldIsTold) {
  Plan plan = line_plan();
  plan.home = Home{{58.0, 26.0}, std::nullopt};
  plan.items.emplace_back(Wait{3.0});
  EXPECT_EQ(losses(export_file(plan, Format::Gpx).rows),
            "/home home: the format has no home\n"
            "/items/0 waypoint: of its settings the format holds only position, height\n"
            "/items/3 wait: the format holds positions only\n");
}

TEST(Csv, ColumnsAreFoundByNameAndEveryRowIsAccountedFor) {
  const auto file = import_file(
      "# from the office\r\n"
      "Name;Longitude;Latitude;Speed (km/h)\r\n"
      "gate;26.7289;58.378;3.6\r\n"
      "\r\n"
      "barn;26.7290;58.379;720\r\n",
      std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->format, Format::Csv);
  ASSERT_EQ(file->plan.items.size(), 2u);
  EXPECT_EQ(std::get<Waypoint>(file->plan.items[0]).at, (LatLon{58.378, 26.7289}));
  EXPECT_EQ(std::get<Waypoint>(file->plan.items[0]).speed_mps, 1.0);
  EXPECT_EQ(losses(file->rows),
            "line 1 comment: a comment\n"
            "line 2 column Name: a waypoint has no place for it\n"
            "line 5 row: a speed of 200 cannot be kept\n");
  EXPECT_EQ(file->rows.size(), 4u);
}

TEST(Csv, TheFollowersFormNeedsAnOrigin) {
  const std::string rows = "x,y,z,yaw,velocity\n0,0,0,1.57,3.6\n3,4,0,1.57,7.2\n";
  const auto file = import_file("# origin 58.378 26.729\n" + rows, std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  const auto& second = std::get<Waypoint>(file->plan.items.at(1));
  EXPECT_NEAR(base::distance_bearing({58.378, 26.729}, second.at).distance_m, 5.0, 1e-6);
  EXPECT_EQ(second.speed_mps, 7.2);
  ImportHints hints{LatLon{58.378, 26.729}, true};
  const auto hinted = import_file(rows, std::nullopt, "", hints);
  EXPECT_EQ(std::get<Waypoint>(hinted->plan.items.at(1)).at, second.at);
  EXPECT_NEAR(*std::get<Waypoint>(hinted->plan.items.at(1)).speed_mps, 2.0, 1e-12);
  EXPECT_TRUE(import_file("0 0 0 1.57 0.5\n3 4 0 1.57 0.5\n", std::nullopt, "", hints));
  EXPECT_EQ(refusal(rows),
            "line 2: needs an origin: a line \"# origin LAT LON\" before it, or origin_lat and "
            "origin_lon with the call");
}

TEST(Kml, BlanksAtTheCommasOfAPositionArePassedOver) {
  const auto line = [](const std::string& coordinates) {
    return import_file("<kml><Placemark><LineString><coordinates>" + coordinates +
                           "</coordinates></LineString></Placemark></kml>",
                       std::nullopt);
  };
  for (const char* text : {"26.7, 58.3, 61 26.7001, 58.3, 61", "26.7 ,58.3 ,61\n26.7001 ,58.3,61",
                           "26.7,58.3, 61 26.7001,58.3, 61"}) {
    const auto file = line(text);
    ASSERT_TRUE(file) << text << file.error().detail;
    ASSERT_EQ(file->plan.items.size(), 2u) << text;
    EXPECT_EQ(std::get<Waypoint>(file->plan.items[1]).at, (LatLon{58.3, 26.7001})) << text;
    EXPECT_EQ(std::get<Waypoint>(file->plan.items[1]).alt_m, 61.0) << text;
  }
  // A comma at the end of a position is none inside of it.
  const auto two = line("26.7,58.3, 26.7001,58.3,");
  ASSERT_TRUE(two);
  EXPECT_EQ(two->plan.items.size(), 2u);
  const auto point = import_file(
      "<kml><Placemark><Point><coordinates> 26.7, 58.3 </coordinates></Point></Placemark></kml>",
      std::nullopt);
  ASSERT_TRUE(point) << point.error().detail;
  EXPECT_EQ(std::get<Waypoint>(point->plan.items.at(0)).at, (LatLon{58.3, 26.7}));
}

TEST(Csv, BadRowsAreNamed) {
  EXPECT_EQ(refusal("lat,lon\n91,0\n"),
            "line 2: latitude must be from -90 to 90, is 91: is it swapped with longitude?");
  EXPECT_EQ(refusal("lat,lon\n1,2,3\n"), "line 2: must have 2 columns, has 3");
  EXPECT_EQ(refusal("lat,lon\n1,nan\n"), "line 2: column 2 must be a finite number");
  EXPECT_EQ(refusal("lat,lon\n1,1e999\n"), "line 2: column 2 must be a finite number");
  EXPECT_EQ(refusal("lat,lon\n"), ": has no position");
  EXPECT_EQ(refusal("# origin 91 0\nx,y\n1,1\n"),
            "line 1: origin must be a latitude and a longitude");
  EXPECT_EQ(refusal("a,b\n1,2\n", Format::Csv).substr(0, 12), "line 1: must");
  EXPECT_EQ(refusal("hello world\n"),
            "none of .plan, .waypoints, GPX, KML, KMZ, GeoJSON and a table of positions");
}

TEST(Positions, ThatCannotBeAreLeftOutWhereThatIsWished) {
  const ImportHints rest{.leave_out_wrong = true};
  const auto taken = [&](const std::string& text) {
    const auto file = import_file(text, std::nullopt, "", rest);
    EXPECT_TRUE(file) << file.error().detail;
    return std::to_string(file ? file->plan.items.size() : 0) + " items; " +
           (file ? losses(file->rows) : "");
  };
  EXPECT_EQ(taken("lat,lon\n58.1,26.1\n95,26.1\n58.2\n58.3,x\n58.11,26.1\n"),
            "2 items; line 3 row: latitude must be from -90 to 90, is 95: is it swapped with "
            "longitude?\nline 4 row: must have 2 columns, has 1\n"
            "line 5 row: column 2 must be a finite number\n");
  EXPECT_EQ(taken("<kml><LineString><coordinates>26,58 26,95 x 26.1,58</coordinates></LineString>"
                  "</kml>"),
            "2 items; line 1, coordinate 2 coordinate: latitude must be from -90 to 90, is 95: is "
            "it swapped with longitude?\n"
            "line 1, coordinate 3 coordinate: must be longitude, latitude and perhaps a height\n");
  EXPECT_EQ(taken("<gpx><rte><rtept lat=\"58\" lon=\"26\"/>\n<rtept lat=\"x\" lon=\"26\"/>"
                  "<rtept lat=\"58.01\" lon=\"26\"/></rte></gpx>"),
            "2 items; line 2 rtept: lat and lon must be finite numbers\n");
  EXPECT_EQ(taken(R"({"type":"LineString","coordinates":[[0,0],[181,0],["x"],[0.01,0]]})"),
            "2 items; /coordinates/1 position: longitude must be from -180 to 180, is 181\n"
            "/coordinates/2 position: must be [longitude, latitude] or with a height\n");

  // Nothing that is left, and what nobody can mend by leaving a place out.
  EXPECT_FALSE(import_file("lat,lon\n95,26\n", std::nullopt, "", rest));
  EXPECT_FALSE(import_file("# origin 91 0\nx,y\n1,1\n", std::nullopt, "", rest));
  EXPECT_FALSE(import_file("x,y\n1,1\n", std::nullopt, "", rest));
  EXPECT_FALSE(
      import_file("<kml><Polygon><LinearRing><coordinates>26,58 x 26.1,58 26.1,58.1"
                  "</coordinates></LinearRing></Polygon></kml>",
                  std::nullopt, "", rest));
}

TEST(Positions, ThatArePartOfAFenceAreNeverLeftOut) {
  const ImportHints rest{.leave_out_wrong = true};
  const std::string way =
      "<Placemark><LineString><coordinates>26,58 26.001,58</coordinates></LineString></Placemark>";
  const auto told = [&](const std::string& text) {
    const auto file = import_file(text, std::nullopt, "", rest);
    if (file) return "taken; " + losses(file->rows);
    const auto& fields = file.error().fields;
    return fields.empty() ? file.error().detail : fields[0].pointer + ": " + fields[0].detail;
  };
  const std::string point = "<Point><coordinates>26.0005;58.0</coordinates></Point>";
  const auto words_of = [&](const std::string& name, const std::string& value) {
    return "<ExtendedData><Data name=\"" + name + "\"><value>" + value +
           "</value></Data><Data name=\"radius_m\"><value>5</value></Data></ExtendedData>";
  };
  const std::string no_position = "line 2: must be longitude, latitude and perhaps a height";
  for (const std::string& words : {words_of("fence", "exclusion"), words_of("rally", "true")}) {
    EXPECT_EQ(told("<kml><Document>" + way + "\n<Placemark>" + words + point +
                   "</Placemark></Document></kml>"),
              no_position);
    EXPECT_EQ(told("<kml><Document>" + way + "\n<Placemark>" + point + words +
                   "</Placemark></Document></kml>"),
              no_position);
  }
  // One that is no fence still is.
  EXPECT_EQ(
      told("<kml><Document>" + way + "\n<Placemark>" + point + "</Placemark></Document></kml>"),
      "taken; line 2 Point: must be longitude, latitude and perhaps a height\n");
  EXPECT_EQ(told(R"({"type":"FeatureCollection","features":[
              {"type":"Feature","properties":{"fence":"exclusion"},"geometry":null},
              {"type":"Feature","properties":{},"geometry":
                {"type":"LineString","coordinates":[[26,58],[26.001,58]]}}]})"),
            "/features/0: must be a Polygon, or a Point with radius_m, to be a fence");
  EXPECT_EQ(told(R"({"type":"FeatureCollection","features":[
              {"type":"Feature","properties":{"rally":true},"geometry":null},
              {"type":"Feature","properties":{},"geometry":
                {"type":"LineString","coordinates":[[26,58],[26.001,58]]}}]})"),
            "/features/0: must be a Point to be a rally point");
}

//   Without one position the list of what each has beside it belongs to none.
TEST(GeoJson, OfOurOwnWaypointsNoneIsLeftOut) {
  const ImportHints rest{.leave_out_wrong = true};
  const auto feature = [](const std::string& properties) {
    return R"({"type":"Feature","properties":)" + properties +
           R"(,"geometry":{"type":"LineString","coordinates":[[26,58],[26,95],[26.001,58]]}})";
  };
  const auto own =
      import_file(feature(R"({"waypoints":[{},{},{"reverse":true}]})"), std::nullopt, "", rest);
  ASSERT_FALSE(own);
  EXPECT_EQ(own.error().fields.at(0).pointer, "/geometry/coordinates/1");
  // Those of others have no such list.
  const auto other = import_file(feature("{}"), std::nullopt, "", rest);
  ASSERT_TRUE(other) << other.error().detail;
  EXPECT_EQ(other->plan.items.size(), 2u);
}

TEST(GeoJson, LinesPointsAndCollectionsAreRead) {
  const auto file = import_file(
      R"({"type":"FeatureCollection","features":[
        {"type":"Feature","properties":{"name":"gate"},"geometry":{"type":"Point","coordinates":[26.1,58.1]}},
        {"type":"Feature","properties":null,"geometry":{"type":"Polygon","coordinates":[]}},
        {"type":"Feature","properties":{},"geometry":null},
        {"type":"Feature","properties":{},"geometry":{"type":"GeometryCollection","geometries":[
          {"type":"MultiLineString","coordinates":[[[26.2,58.2,50]],[[26.2,58.21]]]}]}}]})",
      std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->plan.name, "Imported mission");
  ASSERT_EQ(file->plan.items.size(), 2u);
  EXPECT_EQ(std::get<Waypoint>(file->plan.items[0]).alt_m, 50.0);
  EXPECT_EQ(losses(file->rows),
            "/features/0/geometry/coordinates position: the file's line is taken instead\n"
            "/features/1/geometry Polygon: it has no coordinates\n"
            "/features/2 Feature: it has no geometry\n");
  EXPECT_EQ(refusal(R"({"type":"Point","coordinates":[26.1,"x"]})"),
            "/coordinates: must be [longitude, latitude] or with a height");
  EXPECT_EQ(refusal(R"({"type":"LineString","coordinates":[[0,0],[181,0]]})"),
            "/coordinates/1: longitude must be from -180 to 180, is 181");
  EXPECT_EQ(refusal(R"({"type":"Circle"})"), "/type: is no type of GeoJSON");
  EXPECT_EQ(refusal(R"({"type":"Point")").substr(0, 4), "byte");
}

TEST(Gpx, TheRouteIsTakenBeforeTracksAndWaypoints) {
  const auto file = import_file(
      "<?xml version=\"1.0\"?>\n<gpx version=\"1.1\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n"
      "<wpt lat=\"1\" lon=\"2\"><name>gate</name></wpt>\n"
      "<rte><name>morning</name>\n"
      "<rtept lat=\"58.1\" lon=\"26.1\"><ele>61.5</ele></rtept>\n"
      "<rtept lat=\"58.11\" lon=\"26.1\"/></rte></gpx>",
      std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->plan.name, "morning");
  ASSERT_EQ(file->plan.items.size(), 2u);
  EXPECT_EQ(std::get<Waypoint>(file->plan.items[0]).alt_m, 61.5);
  EXPECT_EQ(losses(file->rows), "line 3 wpt: the file's route is taken instead\n");
  EXPECT_EQ(refusal("<gpx>\n<wpt lat=\"x\" lon=\"2\"/></gpx>"),
            "line 2: lat and lon must be finite numbers");
  EXPECT_EQ(refusal("<gpx>\n<wpt lat=\"1\" lon=\"200\"/></gpx>"),
            "line 2: longitude must be from -180 to 180, is 200");
  EXPECT_EQ(refusal("<gpx>\n<wpt lat="), "line 2: unclosed token");
  EXPECT_EQ(refusal("<kml></kml>", Format::Gpx), "line 1: must begin a <gpx> document");
}

TEST(Kml, LinesAreTakenBeforePoints) {
  const auto file = import_file(
      "<kml><Document><name>farm</name>\n"
      "<Placemark><Point><coordinates>1,2</coordinates></Point></Placemark>\n"
      "<Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>0,0 1,1 1,0</coordinates>"
      "</LinearRing></outerBoundaryIs></Polygon></Placemark>\n"
      "<Placemark><LineString><coordinates>\n 26.1,58.1,61.5\n 26.1,58.11 </coordinates>"
      "</LineString></Placemark></Document></kml>",
      std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->plan.name, "farm");
  ASSERT_EQ(file->plan.items.size(), 2u);
  EXPECT_EQ(std::get<Waypoint>(file->plan.items[0]).at, (LatLon{58.1, 26.1}));
  EXPECT_EQ(losses(file->rows),
            "line 2 Point: the file's line is taken instead\n"
            "line 3 Polygon: an area to be covered: a survey makes the way; it is not closed in "
            "the file: from its last corner to its first\n");
  ASSERT_EQ(file->areas.size(), 1u);
  EXPECT_EQ(file->areas[0].rings,
            (std::vector<std::vector<LatLon>>{{{0.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}}));
  EXPECT_EQ(refusal("<kml><LineString><coordinates>1,2 3</coordinates></LineString></kml>"),
            "line 1, coordinate 2: must be longitude, latitude and perhaps a height");
}

TEST(Xml, BombsEntitiesAndDepthAreRefused) {
  EXPECT_EQ(refusal("<!DOCTYPE gpx [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]>\n<gpx>&b;</gpx>"),
            "line 1: a document type declaration is not taken");
  EXPECT_EQ(refusal("<!DOCTYPE gpx SYSTEM \"file:///etc/passwd\"><gpx/>"),
            "line 1: a document type declaration is not taken");
  EXPECT_EQ(refusal("<gpx>&xxe;</gpx>"), "line 1: undefined entity");
  std::string deep = "<gpx>";
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_EQ(refusal(deep), "line 1: nested too deeply");
  EXPECT_EQ(refusal("<gpx><name>\xff\xfe</name></gpx>"), "line 1: not well-formed (invalid token)");
}

TEST(Fences, ThatSayTheyAreAreTakenAndWritten) {
  Plan plan;
  plan.name = "field";
  for (int i = 0; i < 3; ++i) plan.items.emplace_back(waypoint_at(58.0 + 0.001 * i, 26.0));
  const Fence fence{
      "field",
      {{AreaKind::Inclusion, FencePolygon{{{58.0, 26.0}, {58.0, 26.01}, {58.01, 26.010000001}}}},
       {AreaKind::Exclusion, FenceCircle{{58.0, 26.001}, 12.5}}},
      {{{58.001, 26.002}, 15.0}, {{58.0, 26.0}, std::nullopt}}};
  for (const Format format : {Format::GeoJson, Format::Kml, Format::Kmz}) {
    SCOPED_TRACE(to_string(format));
    const ExportedFile out = export_file(plan, format, &fence);
    const auto file = import_file(out.content, std::nullopt);

    ASSERT_TRUE(file) << file.error().detail;
    EXPECT_EQ(losses(out.rows), "");
    EXPECT_EQ(losses(file->rows), "");
    EXPECT_EQ(file->plan.items, plan.items);
    EXPECT_EQ(file->fence, fence);

    // A file may hold a fence alone.
    const auto alone =
        import_file(export_file({"field", {}, {}, {}}, format, &fence).content, std::nullopt);
    ASSERT_TRUE(alone) << alone.error().detail;
    EXPECT_TRUE(alone->plan.items.empty());
    EXPECT_EQ(alone->fence, fence);
  }
  EXPECT_EQ(losses(export_file(plan, Format::Gpx, &fence).rows),
            " fence: this format has no place for fences\n");
}

TEST(Kml, AFenceMayBeSaidAfterItsShapeAndByASchema) {
  const auto file = import_file(
      "<kml><Document><ExtendedData><Data name=\"fence\"><value>exclusion</value></Data>"
      "</ExtendedData>\n"
      "<Placemark><Point><coordinates>26,58</coordinates></Point></Placemark>\n"
      "<Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>0,0,7 0.001,0,7 0,0.001,7 "
      "0,0,7</coordinates></LinearRing></outerBoundaryIs></Polygon>\n"
      "<ExtendedData><SchemaData><SimpleData name=\"fence\"> inclusion\n</SimpleData>"
      "</SchemaData></ExtendedData></Placemark>\n"
      "<ExtendedData><Data name=\"rally\"><value>true</value></Data></ExtendedData>"
      "</Document></kml>",
      std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->plan.items.size(), 1u);  // words of the document are nobody's
  ASSERT_TRUE(file->fence);
  const std::vector<LatLon> corners{{0.0, 0.0}, {0.0, 0.001}, {0.001, 0.0}};
  ASSERT_EQ(file->fence->areas.size(), 1u);
  EXPECT_EQ(file->fence->areas[0], (FenceArea{AreaKind::Inclusion, FencePolygon{corners}}));
}

TEST(Kml, AFenceThatCannotBeIsRefusedByItsLine) {
  using Words = std::vector<std::pair<std::string, std::string>>;
  const auto refused = [](const Words& words, const std::string& shape) {
    std::string text = "<kml>\n<Placemark><ExtendedData>";
    for (const auto& [word, value] : words) {
      text += "<Data name=\"" + word + "\"><value>" + value + "</value></Data>";
    }
    return refusal(text + "</ExtendedData>\n" + shape + "</Placemark></kml>");
  };
  const auto polygon = [](const std::string& coordinates, const std::string& more = "") {
    return "<Polygon><outerBoundaryIs><LinearRing><coordinates>" + coordinates +
           "</coordinates></LinearRing></outerBoundaryIs>" + more + "</Polygon>";
  };
  const std::string ring = "0,0 0.001,0 0,0.001 0,0";
  const std::string point = "<Point><coordinates>0,0</coordinates></Point>";
  const std::string hole = "<innerBoundaryIs><LinearRing><coordinates>" + ring +
                           "</coordinates></LinearRing></innerBoundaryIs>";
  EXPECT_TRUE(refused({{"fence", "exclusion"}}, polygon("0,0 0.001,0.001 0.001,0 0,0.001 0,0"))
                  .starts_with("line 3: "));
  EXPECT_EQ(refused({{"fence", "both"}}, polygon(ring)),
            "line 3: must have \"inclusion\" or \"exclusion\" as its property fence");
  EXPECT_EQ(refused({{"fence", "inclusion"}}, polygon(ring, hole)),
            "line 3: must have no holes: say them as exclusions");
  EXPECT_EQ(refused({{"fence", "inclusion"}}, polygon("0,0 1,x 2,2")),
            "line 3, corner 2: must be longitude, latitude and perhaps a height");
  EXPECT_EQ(refused({{"fence", "inclusion"}}, "<Polygon/>"), "line 3: must be a list of rings");
  for (const char* radius : {"-1", "0", "nan", "1e308", "wide"}) {
    EXPECT_TRUE(
        refused({{"fence", "inclusion"}, {"radius_m", radius}}, point).starts_with("line 3: "))
        << radius;
  }
  EXPECT_EQ(refused({{"fence", "inclusion"}}, point),
            "line 3: must be a Polygon, or a Point with radius_m, to be a fence");
  EXPECT_EQ(refused({{"rally", "true"}}, polygon(ring)),
            "line 3: must be a Point to be a rally point");
  // A line that is called a fence is not driven, and one without a shape is not passed over.
  const std::string line = "<LineString><coordinates>0,0 0.001,0</coordinates></LineString>";
  const std::string both = "<MultiGeometry>" + polygon(ring) + line + "</MultiGeometry>";
  for (const std::string& shape : {line, std::string("<name>north</name>"), both}) {
    EXPECT_EQ(refused({{"fence", "exclusion"}}, shape),
              "line 2: must be a Polygon, or a Point with radius_m, to be a fence");
    EXPECT_EQ(refused({{"rally", "true"}}, shape), "line 2: must be a Point to be a rally point");
  }
}

TEST(GeoJson, AFenceThatCannotBeIsRefusedAndAnAreaWithoutItsWordLeftOut) {
  const auto file_with = [](const std::string& properties, const std::string& geometry) {
    return import_file(
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
        R"({"type":"LineString","coordinates":[[26,58],[27,58]]}},{"type":"Feature","properties":)" +
            properties + R"(,"geometry":)" + geometry + "}]}",
        Format::GeoJson);
  };
  const std::string ring = R"({"type":"Polygon","coordinates":[[[0,0],[1e-3,0],[0,1e-3],[0,0]]]})";
  const std::string crossed =
      R"({"type":"Polygon","coordinates":[[[0,0],[1e-3,1e-3],[1e-3,0],[0,1e-3],[0,0]]]})";
  const std::string point = R"({"type":"Point","coordinates":[0,0]})";
  const std::string line = R"({"type":"LineString","coordinates":[[0,0],[1,1]]})";

  EXPECT_TRUE(file_with(R"({"fence":"exclusion"})", ring)->fence);
  EXPECT_FALSE(file_with(R"({"name":"lake"})", ring)->fence);
  const std::vector<std::pair<std::string, std::string>> bad{
      {R"({"fence":"exclusion"})", crossed}, {R"({"fence":"both"})", ring},
      {R"({"fence":"inclusion"})", point},   {R"({"fence":"inclusion","radius_m":-1})", point},
      {R"({"rally":true})", line},           {R"({"fence":"inclusion"})", line}};
  for (const auto& [properties, geometry] : bad) {
    const auto refused_file = file_with(properties, geometry);
    ASSERT_FALSE(refused_file) << properties;
    EXPECT_EQ(refused_file.error().fields.at(0).pointer, "/features/1/geometry");
  }
}

}  // namespace
}  // namespace roverd::mission
