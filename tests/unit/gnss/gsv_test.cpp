#include "gnss/gsv.hpp"

#include <gtest/gtest.h>

#include "gnss/nmea.hpp"

namespace roverd::gnss {
namespace {

Gsv gsv(std::string_view text) {
  const Parsed p = parse_line(text);
  EXPECT_EQ(p.kind, Kind::Used) << text;
  return std::get<Gsv>(p.sentence);
}

Gsv part(int index, int total, int first_id, std::optional<int> signal = std::nullopt,
         Talker talker = {{'G', 'P'}}) {
  Gsv s;
  s.talker = talker;
  s.index = index;
  s.total = total;
  s.in_view = total * 4;
  s.signal = signal;
  for (int i = 0; i < 4; ++i) s.sats[s.used++] = {first_id + i, 10, 20, 30};
  return s;
}

TEST(GsvAssembler, TwoSentencesMakeOneGroupOfFive) {
  GsvAssembler assembler;
  EXPECT_FALSE(
      assembler.add(gsv("$GPGSV,2,1,05,02,10,123,31,05,63,045,47,12,30,290,40,25,08,200,,1*63")));
  const auto group = assembler.add(gsv("$GPGSV,2,2,05,29,51,100,44,1*5F"));
  ASSERT_TRUE(group);
  EXPECT_EQ(group->used, 5u);
  EXPECT_EQ(group->in_view, 5);
  EXPECT_EQ(group->signal, 1);
  EXPECT_EQ(group->sats[0].id, 2);
  EXPECT_EQ(group->sats[4].id, 29);
}

TEST(GsvAssembler, TheSecondPartAloneIsNoGroup) {
  GsvAssembler assembler;
  EXPECT_FALSE(assembler.add(gsv("$GPGSV,2,2,05,29,51,100,44,1*5F")));
}

TEST(GsvAssembler, AnEmptyGroupIsAGroup) {
  GsvAssembler assembler;
  const auto group = assembler.add(gsv("$GAGSV,1,1,00,7*73"));
  ASSERT_TRUE(group);
  EXPECT_EQ(group->used, 0u);
}

TEST(GsvAssembler, GroupsOfOtherTalkersAndSignalsMayInterleave) {
  const Talker galileo{{'G', 'A'}};
  GsvAssembler assembler;
  EXPECT_FALSE(assembler.add(part(1, 2, 1, 1)));
  EXPECT_FALSE(assembler.add(part(1, 2, 11, 6)));
  EXPECT_FALSE(assembler.add(part(1, 2, 21, 1, galileo)));
  EXPECT_EQ(assembler.add(part(2, 2, 5, 1))->sats[7].id, 8);
  EXPECT_EQ(assembler.add(part(2, 2, 25, 1, galileo))->sats[0].id, 21);
  EXPECT_EQ(assembler.add(part(2, 2, 15, 6))->sats[0].id, 11);
}

TEST(GsvAssembler, AGroupWithAMissingPartIsDropped) {
  GsvAssembler assembler;
  EXPECT_FALSE(assembler.add(part(1, 3, 1)));
  EXPECT_FALSE(assembler.add(part(3, 3, 9)));
  EXPECT_FALSE(assembler.add(part(2, 3, 5))) << "too late now";
  EXPECT_FALSE(assembler.add(part(1, 3, 1)));
  EXPECT_FALSE(assembler.add(part(2, 3, 5)));
  EXPECT_EQ(assembler.add(part(3, 3, 9))->used, 12u);
}

TEST(GsvAssembler, ANewBeginningReplacesAnOldOne) {
  GsvAssembler assembler;
  EXPECT_FALSE(assembler.add(part(1, 2, 1)));
  EXPECT_FALSE(assembler.add(part(1, 2, 50)));
  EXPECT_EQ(assembler.add(part(2, 2, 54))->sats[0].id, 50);
}

TEST(GsvAssembler, ManyTalkersShareABoundedNumberOfSlots) {
  GsvAssembler assembler;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(assembler.add(part(1, 9, 1, i)));
  EXPECT_FALSE(assembler.add(part(2, 9, 5, 0))) << "its slot went to another";
  for (int i = 1; i < 9; ++i) EXPECT_FALSE(assembler.add(part(i, 9, 4 * i, 99)));
  EXPECT_EQ(assembler.add(part(9, 9, 36, 99))->used, 36u);
}

}  // namespace
}  // namespace roverd::gnss
