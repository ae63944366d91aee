// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/nmea.hpp"

#include <gtest/gtest.h>

#include "tests/support/velodyne_encoder.hpp"

namespace cairn::velodyne {
namespace {

using test::nmea;

Errc code_of(const std::string& sentence) {
  const auto parsed = parse_nmea(sentence);
  EXPECT_FALSE(parsed.has_value()) << sentence;
  return parsed ? Errc::kIo : parsed.error().code;
}

TEST(Nmea, RmcGivesDateTimeAndValidity) {
  // The sentence of a real receiver; its checksum is its own.
  const auto t = parse_nmea("$GPRMC,081802.00,A,3649.7478558,N,00224.4542928,W,0.034,212.5,210116,0.0,E,A*2E\r\n");
  ASSERT_TRUE(t) << to_string(t.error());
  EXPECT_TRUE(t->valid);
  EXPECT_EQ(t->time_of_day_us, ((8 * 60 + 18) * 60 + 2) * 1'000'000LL);
  EXPECT_EQ(t->utc_us, 1'453'364'282LL * 1'000'000);  // 2016-01-21 08:18:02 UTC
  ASSERT_TRUE(t->place);
  EXPECT_NEAR(t->place->latitude_deg, 36 + 49.7478558 / 60, 1e-9);
  EXPECT_NEAR(t->place->longitude_deg, -(2 + 24.4542928 / 60), 1e-9);
}

TEST(Nmea, DatesAcrossTheRangeOfTwoDigitYears) {
  const std::pair<const char*, std::int64_t> dates[] = {{"010180", 315532800},
                                                        {"311299", 946598400},
                                                        {"010100", 946684800},
                                                        {"290224", 1709164800},
                                                        {"311279", 3471206400}};
  for (const auto& [date, seconds] : dates) {
    const auto t = parse_nmea(nmea("GPRMC,000000,A,,,,,,," + std::string(date) + ",,,A"));
    ASSERT_TRUE(t) << date;
    EXPECT_EQ(t->utc_us, seconds * 1'000'000) << date;
  }
  for (const char* wrong : {"290223", "320124", "001224", "011324", "12", "1a0124", "-10124", ""})
    EXPECT_EQ(code_of(nmea("GPRMC,000000,A,,,,,,," + std::string(wrong) + ",,,A")), Errc::kMalformed) << wrong;
}

TEST(Nmea, PlacesThatCannotBeAreNone) {
  const auto place = [](const std::string& fields) {
    return parse_nmea(nmea("GPRMC,000000,A," + fields + ",,,010120,,,A")).value().place;
  };
  ASSERT_TRUE(place("4807.038,S,01131.000,E"));
  EXPECT_NEAR(place("4807.038,S,01131.000,E")->latitude_deg, -48.1173, 1e-9);
  EXPECT_NEAR(place("4807,N,01131,E")->longitude_deg, 11 + 31 / 60.0, 1e-9) << "whole minutes";
  for (const char* wrong :
       {",,,", "4807.038,,01131.000,E", "4807.038,N,01131.000,", "4807.038,X,01131.000,E", "9100.000,N,01131.000,E",
        "9000.001,N,01131.000,E", "4860.000,N,01131.000,E", "4807.038,N,18100.000,E", "48a7.038,N,01131.000,E",
        "4807.03x,N,01131.000,E", "-807.038,N,01131.000,E", "48,N,011,E"})
    EXPECT_FALSE(place(wrong)) << wrong;
  const auto gga = parse_nmea(nmea("GNGGA,235959,4807.038,N,01131.000,W,1,08,0.9,545.4,M,46.9,M,,"));
  ASSERT_TRUE(gga && gga->place);
  EXPECT_NEAR(gga->place->longitude_deg, -(11 + 31 / 60.0), 1e-9);
}

TEST(Nmea, VoidRmcIsReadButNotValid) {
  const auto t = parse_nmea(nmea("GPRMC,120000.5,V,,,,,,,010120,,,N"));
  ASSERT_TRUE(t);
  EXPECT_FALSE(t->valid);
  EXPECT_EQ(t->time_of_day_us, 43'200'500'000);
  EXPECT_EQ(code_of(nmea("GPRMC,120000,X,,,,,,,010120,,,N")), Errc::kMalformed);
}

TEST(Nmea, GgaHasNoDate) {
  const auto fixed = parse_nmea(nmea("GNGGA,235959.999999,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,"));
  ASSERT_TRUE(fixed);
  EXPECT_TRUE(fixed->valid);
  EXPECT_EQ(fixed->time_of_day_us, 86'399'999'999);
  EXPECT_FALSE(fixed->utc_us);
  EXPECT_FALSE(parse_nmea(nmea("GPGGA,235959,,,,,0,00,,,M,,M,,")).value().valid);
}

TEST(Nmea, TimesOutOfRangeAreRefused) {
  for (const char* time : {"240000", "006000", "000061", "12000", "", "120000,5", "120000x5", "120000.5x", "-10000"})
    EXPECT_EQ(code_of(nmea("GPRMC," + std::string(time) + ",A,,,,,,,010120,,,A")), Errc::kMalformed) << time;
  EXPECT_EQ(parse_nmea(nmea("GPRMC,235960,A,,,,,,,311216,,,A"))->utc_us, 1'483'228'800LL * 1'000'000);  // leap second
}

TEST(Nmea, EveryWrongCharacterIsNoticed) {
  const std::string good = nmea("GPRMC,081802.00,A,,,,,,,210116,,,A");
  ASSERT_TRUE(parse_nmea(good));
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x04);
    EXPECT_FALSE(parse_nmea(bad)) << bad;
  }
  for (std::size_t n = 0; n < good.size(); ++n) EXPECT_FALSE(parse_nmea(good.substr(0, n)));
}

TEST(Nmea, SaysWhatIsWrong) {
  EXPECT_EQ(code_of(""), Errc::kMalformed);
  EXPECT_EQ(code_of("GPRMC"), Errc::kMalformed);
  EXPECT_EQ(code_of("$GPRMC,081802.00,A"), Errc::kTruncated);
  EXPECT_EQ(code_of("$GPRMC*0"), Errc::kTruncated);
  EXPECT_EQ(code_of(nmea("GPZDA,201530.00,04,07,2002,00,00")), Errc::kUnsupported);
  EXPECT_EQ(code_of(nmea("")), Errc::kUnsupported);
  EXPECT_EQ(code_of("$" + std::string(1000, 'A') + "*00"), Errc::kTruncated);
}

}  // namespace
}  // namespace cairn::velodyne
