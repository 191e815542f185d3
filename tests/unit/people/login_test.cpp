// Guessing is slow, and does not lock out those who belong here.

#include "house.hpp"
#include "people/secret.hpp"

namespace roverd::people {
namespace {

class Login : public BookTest {
 protected:
  void guess(int times, const std::string& user, const std::string& address) {
    for (int i = 0; i < times; ++i) {
      EXPECT_FALSE(book.end_login(book.begin_login(user, address, now), false, "", now));
    }
  }
};

TEST_F(Login, TheFirstWrongOnesAreFreeThenTheWaitDoubles) {
  guess(3, "anna", "10.0.0.9");
  EXPECT_EQ(book.login_wait("anna", "10.0.0.9", now), 0s);
  for (const base::Duration wait : {1s, 2s, 4s, 8s}) {
    guess(1, "anna", "10.0.0.9");
    EXPECT_EQ(book.login_wait("anna", "10.0.0.9", now), wait);
    pass(wait);
    EXPECT_EQ(book.login_wait("anna", "10.0.0.9", now), 0s);
  }
  guess(40, "anna", "10.0.0.9");
  EXPECT_EQ(book.login_wait("anna", "10.0.0.9", now), 5min);
}

TEST_F(Login, ARightOneClears) {
  guess(5, "anna", "10.0.0.9");
  pass(1min);
  log_in("anna", "10.0.0.9");
  EXPECT_EQ(book.login_wait("anna", "10.0.0.9", now), 0s);
  guess(1, "anna", "10.0.0.9");
  EXPECT_EQ(book.login_wait("anna", "10.0.0.9", now), 0s);
}

TEST_F(Login, ManyAddressesTogetherWaitForTheUser) {
  for (int i = 0; i < 50; ++i) guess(1, "anna", "10.0.1." + std::to_string(i));
  EXPECT_EQ(book.login_wait("anna", "10.0.2.1", now), 30s);
}

/// One computer has 2^64 of them.
TEST_F(Login, AddressesOfOneNetworkOfIpv6WaitTogetherButForThoseWhoWereHere) {
  log_in("anna", "2001:db8::2");
  for (int i = 0; i < 40; ++i) guess(1, "nobody", "2001:db8::9:" + std::to_string(i));
  // Others of that network wait, not for longer than half a minute, as do those with a code;
  EXPECT_EQ(book.login_wait("anna", "2001:db8::3", now), 30s);
  EXPECT_EQ(book.login_wait("", "2001:db8::4", now), 30s);
  // whoever was here does not, nor do other networks, nor do IPv4's neighbours for each other.
  EXPECT_EQ(book.login_wait("anna", "2001:db8::2", now), 0s);
  EXPECT_EQ(book.login_wait("anna", "2001:db8:0:1::3", now), 0s);
  for (int i = 0; i < 40; ++i) guess(1, "x", "10.0.1." + std::to_string(i));
  EXPECT_EQ(book.login_wait("", "10.0.1.99", now), 0s);
  // A few slips of a house full of people cost nothing.
  guess(15, "carl", "2001:db8:0:2::1");
  EXPECT_EQ(book.login_wait("anna", "2001:db8:0:2::2", now), 0s);
}

TEST_F(Login, WhoeverIsKnownFromThereIsNotLockedOutByOthers) {
  log_in("anna", "10.0.0.2");
  for (int i = 0; i < 50; ++i) guess(1, "anna", "10.0.1." + std::to_string(i));
  EXPECT_EQ(book.login_wait("anna", "10.0.0.2", now), 0s);
}

TEST_F(Login, NamesThatDoNotExistWaitAlike) {
  for (int i = 0; i < 50; ++i) guess(1, "nobody", "10.0.1." + std::to_string(i));
  EXPECT_EQ(book.login_wait("nobody", "10.0.2.1", now), 30s);
  EXPECT_EQ(book.begin_login("nobody", "10.0.2.1", now).hash, nobodys_hash());
}

TEST_F(Login, TheTablesAreBounded) {
  Backoff backoff(5min, 100);
  for (int i = 0; i < 100'000; ++i) backoff.tried(std::to_string(i), now.mono);
  EXPECT_EQ(backoff.size(), 100u);
  // who waits longest stays
  for (int i = 0; i < 10; ++i) backoff.tried("bad", now.mono);
  for (int i = 0; i < 1000; ++i) backoff.tried("x" + std::to_string(i), now.mono);
  EXPECT_GT(backoff.wait("bad", now.mono), 30s);
  // what is old is forgotten
  EXPECT_EQ(backoff.wait("bad", now.mono + 2h), 0s);
  backoff.tried("bad", now.mono + 2h);
  EXPECT_EQ(backoff.wait("bad", now.mono + 2h), 0s);
}

TEST_F(Login, APasswordThatWasChangedMeanwhileIsNoLogIn) {
  const Attempt attempt = book.begin_login("anna", "10.0.0.2", now);
  ASSERT_TRUE(book.change_user("anna", std::nullopt, "another hash"));
  EXPECT_FALSE(book.end_login(attempt, true, "", now));
}

TEST_F(Login, ARightAnswerForNobodyIsNoLogIn) {
  EXPECT_FALSE(book.end_login(book.begin_login("nobody", "x", now), true, "", now));
}

TEST_F(Login, TheFirstCodeOpensOnceAndOnlyAnEmptyHouse) {
  Book empty;
  EXPECT_FALSE(empty.needs_setup());  // not read yet
  empty.load({}, now);
  EXPECT_TRUE(empty.needs_setup());
  EXPECT_FALSE(empty.is_code("", "a", now));  // none was made
  const std::string code = empty.make_code();
  EXPECT_FALSE(empty.is_code("AAAA-AAAA", "a", now));
  EXPECT_TRUE(empty.is_code(code, "a", now));
  const std::string next = empty.make_code();
  EXPECT_FALSE(empty.is_code(code, "a", now));
  ASSERT_TRUE(empty.add_user("anna", Role::Admin, "hash", now));
  EXPECT_FALSE(empty.needs_setup());
  EXPECT_FALSE(empty.is_code(next, "a", now));
  EXPECT_FALSE(empty.is_code("", "a", now));
  // and guessing it is slow from where it is done, and keeps nobody else waiting
  Book other;
  other.load({}, now);
  (void)other.make_code();
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(other.is_code("AAAA-AAAA", "guesser", now));
  EXPECT_EQ(other.login_wait("", "guesser", now), 5min);
  EXPECT_EQ(other.login_wait("", "new", now), 0s);
}

}  // namespace
}  // namespace roverd::people
