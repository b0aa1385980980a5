#include "core/interchange/point_reading.h"

#include <gtest/gtest.h>

namespace stiffscope {
namespace timestamp_test {

using interchange::isoTime;
using interchange::parseTimestamp;

std::string iso(const char* text) {
  const auto time = parseTimestamp(text);
  return time ? isoTime(*time) : "none";
}

TEST(Timestamp, OneMomentInEveryWayOfWriting) {
  EXPECT_EQ(iso("10/11/31 15:06:48"), "2031-10-11T15:06:48");  // month first
  EXPECT_EQ(iso("10/11/2031 3:06:48 PM"), "2031-10-11T15:06:48");
  EXPECT_EQ(iso("11.10.2031 15:06:48"), "2031-10-11T15:06:48");  // day first
  EXPECT_EQ(iso("'11.10.2031 15:06:48.043"), "2031-10-11T15:06:48.043");
  EXPECT_EQ(iso("11.10.2031 15:06:48,043"), "2031-10-11T15:06:48.043");
  EXPECT_EQ(iso("2031-10-11T15:06:48Z"), "2031-10-11T15:06:48");
  EXPECT_EQ(iso("2031/10/11 15:06:48"), "2031-10-11T15:06:48");
  EXPECT_EQ(iso("20311011150648"), "2031-10-11T15:06:48");
}

TEST(Timestamp, SecondsSince1970) {
  // 2031-10-11 is day 22563 of that count: 61 years of 365 days, 15 leap days, 283 days of the year before it.
  EXPECT_DOUBLE_EQ(parseTimestamp("2031-10-11T00:00:00")->seconds, 86400.0 * (61 * 365 + 15 + 283));
  EXPECT_DOUBLE_EQ(parseTimestamp("10/11/79 00:00:00")->seconds, parseTimestamp("2079-10-11 00:00")->seconds);
  EXPECT_DOUBLE_EQ(parseTimestamp("10/11/80 00:00:00")->seconds, parseTimestamp("1980-10-11 00:00")->seconds);
}

TEST(Timestamp, TheLastDigitWrittenIsItsResolution) {
  EXPECT_DOUBLE_EQ(parseTimestamp("2031-10-11 15:06")->resolution, 60.0);
  EXPECT_DOUBLE_EQ(parseTimestamp("2031-10-11 15:06:48")->resolution, 1.0);
  EXPECT_DOUBLE_EQ(parseTimestamp("2031-10-11 15:06:48.04")->resolution, 0.01);
}

TEST(Timestamp, NoonMidnightAndRounding) {
  EXPECT_EQ(iso("1/2/31 12:00:00 AM"), "2031-01-02T00:00:00");
  EXPECT_EQ(iso("1/2/31 12:00:00 PM"), "2031-01-02T12:00:00");
  EXPECT_EQ(isoTime({59.9999999, true, 1.0}), "1970-01-01T00:01:00");
  EXPECT_EQ(isoTime({-1.0, true, 1.0}), "1969-12-31T23:59:59");
}

TEST(Timestamp, WhatIsNoTimeIsNone) {
  for (const char* text : {"", "15:06:48", "31.11.2031 10:00:00", "29.02.2030 10:00:00", "13/01/31 10:00:00",
                           "2031-10-11 24:00:00", "2031-10-11 10:60:00", "2031-10-11 10:00:61", "2031-10-11 10:-1:00",
                           // These would wrap around in the calendar's narrow types.
                           "2031-258-01 10:00:00", "2031-01-257 10:00:00", "67567-01-01 10:00:00", "20311301150648",
                           "2,02011E+13", "2031-10-11", "x/y/z 10:00:00", "2031-10-11 10:00:1e1"})
    EXPECT_EQ(iso(text), "none") << text;
}

TEST(Timestamp, DatesTimesAndNoTime) {
  EXPECT_TRUE(interchange::isDate("02/29/28"));
  EXPECT_FALSE(interchange::isDate("02/29/27"));
  EXPECT_TRUE(interchange::isTimeOfDay("9:08:07.5"));
  EXPECT_FALSE(interchange::isTimeOfDay("9"));
  EXPECT_TRUE(interchange::isNoTime("00:00:00"));
  EXPECT_FALSE(interchange::isNoTime("00:00:01"));
}

}  // namespace timestamp_test
}  // namespace stiffscope
