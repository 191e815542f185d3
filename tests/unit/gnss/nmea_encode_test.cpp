#include "gnss/nmea_encode.hpp"

#include <gtest/gtest.h>

#include "gnss/nmea.hpp"

namespace roverd::gnss {
namespace {

template <class S>
S back(std::string text) {
  EXPECT_TRUE(text.ends_with("\r\n")) << text;
  text.resize(text.size() - 2);
  const Parsed p = parse_line(text);
  EXPECT_EQ(p.kind, Kind::Used) << text;
  return std::get<S>(p.sentence);
}

TEST(NmeaEncode, ALineGetsItsChecksumAndEnd) {
  EXPECT_EQ(line("GPHDT,359.97,T"), "$GPHDT,359.97,T*04\r\n");
}

TEST(NmeaEncode, GgaMatchesARealOne) {
  Gga s;
  s.time_s = 36930.2;
  s.lat = -33.868724278333;
  s.lon = -151.212757201667;
  s.quality = 4;
  s.sats = 17;
  s.hdop = 0.6;
  s.alt_msl_m = 58.312;
  s.geoid_sep_m = 21.705;
  s.dgps_age_s = 1.2;
  s.station = 42;
  EXPECT_EQ(encode(s),
            "$GNGGA,101530.20,3352.1234567,S,15112.7654321,W,4,17,0.6,58.312,M,21.705,M,1.2,0042"
            "*6A\r\n");
}

TEST(NmeaEncode, AnEmptyGgaHasEmptyFields) {
  EXPECT_EQ(encode(Gga{}), line("GNGGA,,,,,,0,,,,,,,,"));
  EXPECT_EQ(back<Gga>(encode(Gga{})).lat, std::nullopt);
}

TEST(NmeaEncode, RmcMatchesARealOne) {
  Rmc s;
  s.time_s = 36930.2;
  s.active = true;
  s.lat = -33.868724278333;
  s.lon = -151.212757201667;
  s.speed_kn = 1.944;
  s.course_deg = 270.5;
  s.date = Date{std::chrono::year{2024}, std::chrono::month{2}, std::chrono::day{29}};
  s.mode = 'R';
  s.nav_status = 'V';
  EXPECT_EQ(encode(s),
            "$GNRMC,101530.20,A,3352.1234567,S,15112.7654321,W,1.944,270.50,290224,,,R,V*14\r\n");
  s.magvar_deg = -8.1;
  EXPECT_EQ(back<Rmc>(encode(s)).magvar_deg, -8.1);
}

TEST(NmeaEncode, TheOthersComeBackAsTheyWent) {
  Vtg v;
  v.course_true_deg = 54.7;
  v.speed_kn = 5.5;
  v.mode = 'D';
  EXPECT_EQ(back<Vtg>(encode(v)).course_true_deg, 54.7);
  EXPECT_EQ(back<Vtg>(encode(v)).speed_kmh, 10.186);
  EXPECT_EQ(back<Vtg>(encode(Vtg{})).speed_kn, std::nullopt);
  Gst g;
  g.time_s = 1.25;
  g.lat_sd_m = 0.012;
  EXPECT_EQ(back<Gst>(encode(g)).time_s, 1.25);
  EXPECT_EQ(back<Gst>(encode(g)).lat_sd_m, 0.012);
  EXPECT_EQ(back<Gst>(encode(g)).lon_sd_m, std::nullopt);
  Hdt h;
  h.heading_deg = 359.97;
  EXPECT_EQ(encode(h), "$GNHDT,359.97,T*1A\r\n");
  Ths t;
  t.heading_deg = 77.52;
  t.mode = 'A';
  EXPECT_EQ(encode(t), "$GNTHS,77.52,A*2E\r\n");
  Zda z;
  z.time_s = 86399.95;
  z.date = Date{std::chrono::year{2026}, std::chrono::month{12}, std::chrono::day{31}};
  EXPECT_EQ(encode(z), "$GNZDA,235959.95,31,12,2026,00,00*72\r\n");
  EXPECT_EQ(back<Zda>(encode(Zda{})).date, std::nullopt);
}

TEST(NmeaEncode, MinutesNeverPrintAsSixty) {
  Gga s;
  s.lat = 59.99999999999;
  s.lon = -0.0;
  EXPECT_EQ(encode(s), line("GNGGA,,6000.0000000,N,00000.0000000,E,0,,,,,,,,"));
  EXPECT_EQ(encode(s, 4), line("GNGGA,,6000.0000,N,00000.0000,E,0,,,,,,,,"));
}

TEST(NmeaEncode, PositionsSurviveToATenthOfAMillimetre) {
  for (double lat = -89.87654321; lat < 90.0; lat += 7.7777777) {
    Gga s;
    s.lat = lat;
    s.lon = lat * 2.0;
    const Gga r = back<Gga>(encode(s, 8));
    EXPECT_NEAR(r.lat.value(), lat, 1e-9);
    EXPECT_NEAR(r.lon.value(), lat * 2.0, 1e-9);
  }
}

TEST(NmeaEncode, TheTimeIsRoundedWithinItsDay) {
  Gst s;
  s.time_s = 86399.999;
  EXPECT_EQ(back<Gst>(encode(s)).time_s, 86399.99) << "rounding makes no leap second";
  s.time_s = 86400.5;
  EXPECT_EQ(back<Gst>(encode(s)).time_s, 86400.5);
  s.time_s = 59.996;
  EXPECT_EQ(back<Gst>(encode(s)).time_s, 60.0);
  s.time_s = -1.0;
  EXPECT_EQ(back<Gst>(encode(s)).time_s, std::nullopt);
}

TEST(NmeaEncode, SatellitesComeBackAsTheyWere) {
  Gsa gsa;
  gsa.automatic = true;
  gsa.fix = 3;
  gsa.ids = {5, 12};
  gsa.used = 2;
  gsa.pdop = 1.2;
  gsa.system = 3;
  const std::string gsa_line = encode(gsa);
  const Parsed a = parse_line(std::string_view(gsa_line).substr(0, gsa_line.size() - 2));
  ASSERT_EQ(a.kind, Kind::Used) << gsa_line;
  EXPECT_EQ(std::get<Gsa>(a.sentence).ids[1], 12);
  EXPECT_EQ(std::get<Gsa>(a.sentence).used, 2u);
  EXPECT_EQ(std::get<Gsa>(a.sentence).system, 3);
  Gsv gsv;
  gsv.in_view = 1;
  gsv.signal = 7;
  gsv.sats[gsv.used++] = {5, 45, 123, std::nullopt};
  const std::string gsv_line = encode(gsv);
  const Parsed b = parse_line(std::string_view(gsv_line).substr(0, gsv_line.size() - 2));
  ASSERT_EQ(b.kind, Kind::Used) << gsv_line;
  EXPECT_EQ(std::get<Gsv>(b.sentence).sats[0], gsv.sats[0]);
  EXPECT_EQ(std::get<Gsv>(b.sentence).signal, 7);
}

}  // namespace
}  // namespace roverd::gnss
