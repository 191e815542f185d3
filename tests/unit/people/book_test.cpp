// Users, sessions, tokens: what they open, and when no more.

#include "house.hpp"

namespace roverd::people {
namespace {

class PeopleBook : public BookTest {
 protected:
  Opened<Token> token(Role role, std::optional<base::WallTime> expires = std::nullopt,
                      std::vector<std::string> methods = {}) {
    Token wanted;
    wanted.name = "script";
    wanted.user = "anna";
    wanted.role = role;
    wanted.methods = std::move(methods);
    wanted.expires = expires;
    return book.add_token(wanted, now).value_or(Opened<Token>{});
  }
};

TEST_F(PeopleBook, ACookieTellsWhoItIs) {
  const auto opened = log_in();
  const auto who = book.by_session(opened.secret, now);
  ASSERT_TRUE(who);
  EXPECT_EQ(who->user, "anna");
  EXPECT_EQ(who->role, Role::Admin);
  EXPECT_TRUE(who->may("DELETE"));
  // What is kept does not open.
  EXPECT_FALSE(book.by_session(opened.row.hash, now));
  EXPECT_FALSE(book.by_session(opened.row.id, now));
  EXPECT_FALSE(book.by_session("", now));
  EXPECT_FALSE(book.by_token(opened.secret, now));
  EXPECT_FALSE(book.by_session(std::string(100'000, 'x'), now));
}

TEST_F(PeopleBook, ASessionThatIsNotUsedEnds) {
  const auto opened = log_in();
  for (int i = 0; i < 10; ++i) {
    pass(11h);
    EXPECT_TRUE(book.by_session(opened.secret, now));
  }
  pass(12h + 1s);
  EXPECT_FALSE(book.by_session(opened.secret, now));
  book.sweep(now);
  EXPECT_TRUE(book.sessions_of("anna").empty());
}

TEST_F(PeopleBook, ASessionEndsAfterAWeekHoweverMuchItIsUsed) {
  const auto opened = log_in();
  for (int i = 0; i < 24 * 7; ++i) {
    EXPECT_TRUE(book.by_session(opened.secret, now));
    pass(1h);
  }
  pass(1s);
  EXPECT_FALSE(book.by_session(opened.secret, now));
}

TEST_F(PeopleBook, AWallClockThatJumpsNeitherEndsNorLengthensASession) {
  const auto opened = log_in();
  for (const base::WallTime jumped : {base::WallTime{}, kNoon + 24h * 3650, kNoon - 24h * 3650}) {
    now.wall = jumped;
    EXPECT_TRUE(book.by_session(opened.secret, now));
  }
  now.wall = base::WallTime{};
  now.mono += 12h + 1s;
  EXPECT_FALSE(book.by_session(opened.secret, now));
}

TEST_F(PeopleBook, ASessionOutlivesARestartByTheWallClock) {
  const auto opened = log_in();
  start_again(kNoon + 1h);
  EXPECT_TRUE(book.by_session(opened.secret, now));
  // and what it lived before counts
  for (int i = 0; i < 24 * 7 - 1; ++i) {
    (void)book.by_session(opened.secret, now);
    pass(1h);
  }
  pass(1s);
  EXPECT_FALSE(book.by_session(opened.secret, now));
}

TEST_F(PeopleBook, AfterARestartWithoutATimeASessionWaitsForIt) {
  const auto opened = log_in();
  start_again(base::WallTime{});
  EXPECT_FALSE(book.by_session(opened.secret, now));
  book.sweep(now);
  EXPECT_EQ(book.sessions_of("anna").size(), 1u);
  now.wall = kNoon + 2h;  // the clock is set
  EXPECT_TRUE(book.by_session(opened.secret, now));
}

TEST_F(PeopleBook, AfterARestartALongPauseOrAClockGoneBackEndsASession) {
  for (const base::WallTime then : {kNoon + 13h, kNoon - 1h, kNoon + 24h * 400}) {
    now = {base::Time(1000s), kNoon};
    const auto opened = log_in();
    start_again(then);
    EXPECT_FALSE(book.by_session(opened.secret, now));
  }
}

TEST_F(PeopleBook, ASessionOfAnUnknownTimeDoesNotOutliveARestart) {
  now.wall = base::WallTime{};
  const auto opened = log_in();
  EXPECT_TRUE(book.by_session(opened.secret, now));
  start_again(kNoon);
  EXPECT_FALSE(book.by_session(opened.secret, now));
}

TEST_F(PeopleBook, AClockThatIsSetLaterDatesTheLogIn) {
  now.wall = base::WallTime{};
  const auto opened = log_in();
  now.mono += 1h;
  now.wall = kNoon;
  EXPECT_TRUE(book.by_session(opened.secret, now));
  EXPECT_EQ(book.sessions_of("anna").front().created, kNoon - 1h);
}

TEST_F(PeopleBook, LoggingOutAndRevokingEnd) {
  const auto one = log_in();
  const auto two = log_in();
  ASSERT_TRUE(book.end_session("anna", one.row.id));
  EXPECT_FALSE(book.by_session(one.secret, now));
  EXPECT_FALSE(book.still({"anna", Role::Admin, Who::By::Session, one.row.id}, now));
  EXPECT_TRUE(book.by_session(two.secret, now));
  EXPECT_EQ(book.end_session("anna", one.row.id).error().code, base::Code::NotFound);
  ASSERT_TRUE(book.add_user("bert", Role::Viewer, "h", now));
  EXPECT_EQ(book.end_session("bert", two.row.id).error().code, base::Code::NotFound);
}

TEST_F(PeopleBook, SessionsOfAUserAreBounded) {
  const auto first = log_in();
  for (std::size_t i = 0; i < Book::kSessionsEach; ++i) {
    pass(1s);
    log_in();
  }
  EXPECT_EQ(book.sessions_of("anna").size(), Book::kSessionsEach);
  EXPECT_FALSE(book.by_session(first.secret, now));
}

TEST_F(PeopleBook, ANewPasswordEndsTheOtherSessions) {
  const auto mine = log_in();
  const auto stolen = log_in();
  ASSERT_TRUE(book.change_user("anna", std::nullopt, "new hash", mine.row.id));
  EXPECT_TRUE(book.by_session(mine.secret, now));
  EXPECT_FALSE(book.by_session(stolen.secret, now));
}

TEST_F(PeopleBook, ARoleCountsFromNowOn) {
  ASSERT_TRUE(book.add_user("bert", Role::Operator, "h", now));
  const auto opened = log_in("bert");
  const auto before = book.by_session(opened.secret, now);
  ASSERT_TRUE(book.change_user("bert", Role::Viewer, std::nullopt));
  EXPECT_EQ(book.still(*before, now)->role, Role::Viewer);
  EXPECT_EQ(book.by_session(opened.secret, now)->role, Role::Viewer);
}

TEST_F(PeopleBook, TheLastAdminStays) {
  ASSERT_TRUE(book.add_user("bert", Role::Viewer, "h", now));
  EXPECT_EQ(book.remove_user("anna").error().code, base::Code::Conflict);
  EXPECT_EQ(book.change_user("anna", Role::Viewer, std::nullopt).error().code,
            base::Code::Conflict);
  ASSERT_TRUE(book.change_user("bert", Role::Admin, std::nullopt));
  EXPECT_TRUE(book.remove_user("anna"));
  EXPECT_EQ(book.remove_user("anna").error().code, base::Code::NotFound);
}

TEST_F(PeopleBook, WithAUserGoesWhatTheUserHad) {
  ASSERT_TRUE(book.add_user("bert", Role::Admin, "h", now));
  const auto cookie = log_in();
  const auto script = token(Role::Viewer);
  ASSERT_TRUE(book.remove_user("anna"));
  EXPECT_FALSE(book.by_session(cookie.secret, now));
  EXPECT_FALSE(book.by_token(script.secret, now));
  const Change change = book.take_change();
  EXPECT_EQ(change.gone_users, std::vector<std::string>{"anna"});
  EXPECT_TRUE(change.now.sessions.empty());
  EXPECT_TRUE(change.now.tokens.empty());
  // A user of the same name gets nothing of it.
  ASSERT_TRUE(book.add_user("anna", Role::Viewer, "h", now));
  EXPECT_FALSE(book.by_session(cookie.secret, now));
}

TEST_F(PeopleBook, UsersAndTokensAreBounded) {
  for (std::size_t i = 1; i < Book::kUsers; ++i) {
    ASSERT_TRUE(book.add_user("u" + std::to_string(i), Role::Viewer, "h", now));
  }
  EXPECT_EQ(book.add_user("more", Role::Viewer, "h", now).error().code, base::Code::Conflict);
  EXPECT_EQ(book.add_user("anna", Role::Viewer, "h", now).error().code, base::Code::Conflict);
  for (std::size_t i = 0; i < Book::kTokens; ++i) token(Role::Viewer);
  Token wanted;
  wanted.user = "anna";
  EXPECT_EQ(book.add_token(wanted, now).error().code, base::Code::Conflict);
}

TEST_F(PeopleBook, ATokenHasTheLesserOfTwoRoles) {
  const auto script = token(Role::Operator, std::nullopt, {"GET", "POST"});
  const auto who = book.by_token(script.secret, now);
  ASSERT_TRUE(who);
  EXPECT_EQ(who->role, Role::Operator);
  EXPECT_TRUE(who->may("GET"));
  EXPECT_TRUE(who->may("HEAD"));
  EXPECT_TRUE(who->may("POST"));
  EXPECT_FALSE(who->may("DELETE"));
  EXPECT_FALSE(who->may("BREW"));
  ASSERT_TRUE(book.add_user("bert", Role::Admin, "h", now));
  ASSERT_TRUE(book.change_user("anna", Role::Viewer, std::nullopt));
  EXPECT_EQ(book.by_token(script.secret, now)->role, Role::Viewer);
  EXPECT_FALSE(book.by_session(script.secret, now));
}

TEST_F(PeopleBook, ATokenExpiresAndNeedsATimeForIt) {
  const auto script = token(Role::Viewer, kNoon + 1h);
  EXPECT_TRUE(book.by_token(script.secret, now));
  now.wall = base::WallTime{};  // not set
  EXPECT_FALSE(book.by_token(script.secret, now));
  now.wall = kNoon - 24h;  // before it was made: wrong
  EXPECT_FALSE(book.by_token(script.secret, now));
  now.wall = kNoon + 1h;
  EXPECT_FALSE(book.by_token(script.secret, now));
  EXPECT_EQ(book.tokens_of("").size(), 1u);  // shown as expired until somebody ends it
  const auto lasting = token(Role::Viewer);
  now.wall = base::WallTime{};
  EXPECT_TRUE(book.by_token(lasting.secret, now));
  ASSERT_TRUE(book.end_token("anna", lasting.row.id));
  EXPECT_FALSE(book.by_token(lasting.secret, now));
  EXPECT_FALSE(book.end_token("bert", script.row.id));
}

TEST_F(PeopleBook, NothingThatIsKeptOpensADoor) {
  const auto cookie = log_in();
  const auto script = token(Role::Admin);
  const Change change = book.take_change();
  for (const Session& s : change.now.sessions) {
    EXPECT_EQ((s.id + s.hash + s.device + s.address).find(cookie.secret), std::string::npos);
  }
  for (const Token& t : change.now.tokens) {
    EXPECT_EQ((t.id + t.hash + t.name).find(script.secret), std::string::npos);
  }
  EXPECT_TRUE(book.take_change().empty());
}

TEST_F(PeopleBook, BeingSeenIsKeptNowAndThen) {
  const auto cookie = log_in();
  (void)book.take_change();
  int kept_times = 0;
  for (int i = 0; i < 600; ++i) {
    (void)book.by_session(cookie.secret, now);
    pass(1s);
    book.sweep(now);
    kept_times += book.take_change().now.sessions.empty() ? 0 : 1;
  }
  EXPECT_GE(kept_times, 9);
  EXPECT_LE(kept_times, 10);
}

TEST_F(PeopleBook, WhatADeviceCallsItselfIsShortAndPlain) {
  const auto opened = book.end_login(book.begin_login("anna", "a", now), true,
                                     "evil\x1b[2J\n<script>" + std::string(10'000, 'x'), now);
  ASSERT_TRUE(opened);
  EXPECT_TRUE(opened->row.device.starts_with("evil?[2J?<script>xxx"));
  EXPECT_EQ(opened->row.device.size(), 80u);
}

TEST_F(PeopleBook, NobodyComesInBeforeItIsRead) {
  Book closed;
  EXPECT_FALSE(closed.loaded());
  EXPECT_FALSE(closed.by_session("x", now));
  EXPECT_EQ(closed.add_user("anna", Role::Admin, "h", now).error().code, base::Code::Unavailable);
}

}  // namespace
}  // namespace roverd::people
