// Who is named, who comes back, and when it cannot be told.

#include <gtest/gtest.h>

#include "nav/vote/decide.hpp"

namespace roverd::nav {
namespace {

using base::Time;

std::array<bool, kSenses> all(std::initializer_list<Sense> list) {
  std::array<bool, kSenses> out{};
  for (const Sense s : list) out[index_of(s)] = true;
  return out;
}

const auto kAll = all({Sense::Tracks, Sense::Gyro, Sense::Position, Sense::Velocity, Sense::Compass,
                       Sense::Antennas});
const std::array<bool, kSenses> kNobody{};

/// Two that differ by so many limits.
void differ(Table& t, Sense a, Sense b, double limits) {
  Finding f;
  f.judged = true;
  f.off = {Difference::Of::Way, limits, 2.0};
  f.limit = 1.0;
  f.way_off_m = limits;
  t.put(a, b, f);
}

TEST(Judge, ExactlyAtTheLimitTwoAgree) {
  Table t;
  differ(t, Sense::Gyro, Sense::Velocity, 1.0);
  differ(t, Sense::Gyro, Sense::Tracks, 1.0);
  EXPECT_FALSE(judge(t, kAll, kNobody).liar);
  EXPECT_FALSE(judge(t, kAll, kNobody).undecided);
}

TEST(Judge, WhoContradictsTwoIsTheOne) {
  Table t;
  differ(t, Sense::Gyro, Sense::Velocity, 1.01);
  differ(t, Sense::Tracks, Sense::Gyro, 1.01);
  EXPECT_EQ(judge(t, kAll, kNobody).liar, Sense::Gyro);
}

TEST(Judge, WithoutAVoiceNobodyTestifies) {
  Table t;
  differ(t, Sense::Gyro, Sense::Velocity, 3.0);
  differ(t, Sense::Tracks, Sense::Gyro, 2.0);
  const auto verdict = judge(t, all({Sense::Gyro, Sense::Velocity, Sense::Position}), kNobody);
  EXPECT_FALSE(verdict.liar);
  ASSERT_TRUE(verdict.undecided);
  EXPECT_EQ((*verdict.undecided)[0], Sense::Gyro);
  EXPECT_EQ((*verdict.undecided)[1], Sense::Velocity);
}

TEST(Judge, AReceiversPositionAndVelocityAreOneWitnessAgainstTheGyro) {
  Table t;
  differ(t, Sense::Gyro, Sense::Position, 2.0);
  differ(t, Sense::Gyro, Sense::Velocity, 2.0);
  EXPECT_EQ(judge(t, kAll, kNobody).liar, Sense::Gyro);
  differ(t, Sense::Tracks, Sense::Position, 1.5);
  t.runs_off = true;
  const auto verdict = judge(t, kAll, kNobody);
  EXPECT_FALSE(verdict.liar);
  ASSERT_TRUE(verdict.undecided);
  EXPECT_EQ((*verdict.undecided)[0], Sense::Tracks);
  EXPECT_EQ((*verdict.undecided)[1], Sense::Position);
  // A position that says the same again and again is known to be the one.
  EXPECT_NE(judge(t, kAll, all({Sense::Position})).undecided, verdict.undecided);
}

TEST(Judge, ThreeThatAllContradictEachOtherAreUndecided) {
  Table t;
  differ(t, Sense::Gyro, Sense::Velocity, 3.0);
  differ(t, Sense::Tracks, Sense::Gyro, 2.0);
  differ(t, Sense::Tracks, Sense::Velocity, 4.0);
  const auto verdict = judge(t, kAll, kNobody);
  EXPECT_FALSE(verdict.liar);
  ASSERT_TRUE(verdict.undecided);
  EXPECT_EQ((*verdict.undecided)[0], Sense::Tracks);  // the worst two
  EXPECT_EQ((*verdict.undecided)[1], Sense::Velocity);
}

TEST(Judge, OfTwoTheFrozenOneLiesAndACompassIsOnlyAHint) {
  Table t;
  differ(t, Sense::Position, Sense::Velocity, 2.0);
  EXPECT_EQ(judge(t, kAll, all({Sense::Velocity})).liar, Sense::Velocity);
  EXPECT_FALSE(judge(t, kAll, all({Sense::Velocity, Sense::Position})).liar);
  t.for_velocity = true;
  EXPECT_EQ(judge(t, kAll, kNobody).liar, Sense::Position);
  Table hint;
  differ(hint, Sense::Gyro, Sense::Compass, 1.5);
  EXPECT_EQ(judge(hint, kAll, kNobody).liar, Sense::Compass);
}

class JuryTest : public testing::Test {
 protected:
  std::optional<Sense> look(const Table& t) {
    now_ += base::from_seconds(Jury::kEvery_s);
    return jury.step(t, heard, frozen, 10.0, now_);
  }
  /// How many looks until it is heard again.
  int until_back(const Table& t, Sense s, int most) {
    for (int i = 1; i <= most; ++i) {
      look(t);
      if (!jury.out(s)) return i;
    }
    return -1;
  }
  static Table lie(Sense liar, double limits = 2.0) {
    Table t;
    differ(t, Sense::Gyro, Sense::Tracks, 0.2);
    for (const Sense s : {Sense::Tracks, Sense::Position, Sense::Velocity}) {
      if (s != liar) differ(t, liar, s, limits);
    }
    return t;
  }

  Jury jury;
  std::array<bool, kSenses> heard = kAll;
  std::array<bool, kSenses> frozen{};

 private:
  Time now_{};
};

TEST_F(JuryTest, ALieIsToldThreeTimesInARowBeforeItsTellerIsLeftOut) {
  const Table t = lie(Sense::Gyro);
  EXPECT_FALSE(look(t));
  EXPECT_FALSE(look(t));
  look(Table{});  // between them all is well
  EXPECT_FALSE(look(t));
  EXPECT_FALSE(look(t));
  EXPECT_FALSE(jury.out(Sense::Gyro));
  EXPECT_EQ(look(t), Sense::Gyro);
  EXPECT_TRUE(jury.out(Sense::Gyro));
  EXPECT_EQ(jury.votes().accusations, 1u);
  const auto& vote = jury.votes()[Sense::Gyro];
  EXPECT_EQ(vote.against, all({Sense::Tracks, Sense::Position, Sense::Velocity}));
  EXPECT_EQ(vote.off.size, 2.0);
}

TEST_F(JuryTest, PositionsThatRunApartAreToldAfterThreeLooksOfTheirOwnAndAStepAfterEight) {
  Table tracks;
  differ(tracks, Sense::Tracks, Sense::Velocity, 1.5);
  Table step;
  differ(step, Sense::Position, Sense::Velocity, 1.5);
  step.apart = 1.5;
  Table away = step;
  away.runs_apart = true;
  look(tracks);
  look(tracks);
  look(away);
  look(away);
  EXPECT_FALSE(jury.votes().undecided);
  look(away);
  EXPECT_TRUE(jury.votes().undecided);
  EXPECT_EQ(jury.votes().accusations, 1u);

  jury.acquit_all({});  // and if it is so again, it is told again
  for (int i = 0; i < 7; ++i) look(step);
  EXPECT_FALSE(jury.votes().undecided);
  look(step);
  EXPECT_TRUE(jury.votes().undecided);
  EXPECT_EQ(jury.votes().accusations, 2u);
}

TEST_F(JuryTest, PositionsThatNothingHasProvedAreToldAfterThreeLooksWhoeverIsNamedMeanwhile) {
  Table bend;
  differ(bend, Sense::Position, Sense::Gyro, 1.5);
  Table way = lie(Sense::Position);
  bend.unproved = way.unproved = true;
  look(bend);
  look(way);
  EXPECT_FALSE(jury.votes().undecided);
  look(bend);
  ASSERT_TRUE(jury.votes().undecided);
  EXPECT_EQ((*jury.votes().undecided)[0], Sense::Gyro);
  EXPECT_EQ((*jury.votes().undecided)[1], Sense::Position);
  EXPECT_EQ(jury.votes().undecided_off.size, 1.5);
  EXPECT_EQ(jury.votes().accusations, 1u);
  EXPECT_TRUE(jury.votes().unproved_differed);

  jury.acquit_all({});
  EXPECT_FALSE(jury.votes().unproved_differed);
  bend.unproved = way.unproved = false;  // they were driven with for long: their word counts
  look(bend);
  look(way);
  look(bend);
  EXPECT_FALSE(jury.votes().undecided);
  EXPECT_FALSE(jury.votes().unproved_differed);
}

TEST_F(JuryTest, ACompassIsNoWitnessAgainstPositionsThatNothingHasProved) {
  Table t;
  differ(t, Sense::Position, Sense::Compass, 1.5);
  t.unproved = true;
  for (int i = 0; i < 5; ++i) look(t);
  EXPECT_FALSE(jury.votes().undecided);
  EXPECT_FALSE(jury.votes().unproved_differed);
}

TEST_F(JuryTest, WhatStandsBetweenThoseWithAVoiceIsDoubtedFromTheSecondLookOn) {
  look(lie(Sense::Position, 2.5));
  EXPECT_EQ(jury.votes().doubt_m, 0.0);
  look(lie(Sense::Position, 1.5));
  EXPECT_EQ(jury.votes().doubt_m, 1.5);
  look(Table{});
  look(lie(Sense::Position, 2.5));
  look(lie(Sense::Position, 2.5));
  look(lie(Sense::Position, 2.5));
  EXPECT_TRUE(jury.out(Sense::Position));
  EXPECT_EQ(jury.votes().doubt_m, 0.0);  // from here on the estimate itself carries it
}

TEST_F(JuryTest, ItComesBackAfterTenSecondsOfAgreementAndNotWhileItIsFrozenOrSilent) {
  for (int i = 0; i < 3; ++i) look(lie(Sense::Gyro));
  const Table well = lie(Sense::Gyro, 0.5);
  for (int i = 0; i < 49; ++i) look(well);
  look(lie(Sense::Gyro));  // once more: all begins anew
  EXPECT_EQ(until_back(well, Sense::Gyro, 100), 51);
  for (int i = 0; i < 3; ++i) look(lie(Sense::Gyro));
  frozen[index_of(Sense::Gyro)] = true;
  EXPECT_EQ(until_back(well, Sense::Gyro, 200), -1);
  frozen = {};
  heard[index_of(Sense::Gyro)] = false;
  EXPECT_EQ(until_back(well, Sense::Gyro, 200), -1);
  heard = kAll;
  EXPECT_EQ(until_back(well, Sense::Gyro, 200), 51);
}

TEST_F(JuryTest, SilenceOfAllOthersIsNoAgreement) {
  for (int i = 0; i < 3; ++i) look(lie(Sense::Gyro));
  EXPECT_EQ(until_back(Table{}, Sense::Gyro, 200), -1);
}

TEST_F(JuryTest, WhatCannotBeDecidedIsToldAfterEightLooksAndStaysForThreeSeconds) {
  Table t;
  differ(t, Sense::Gyro, Sense::Velocity, 2.0);
  for (int i = 0; i < 7; ++i) look(t);
  EXPECT_FALSE(jury.votes().undecided);
  look(t);
  ASSERT_TRUE(jury.votes().undecided);
  EXPECT_FALSE(jury.out(Sense::Gyro));
  EXPECT_FALSE(jury.out(Sense::Velocity));
  for (int i = 0; i < 15; ++i) look(Table{});
  EXPECT_TRUE(jury.votes().undecided);
  look(Table{});
  EXPECT_FALSE(jury.votes().undecided);
}

TEST_F(JuryTest, APersonsWordBringsAllBack) {
  for (int i = 0; i < 3; ++i) look(lie(Sense::Gyro));
  jury.acquit_all(Time{std::chrono::seconds(99)});
  EXPECT_FALSE(jury.out(Sense::Gyro));
  EXPECT_EQ(jury.from(Sense::Gyro), Time{std::chrono::seconds(99)});
}

}  // namespace
}  // namespace roverd::nav
