// Paired devices and their PINs, and the invitation of another phone.

#include "house.hpp"
#include "people/secret.hpp"

namespace roverd::people {
namespace {

class Pairing : public BookTest {
 protected:
  Opened<Device> pair(Role role = Role::Admin, const std::string& user = "anna",
                      const std::string& replaced = "", const std::string& session = "") {
    Device wanted;
    wanted.user = user;
    wanted.name = "glove phone";
    wanted.role = role;
    wanted.pin = "hash of the PIN";
    return book.pair(wanted, replaced, session, now).value_or(Opened<Device>{});
  }
  /// Empty: refused, also because the device is locked.
  std::optional<Opened<Session>> enter(const std::string& secret, bool right) {
    const Device* device = book.by_device(secret, now);
    if (device == nullptr || Book::is_locked(*device)) return std::nullopt;
    return book.end_pin(book.begin_pin(*device, "10.0.0.2", now), right, now);
  }
};

TEST_F(Pairing, TheDeviceAloneOpensNothingAndWithThePinMakesASession) {
  const auto phone = pair(Role::Operator);
  EXPECT_FALSE(book.by_session(phone.secret, now));
  EXPECT_FALSE(book.by_token(phone.secret, now));
  EXPECT_EQ(book.by_device(phone.row.hash, now), nullptr);
  EXPECT_EQ(book.by_device(phone.row.id, now), nullptr);
  EXPECT_EQ(book.by_device("", now), nullptr);
  EXPECT_FALSE(enter(phone.secret, false));
  const auto opened = enter(phone.secret, true);
  ASSERT_TRUE(opened);
  const auto who = book.by_session(opened->secret, now);
  ASSERT_TRUE(who);
  EXPECT_EQ(who->user, "anna");
  EXPECT_EQ(who->role, Role::Operator);  // though anna is an admin
  EXPECT_EQ(opened->row.device, "glove phone");
  EXPECT_EQ(book.devices_of("anna").front().used, kNoon);
}

TEST_F(Pairing, TheLesserRoleCountsAlsoWhenTheUsersChanges) {
  const auto phone = pair(Role::Operator);
  const auto opened = enter(phone.secret, true);
  ASSERT_TRUE(book.add_user("bert", Role::Admin, "h", now));
  ASSERT_TRUE(book.change_user("anna", Role::Viewer, std::nullopt));
  EXPECT_EQ(book.by_session(opened->secret, now)->role, Role::Viewer);
  EXPECT_EQ(book.still({"anna", Role::Admin, Who::By::Session, opened->row.id}, now)->role,
            Role::Viewer);
}

TEST_F(Pairing, FiveWrongPinsLockItAlsoOverARestart) {
  const auto phone = pair();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(enter(phone.secret, false));
  start_again(kNoon + 1h);
  EXPECT_EQ(book.by_device(phone.secret, now)->wrong, 3);
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(enter(phone.secret, false));
  EXPECT_TRUE(Book::is_locked(*book.by_device(phone.secret, now)));
  EXPECT_FALSE(enter(phone.secret, true));
  start_again(kNoon + 2h);
  EXPECT_FALSE(enter(phone.secret, true));
  // The password unlocks it, of that user only.
  book.unlock(phone.secret, "bert", now);
  EXPECT_FALSE(enter(phone.secret, true));
  book.unlock(phone.secret, "anna", now);
  EXPECT_TRUE(enter(phone.secret, true));
}

TEST_F(Pairing, APinCountsAsWrongBeforeItIsCompared) {
  const auto phone = pair();
  (void)book.take_change();
  const auto attempt = book.begin_pin(*book.by_device(phone.secret, now), "10.0.0.2", now);
  const Change change = book.take_change();
  ASSERT_EQ(change.now.devices.size(), 1u);
  EXPECT_EQ(change.now.devices[0].wrong, 1);
  ASSERT_TRUE(book.end_pin(attempt, true, now));
  EXPECT_EQ(book.take_change().now.devices.at(0).wrong, 0);
}

TEST_F(Pairing, WrongPinsMustWaitAndHoldUpNoOtherDevice) {
  const auto one = pair();
  const auto two = pair();
  const Device* device = book.by_device(one.secret, now);
  for (int i = 0; i < 4; ++i) (void)book.begin_pin(*device, "10.0.1." + std::to_string(i), now);
  EXPECT_EQ(book.pin_wait(*device, "10.0.2.1", now), 1s);
  EXPECT_EQ(book.pin_wait(*book.by_device(two.secret, now), "10.0.2.1", now), 0s);
  EXPECT_EQ(book.login_wait("anna", "10.0.2.1", now), 0s);
}

TEST_F(Pairing, EndingItEndsWhatItsPinMadeAndNothingElse) {
  const auto by_password = log_in();
  const auto phone = pair();
  const auto by_pin = enter(phone.secret, true);
  EXPECT_EQ(book.end_device("bert", phone.row.id).error().code, base::Code::NotFound);
  ASSERT_TRUE(book.end_device("anna", phone.row.id));
  EXPECT_EQ(book.by_device(phone.secret, now), nullptr);
  EXPECT_FALSE(book.by_session(by_pin->secret, now));
  EXPECT_TRUE(book.by_session(by_password.secret, now));
  keep();
  EXPECT_TRUE(kept.devices.empty());
  EXPECT_EQ(kept.sessions.size(), 1u);
}

TEST_F(Pairing, PairingAgainReplacesAndTheSessionGoesOn) {
  const auto before = pair(Role::Operator);
  const auto opened = enter(before.secret, true);
  const auto other = enter(before.secret, true);
  const auto after = pair(Role::Viewer, "anna", before.secret, opened->row.id);
  EXPECT_EQ(book.by_device(before.secret, now), nullptr);
  EXPECT_EQ(book.devices_of("anna").size(), 1u);
  ASSERT_TRUE(book.by_session(opened->secret, now));
  EXPECT_EQ(book.by_session(opened->secret, now)->role, Role::Viewer);
  EXPECT_FALSE(book.by_session(other->secret, now));
  start_again(kNoon + 1h);
  EXPECT_TRUE(book.by_session(opened->secret, now));
  EXPECT_NE(book.by_device(after.secret, now), nullptr);
}

TEST_F(Pairing, ANewPasswordEndsTheOtherPairings) {
  const auto here = pair();
  const auto lost = pair();
  const auto stolen = enter(lost.secret, true);
  const auto mine = enter(here.secret, true);
  const std::string code = book.invite({"anna", "anna", Role::Admin}, now);
  ASSERT_TRUE(book.change_user("anna", {}, "new hash", mine->row.id, here.row.id));
  EXPECT_TRUE(book.by_session(mine->secret, now));
  EXPECT_FALSE(book.by_session(stolen->secret, now));
  EXPECT_NE(book.by_device(here.secret, now), nullptr);
  EXPECT_EQ(book.by_device(lost.secret, now), nullptr);
  EXPECT_FALSE(book.take_invitation(code, "a", now));
}

TEST_F(Pairing, ADeviceThatIsNotUsedForAYearIsPairedNoMore) {
  const auto phone = pair();
  pass(24h * 364);
  EXPECT_TRUE(enter(phone.secret, true));
  pass(24h * 364);
  EXPECT_NE(book.by_device(phone.secret, now), nullptr);
  pass(24h * 2);
  EXPECT_EQ(book.by_device(phone.secret, now), nullptr);
  now.wall = {};  // not known
  EXPECT_NE(book.by_device(phone.secret, now), nullptr);
}

TEST_F(Pairing, DevicesAreBoundedAndGoWithTheirUser) {
  ASSERT_TRUE(book.add_user("bert", Role::Admin, "h", now));
  const auto phone = pair();
  for (std::size_t i = 1; i < Book::kDevicesEach; ++i) pair();
  EXPECT_EQ(book.may_pair("anna").error().code, base::Code::Conflict);
  EXPECT_EQ(pair().secret, "");
  EXPECT_NE(pair(Role::Admin, "anna", phone.secret).secret, "");  // instead
  EXPECT_EQ(book.may_pair("nobody").error().code, base::Code::NotFound);
  ASSERT_TRUE(book.remove_user("anna"));
  EXPECT_TRUE(book.devices_of("anna").empty());
  EXPECT_TRUE(book.take_change().now.devices.empty());
}

TEST_F(Pairing, APinThatWasReplacedMeanwhileIsNoLogIn) {
  const auto phone = pair();
  const auto attempt = book.begin_pin(*book.by_device(phone.secret, now), "a", now);
  ASSERT_TRUE(book.end_device("anna", phone.row.id));
  EXPECT_FALSE(book.end_pin(attempt, true, now));
}

TEST_F(Pairing, AnInvitationIsGoodOnceAndForTenMinutes) {
  const std::string code = book.invite({"anna", "anna", Role::Operator}, now);
  EXPECT_FALSE(book.take_invitation("AAAA-AAAA", "a", now));
  EXPECT_FALSE(book.take_invitation("", "a", now));
  const auto taken = book.take_invitation(code, "a", now);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->user, "anna");
  EXPECT_EQ(taken->role, Role::Operator);
  EXPECT_FALSE(book.take_invitation(code, "a", now));
  const std::string late = book.invite({"anna", "anna", Role::Operator}, now);
  pass(10min);
  EXPECT_FALSE(book.take_invitation(late, "a", now));
  const std::string first = book.invite({"anna", "anna", Role::Operator}, now);
  const std::string second = book.invite({"anna", "anna", Role::Operator}, now);
  EXPECT_FALSE(book.take_invitation(first, "a", now));
  EXPECT_TRUE(book.take_invitation(second, "a", now));
}

TEST_F(Pairing, AnInvitationNeedsAnInviterWhoMayStill) {
  ASSERT_TRUE(book.add_user("bert", Role::Admin, "h", now));
  ASSERT_TRUE(book.add_user("carl", Role::Operator, "h", now));
  const std::string code = book.invite({"bert", "carl", Role::Operator}, now);
  ASSERT_TRUE(book.change_user("bert", Role::Operator, std::nullopt));
  EXPECT_FALSE(book.take_invitation(code, "a", now));
  const std::string gone = book.invite({"anna", "carl", Role::Operator}, now);
  ASSERT_TRUE(book.remove_user("carl"));
  ASSERT_TRUE(book.add_user("carl", Role::Admin, "h", now));
  EXPECT_FALSE(book.take_invitation(gone, "a", now));
}

TEST_F(Pairing, AnInvitationThatWasTakenEndsOnceAndWithItsInvitersRight) {
  ASSERT_TRUE(book.add_user("bert", Role::Admin, "h", now));
  ASSERT_TRUE(book.add_user("carl", Role::Operator, "h", now));
  const auto taken = [&](const std::string& inviter) {
    return *book.take_invitation(book.invite({inviter, "carl", Role::Operator}, now), "a", now);
  };
  const auto good = taken("bert");
  EXPECT_TRUE(book.end_invitation(good, now));
  EXPECT_FALSE(book.end_invitation(good, now));
  // while the PIN is hashed: another invitation of the same inviter does no harm,
  const auto first = taken("bert");
  const auto second = taken("bert");
  EXPECT_TRUE(book.end_invitation(first, now));
  EXPECT_TRUE(book.end_invitation(second, now));
  // but it ends with the inviter's role, with the device or session that invited, and in time.
  const auto demoted = taken("bert");
  ASSERT_TRUE(book.change_user("bert", Role::Operator, std::nullopt));
  EXPECT_FALSE(book.end_invitation(demoted, now));
  const auto lost = taken("anna");
  (void)book.end_other_sessions("anna", "");
  EXPECT_FALSE(book.end_invitation(lost, now));
  const auto late = taken("anna");
  pass(10min);
  EXPECT_FALSE(book.end_invitation(late, now));
}

TEST_F(Pairing, WhatALostPhoneInvitedEndsWithIt) {
  const auto lost = pair();
  const auto stolen = enter(lost.secret, true);
  const std::string by_device = book.invite({"anna", "anna", Role::Admin}, now);
  ASSERT_TRUE(book.end_device("anna", lost.row.id));
  EXPECT_FALSE(book.take_invitation(by_device, "a", now));
  const auto here = pair();
  const auto mine = enter(here.secret, true);
  const std::string by_session = book.invite({"anna", "anna", Role::Admin}, now);
  ASSERT_TRUE(book.end_session("anna", mine->row.id));
  EXPECT_FALSE(book.take_invitation(by_session, "a", now));
  const std::string by_other = book.invite({"anna", "anna", Role::Admin}, now);
  (void)book.end_other_sessions("anna", "");
  EXPECT_FALSE(book.take_invitation(by_other, "a", now));
}

TEST_F(Pairing, GuessingCodesMustWait) {
  (void)book.invite({"anna", "anna", Role::Operator}, now);
  for (int i = 0; i < 8; ++i) EXPECT_FALSE(book.take_invitation("AAAA-AAAA", "10.0.0.9", now));
  EXPECT_EQ(book.login_wait({}, "10.0.0.9", now), 16s);
}

TEST(Pin, IsFourToEightDigitsAndNotTheFirstGuess) {
  for (const char* pin : {"", "123", "123456789", "12a4", "１２３４", "-123", "0000", "1111",
                          "1234", "4321", "7890", "0987", "01234567", "1212", "454545"}) {
    EXPECT_NE(pin_problem(pin), "") << pin;
  }
  for (const char* pin : {"2580", "1357", "1123", "90210", "12344321"}) {
    EXPECT_EQ(pin_problem(pin), "") << pin;
  }
}

}  // namespace
}  // namespace roverd::people
