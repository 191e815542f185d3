#include "gnss/nmea.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gnss/nmea_encode.hpp"

namespace roverd::gnss {
namespace {

using base::FixType;
using std::chrono::day;
using std::chrono::month;
using std::chrono::year;

template <class S>
S used(std::string_view text) {
  const Parsed p = parse_line(text);
  EXPECT_EQ(p.kind, Kind::Used) << text << ": " << to_string(p.flaw) << ", field " << p.field;
  const S* s = std::get_if<S>(&p.sentence);
  EXPECT_NE(s, nullptr) << text;
  return s != nullptr ? *s : S{};
}

/// A body with its right checksum.
Parsed parsed(std::string_view body) {
  std::string text = line(body);
  text.resize(text.size() - 2);
  return parse_line(text);
}

void expect_bad_field(std::string_view body, int field) {
  const Parsed p = parsed(body);
  EXPECT_EQ(p.kind, Kind::Damaged) << body;
  EXPECT_EQ(p.flaw, Flaw::BadField) << body;
  EXPECT_EQ(p.field, field) << body;
  EXPECT_TRUE(std::holds_alternative<std::monostate>(p.sentence));
}

constexpr double kTiny = 1e-10;  // the printed decimals of the expected degrees

TEST(Nmea, GgaWithRtkFixInTheSouthWest) {
  const auto s = used<Gga>(
      "$GNGGA,101530.20,3352.1234567,S,15112.7654321,W,4,17,0.6,58.312,M,21.705,M,1.2,0042*6A");
  EXPECT_EQ(s.talker.view(), "GN");
  EXPECT_DOUBLE_EQ(s.time_s.value(), 36930.2);
  EXPECT_NEAR(s.lat.value(), -33.868724278333, kTiny);
  EXPECT_NEAR(s.lon.value(), -151.212757201667, kTiny);
  EXPECT_EQ(s.quality, 4);
  EXPECT_EQ(s.sats, 17);
  EXPECT_EQ(s.hdop, 0.6);
  EXPECT_EQ(s.alt_msl_m, 58.312);
  EXPECT_EQ(s.geoid_sep_m, 21.705);
  EXPECT_EQ(s.dgps_age_s, 1.2);
  EXPECT_EQ(s.station, 42);
  EXPECT_EQ(s.fix(), FixType::RtkFixed);
}

TEST(Nmea, GgaWithoutAgeAndStation) {
  const auto s =
      used<Gga>("$GPGGA,000000.00,6010.02000,N,02456.11000,E,5,12,0.9,25.4,M,17.9,M,,*5E");
  EXPECT_EQ(s.talker.view(), "GP");
  EXPECT_EQ(s.time_s, 0.0);
  EXPECT_NEAR(s.lat.value(), 60.167, kTiny);
  EXPECT_NEAR(s.lon.value(), 24.935166666667, kTiny);
  EXPECT_EQ(s.fix(), FixType::RtkFloat);
  EXPECT_EQ(s.dgps_age_s, std::nullopt);
  EXPECT_EQ(s.station, std::nullopt);
}

TEST(Nmea, GgaWithoutFixHasNoPosition) {
  const auto s = used<Gga>("$GNGGA,081500.00,,,,,0,00,99.99,,,,,,*74");
  EXPECT_EQ(s.time_s, 29700.0);
  EXPECT_EQ(s.lat, std::nullopt);
  EXPECT_EQ(s.lon, std::nullopt);
  EXPECT_EQ(s.quality, 0);
  EXPECT_EQ(s.sats, 0);
  EXPECT_EQ(s.hdop, 99.99);
  EXPECT_EQ(s.alt_msl_m, std::nullopt);
  EXPECT_EQ(s.geoid_sep_m, std::nullopt);
  EXPECT_EQ(s.fix(), FixType::None);
}

TEST(Nmea, GgaInsideALeapSecond) {
  const auto s = used<Gga>("$GPGGA,235960.00,0000.00000,N,00000.00000,E,1,08,1.0,0.0,M,0.0,M,,*5E");
  EXPECT_EQ(s.time_s, 86400.0);
  EXPECT_EQ(s.lat, 0.0);
  EXPECT_EQ(s.lon, 0.0);
  EXPECT_EQ(s.alt_msl_m, 0.0);
  EXPECT_EQ(s.fix(), FixType::Single);
}

TEST(Nmea, EveryQualityNumberHasAWord) {
  const std::vector<FixType> expected{FixType::None,      FixType::Single,   FixType::Differential,
                                      FixType::Single,    FixType::RtkFixed, FixType::RtkFloat,
                                      FixType::Estimated, FixType::Unknown,  FixType::Unknown,
                                      FixType::Unknown};
  for (std::size_t q = 0; q < expected.size(); ++q) {
    EXPECT_EQ(fix_from_quality(static_cast<int>(q)), expected[q]) << q;
  }
  EXPECT_EQ(fix_from_quality(std::nullopt), FixType::None);
}

TEST(Nmea, RmcIsValidWhateverTheNavigationalStatusSays) {
  const auto s =
      used<Rmc>("$GNRMC,101530.20,A,3352.1234567,S,15112.7654321,W,1.944,270.50,290224,,,R,V*14");
  EXPECT_DOUBLE_EQ(s.time_s.value(), 36930.2);
  EXPECT_TRUE(s.valid());
  EXPECT_NEAR(s.lat.value(), -33.868724278333, kTiny);
  EXPECT_NEAR(s.lon.value(), -151.212757201667, kTiny);
  EXPECT_EQ(s.speed_kn, 1.944);
  EXPECT_NEAR(*s.speed_kn * kMpsPerKnot, 1.00008, 1e-9);
  EXPECT_EQ(s.course_deg, 270.5);
  EXPECT_EQ(s.date, (Date{year{2024}, month{2}, day{29}}));
  EXPECT_EQ(s.magvar_deg, std::nullopt);
  EXPECT_EQ(s.mode, 'R');
  EXPECT_EQ(s.nav_status, 'V');
}

TEST(Nmea, RmcMayBeVoidAndStillCarryAPosition) {
  const auto s = used<Rmc>("$GPRMC,120001.00,V,6010.02000,N,02456.11000,E,0.0,,010100,8.1,E,N*08");
  EXPECT_FALSE(s.valid());
  EXPECT_NEAR(s.lat.value(), 60.167, kTiny);
  EXPECT_EQ(s.speed_kn, 0.0);
  EXPECT_EQ(s.course_deg, std::nullopt);
  EXPECT_EQ(s.date, (Date{year{2000}, month{1}, day{1}}));
  EXPECT_EQ(s.magvar_deg, 8.1);
  EXPECT_EQ(s.mode, 'N');
  EXPECT_EQ(s.nav_status, 0);
}

TEST(Nmea, RmcWithStatusAAndModeNIsNotValid) {
  const Parsed p = parsed("GPRMC,120001.00,A,6010.02000,N,02456.11000,E,0.0,,010100,8.1,W,N");
  ASSERT_EQ(p.kind, Kind::Used);
  EXPECT_FALSE(std::get<Rmc>(p.sentence).valid());
  EXPECT_EQ(std::get<Rmc>(p.sentence).magvar_deg, -8.1);
}

TEST(Nmea, VtgInItsNewAndOldForm) {
  const auto now = used<Vtg>("$GNVTG,54.7,T,47.1,M,5.5,N,10.2,K,D*0F");
  EXPECT_EQ(now.course_true_deg, 54.7);
  EXPECT_EQ(now.course_mag_deg, 47.1);
  EXPECT_EQ(now.speed_kn, 5.5);
  EXPECT_EQ(now.speed_kmh, 10.2);
  EXPECT_EQ(now.mode, 'D');
  const auto old = used<Vtg>("$GPVTG,54.7,47.1,5.5,10.2*65");
  EXPECT_EQ(old.course_true_deg, 54.7);
  EXPECT_EQ(old.course_mag_deg, 47.1);
  EXPECT_EQ(old.speed_kn, 5.5);
  EXPECT_EQ(old.speed_kmh, 10.2);
  EXPECT_EQ(old.mode, 0);
}

TEST(Nmea, VtgAtStandstillHasNoCourse) {
  const auto s = used<Vtg>("$GNVTG,,T,,M,0.004,N,0.008,K,A*31");
  EXPECT_EQ(s.course_true_deg, std::nullopt);
  EXPECT_EQ(s.course_mag_deg, std::nullopt);
  EXPECT_EQ(s.speed_kn, 0.004);
  EXPECT_EQ(s.mode, 'A');
}

TEST(Nmea, VtgIsToldApartByItsFieldCountNotByItsLetters) {
  // Given a receiver without a fix that leaves the letters empty too
  EXPECT_EQ(parsed("GPVTG,,,,,,,,").kind, Kind::Used);
  EXPECT_EQ(parsed("GPVTG,,,,,,,,,N").kind, Kind::Used);
  EXPECT_EQ(parsed("GPVTG,,,,").kind, Kind::Used);
  // and counts between the two forms are neither
  EXPECT_EQ(parsed("GPVTG,,,,,").flaw, Flaw::TooFewFields);
  EXPECT_EQ(parsed("GPVTG,,,").flaw, Flaw::TooFewFields);
}

TEST(Nmea, GsaWithASystemId) {
  const auto s = used<Gsa>("$GNGSA,A,3,65,72,80,,,,,,,,,,1.5,0.8,1.3,2*32");
  EXPECT_TRUE(s.automatic);
  EXPECT_EQ(s.fix, 3);
  ASSERT_EQ(s.used, 3u);
  EXPECT_EQ(s.ids[0], 65);
  EXPECT_EQ(s.ids[1], 72);
  EXPECT_EQ(s.ids[2], 80);
  EXPECT_EQ(s.pdop, 1.5);
  EXPECT_EQ(s.hdop, 0.8);
  EXPECT_EQ(s.vdop, 1.3);
  EXPECT_EQ(s.system, 2);
}

TEST(Nmea, GsvWithASignalId) {
  const auto s = used<Gsv>("$GPGSV,2,1,05,02,10,123,31,05,63,045,47,12,30,290,40,25,08,200,,1*63");
  EXPECT_EQ(s.total, 2);
  EXPECT_EQ(s.index, 1);
  EXPECT_EQ(s.in_view, 5);
  EXPECT_EQ(s.signal, 1);
  ASSERT_EQ(s.used, 4u);
  EXPECT_EQ(s.sats[0], (Satellite{2, 10, 123, 31}));
  EXPECT_EQ(s.sats[1], (Satellite{5, 63, 45, 47}));
  EXPECT_EQ(s.sats[2], (Satellite{12, 30, 290, 40}));
  EXPECT_EQ(s.sats[3], (Satellite{25, 8, 200, std::nullopt}));

  const auto last = used<Gsv>("$GPGSV,2,2,05,29,51,100,44,1*5F");
  EXPECT_EQ(last.index, 2);
  ASSERT_EQ(last.used, 1u);
  EXPECT_EQ(last.sats[0], (Satellite{29, 51, 100, 44}));

  const auto none = used<Gsv>("$GAGSV,1,1,00,7*73");
  EXPECT_EQ(none.in_view, 0);
  EXPECT_EQ(none.signal, 7);
  EXPECT_EQ(none.used, 0u);
}

TEST(Nmea, GstGivesTheSigmas) {
  const auto s = used<Gst>("$GNGST,101530.20,1.9,0.014,0.009,38.5,0.012,0.010,0.021*76");
  EXPECT_DOUBLE_EQ(s.time_s.value(), 36930.2);
  EXPECT_EQ(s.rms_m, 1.9);
  EXPECT_EQ(s.major_m, 0.014);
  EXPECT_EQ(s.minor_m, 0.009);
  EXPECT_EQ(s.orient_deg, 38.5);
  EXPECT_EQ(s.lat_sd_m, 0.012);
  EXPECT_EQ(s.lon_sd_m, 0.010);
  EXPECT_EQ(s.alt_sd_m, 0.021);
}

TEST(Nmea, HeadingsOfHdtAndThs) {
  EXPECT_EQ(used<Hdt>("$GPHDT,359.97,T*04").heading_deg, 359.97);
  const auto good = used<Ths>("$GNTHS,77.52,A*2E");
  EXPECT_EQ(good.heading_deg, 77.52);
  EXPECT_TRUE(good.valid());
  const auto lost = used<Ths>("$GNTHS,,V*10");
  EXPECT_EQ(lost.heading_deg, std::nullopt);
  EXPECT_FALSE(lost.valid());
  EXPECT_EQ(used<Ths>("$GNTHS,12.04,A*2e").heading_deg, 12.04) << "lower-case checksum";
}

TEST(Nmea, AVoidHeadingIsIgnoredEvenIfTheFieldIsFilled) {
  const Parsed p = parsed("GNTHS,77.52,V");
  ASSERT_EQ(p.kind, Kind::Used);
  EXPECT_EQ(std::get<Ths>(p.sentence).heading_deg, std::nullopt);
}

TEST(Nmea, ZdaGivesTheDate) {
  const auto s = used<Zda>("$GNZDA,235959.95,31,12,2026,00,00*72");
  EXPECT_DOUBLE_EQ(s.time_s.value(), 86399.95);
  EXPECT_EQ(s.date, (Date{year{2026}, month{12}, day{31}}));
  EXPECT_EQ(s.zone_h, 0);
  EXPECT_EQ(s.zone_min, 0);
}

TEST(Nmea, GnsTakesItsBestConstellation) {
  const auto s = used<Gns>(
      "$GNGNS,101530.20,3352.1234567,S,15112.7654321,W,RRFN,17,0.6,58.312,21.705,1.2,0042,V*37");
  EXPECT_NEAR(s.lat.value(), -33.868724278333, kTiny);
  EXPECT_NEAR(s.lon.value(), -151.212757201667, kTiny);
  EXPECT_EQ(s.modes_view(), "RRFN");
  EXPECT_EQ(s.fix(), FixType::RtkFixed);
  EXPECT_EQ(s.sats, 17);
  EXPECT_EQ(s.hdop, 0.6);
  EXPECT_EQ(s.alt_msl_m, 58.312);
  EXPECT_EQ(s.geoid_sep_m, 21.705);
  EXPECT_EQ(s.dgps_age_s, 1.2);
  EXPECT_EQ(s.station, 42);
  EXPECT_EQ(s.nav_status, 'V');
  for (const auto& [modes, fix] :
       std::vector<std::pair<std::string, FixType>>{{"NNFA", FixType::RtkFloat},
                                                    {"AD", FixType::Differential},
                                                    {"AP", FixType::Differential},
                                                    {"NE", FixType::Estimated},
                                                    {"NN", FixType::None},
                                                    {"", FixType::None}}) {
    const Parsed p = parsed("GNGNS,,,,,," + modes + ",,,,,,");
    ASSERT_EQ(p.kind, Kind::Used) << modes;
    EXPECT_EQ(std::get<Gns>(p.sentence).fix(), fix) << modes;
  }
}

TEST(Nmea, AWrongOrMissingChecksumIsRefused) {
  EXPECT_EQ(parse_line("$GPHDT,10.0,T*00").flaw, Flaw::WrongChecksum);
  EXPECT_EQ(parse_line("$GPHDT,10.0,T").flaw, Flaw::NoChecksum);
  EXPECT_EQ(parse_line("$GPHDT,10.0,T*0").flaw, Flaw::NoChecksum);
  EXPECT_EQ(parse_line("$GPHDT,10.0,T*0G").flaw, Flaw::NoChecksum);
  EXPECT_EQ(parse_line("").flaw, Flaw::NoChecksum);
  EXPECT_EQ(parse_line("$" + std::string(300, 'A') + "*00").flaw, Flaw::TooLong);
}

TEST(Nmea, TheListedImpossibleValuesAreRefused) {
  const auto field = [](std::string_view text) {
    const Parsed p = parse_line(text);
    EXPECT_EQ(p.flaw, Flaw::BadField) << text;
    return p.field;
  };
  EXPECT_EQ(field("$GPGGA,000000.00,6060.00000,N,02456.11000,E,1,08,1.0,25.4,M,17.9,M,,*5C"), 2);
  EXPECT_EQ(field("$GPZDA,240000.00,01,01,2026,00,00*66"), 1);
  EXPECT_EQ(field("$GNGGA,000000.00,9000.00001,N,02456.11000,E,1,08,1.0,25.4,M,17.9,M,,*4A"), 2);
  EXPECT_EQ(field("$GPRMC,120001.00,A,6010.02000,N,02456.11000,E,0.0,,310226,,,A*76"), 9);
}

TEST(Nmea, TimesAreSixDigitsWithinTheDay) {
  for (const char* bad : {"12000", "126000", "120061", "1200005", "12000x", "-20000", "12.000",
                          "120000.x", "1e5000", " 20000"}) {
    expect_bad_field(std::string("GPZDA,") + bad + ",01,01,2026,00,00", 1);
  }
  EXPECT_EQ(std::get<Zda>(parsed("GPZDA,235959.123456789,01,01,2026,00,00").sentence).time_s,
            86399.123456789);
  EXPECT_EQ(std::get<Zda>(parsed("GPZDA,120000.,01,01,2026").sentence).time_s, 43200.0);
}

TEST(Nmea, ArcsNeedTheirSideAndDigitsOnly) {
  const auto with = [](std::string lat, std::string side) {
    return "GPGGA,000000.00," + lat + "," + side + ",02456.11000,E,1,08,1.0,25.4,M,17.9,M,,";
  };
  EXPECT_EQ(parsed(with("6010.0", "S")).kind, Kind::Used);
  EXPECT_EQ(parsed(with("9000.0000", "N")).kind, Kind::Used);
  expect_bad_field(with("6010.0", "X"), 3);
  expect_bad_field(with("6010.0", "NN"), 3);
  expect_bad_field(with("6010.0", ""), 2);
  expect_bad_field(with("-010.0", "N"), 2);
  expect_bad_field(with("-1.0", "N"), 2);
  expect_bad_field(with("60-1.0", "N"), 2);
  expect_bad_field(with("6x10.0", "N"), 2);
  expect_bad_field(with("606010.0", "N"), 2);
  expect_bad_field(with("60 0.0", "N"), 2);
  expect_bad_field(with("nan", "N"), 2);
  expect_bad_field("GPGGA,000000.00,6010.0,N,18000.00001,E,1,08,1.0,25.4,M,17.9,M,,", 4);
  expect_bad_field("GPGGA,000000.00,6010.0,N,18000.0,N,1,08,1.0,25.4,M,17.9,M,,", 5);
}

TEST(Nmea, NumbersArePlainDecimals) {
  for (const char* bad :
       {"1e1", "nan", "inf", "0x1", " 1", "1 ", "+1", "1.2.3", "-", ".", "1,5x"}) {
    const Parsed p = parsed(std::string("GNGST,101530.20,") + bad + ",,,,,,,");
    EXPECT_EQ(p.flaw, Flaw::BadField) << bad;
  }
  const Parsed p = parsed("GNGST,101530.20,.5,5.,123456789012345678901234.5,-1.5,0,0,0");
  ASSERT_EQ(p.kind, Kind::Used);
  EXPECT_EQ(std::get<Gst>(p.sentence).rms_m, 0.5);
  EXPECT_EQ(std::get<Gst>(p.sentence).major_m, 5.0);
  EXPECT_EQ(std::get<Gst>(p.sentence).minor_m, 123456789012345678901234.5);
  EXPECT_EQ(std::get<Gst>(p.sentence).orient_deg, -1.5);
}

TEST(Nmea, UnitLettersMustBeTheRightOnes) {
  expect_bad_field("GPGGA,000000.00,,,,,1,08,1.0,25.4,F,17.9,M,,", 10);
  expect_bad_field("GPGGA,000000.00,,,,,1,08,1.0,25.4,M,17.9,f,,", 12);
  expect_bad_field("GPHDT,10.0,M", 2);
  expect_bad_field("GPRMC,,X,,,,,,,,,", 2);
}

TEST(Nmea, ExtraFieldsAreAllowedAndMissingOnesAreNot) {
  EXPECT_EQ(parsed("GPHDT,10.0,T,new,,stuff").kind, Kind::Used);
  EXPECT_EQ(parsed("GPHDT,10.0").flaw, Flaw::TooFewFields);
  EXPECT_EQ(parsed("GPGGA,000000.00,,,,,0,00,99.99,,,,").flaw, Flaw::TooFewFields);
  EXPECT_EQ(parsed("GNHDT").flaw, Flaw::TooFewFields);
  EXPECT_EQ(parsed("GPHDT,10.0,T" + std::string(200, ',')).kind, Kind::Used);
}

TEST(Nmea, OtherTypesAreReportedNotRefused) {
  EXPECT_EQ(parsed("GNGLL,3352.1,S,15112.7,W,101530.20,A,A").kind, Kind::Unused);
  EXPECT_EQ(parsed("GNTXT,01,01,02,hello").kind, Kind::Unused);
  EXPECT_EQ(parsed("PUBX,00,1").kind, Kind::Unknown);
  EXPECT_EQ(parsed("PTHDT,10.0,T").kind, Kind::Unknown) << "P is no talker";
  EXPECT_EQ(parsed("GNABC,1").kind, Kind::Unknown);
  EXPECT_EQ(parsed("X").kind, Kind::Unknown);
  EXPECT_EQ(parsed("").kind, Kind::Unknown);
  EXPECT_EQ(std::get<Hdt>(parsed("QQHDT,10.0,T").sentence).talker.view(), "QQ");
}

TEST(Nmea, TheTimeOfDayPacesAReplay) {
  const auto of = [](std::string_view text) {
    while (text.ends_with('\n') || text.ends_with('\r')) text.remove_suffix(1);
    return time_of_day_s(text);
  };
  EXPECT_EQ(of("$GNZDA,235959.95,31,12,2026,00,00*72\r\n"), 86399.95);
  EXPECT_EQ(of("$GNGST,101530.20,1.9,0.014,0.009,38.5,0.012,0.010,0.021*76"), 36930.2);
  EXPECT_EQ(of(line("GNGLL,3352.1,S,15112.7,W,101530.20,A,A")), 36930.2);
  EXPECT_EQ(of(line("GPHDT,10.0,T")), std::nullopt);
  EXPECT_EQ(of(line("GNGGA,,,,,,0,00,99.99,,,,,,")), std::nullopt);
  EXPECT_EQ(of("$GNZDA,235959.95,31,12,2026,00,00*73\r\n"), std::nullopt);
  EXPECT_EQ(of("# a comment"), std::nullopt);
  EXPECT_EQ(of("# $a comment"), std::nullopt);
  EXPECT_EQ(of("\r\n"), std::nullopt);
  EXPECT_EQ(of("GNZDA,235959.95,31,12,2026,00,00*72"), 86399.95) << "as the framer cuts it";
}

}  // namespace
}  // namespace roverd::gnss
