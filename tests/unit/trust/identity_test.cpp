#include "trust/identity.hpp"

#include <gtest/gtest.h>

#include "folder.hpp"

namespace roverd::trust {
namespace {

using namespace std::chrono_literals;
using base::Code;
using base::WallTime;
using test::content;
using test::Folder;
using test::mode_of;
using test::put;

constexpr WallTime kYoung{std::chrono::seconds(1'735'689'600)};   // 2025-01-01
constexpr WallTime kAutumn{std::chrono::seconds(1'790'812'800)};  // 2026-10-01
constexpr auto kYear = 365 * 24h;
const Names kRover{.hosts = {"rover", "localhost"}, .addresses = {"127.0.0.1"}};

/// A start, or a look later on.
class OwnIdentity : public ::testing::Test {
 protected:
  base::Result<Identity> look(std::optional<WallTime> now = kAutumn, const Names& names = kRover) {
    return own_identity(tls, names, now, kYoung);
  }
  const Folder folder;
  const std::filesystem::path tls = folder.path / "tls";
};

TEST_F(OwnIdentity, IsMadeAtTheFirstStartAndStays) {
  const auto first = look();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->told.size(), 2U);
  EXPECT_TRUE(check_pair(first->server));
  EXPECT_TRUE(signed_by(first->server.certificate, first->authority));
  EXPECT_EQ(mode_of(tls), 0700U);
  EXPECT_EQ(mode_of(tls / "authority.pem"), 0600U);
  EXPECT_EQ(mode_of(tls / "server.pem"), 0600U);

  const auto second = look();
  ASSERT_TRUE(second);
  EXPECT_EQ(*second, *first);
  EXPECT_TRUE(second->told.empty());
}

TEST_F(OwnIdentity, IsRenewedUnderTheSameAuthority) {
  const auto first = look();
  Names moved = kRover;
  moved.addresses.emplace_back("10.0.0.3");

  const auto second = look(kAutumn, moved);

  ASSERT_TRUE(second);
  EXPECT_EQ(second->authority, first->authority);
  EXPECT_NE(second->server.certificate, first->server.certificate);
  ASSERT_EQ(second->told.size(), 1U);
  EXPECT_EQ(second->told[0].text, "a server certificate was made: it does not name 10.0.0.3");
  EXPECT_EQ(read_certificate(look(kAutumn + kYear, moved)->server.certificate)->not_before,
            kAutumn + kYear - kBackdated);
}

TEST_F(OwnIdentity, AClockThatWasNeverSetMakesOneFromTheProgramsYouthAndThenTrustsIt) {
  const auto unset = look(std::nullopt);
  ASSERT_TRUE(unset);
  EXPECT_EQ(read_certificate(unset->server.certificate)->not_before, kYoung - kBackdated);
  EXPECT_EQ(*look(std::nullopt), *unset);

  // GNSS or a time server set it: that certificate is over, and the next one made.
  const auto set = look(kAutumn);
  EXPECT_NE(*set, *unset);
  EXPECT_EQ(set->authority, unset->authority);

  // The next start is without a clock again, and leaves it as it is.
  EXPECT_EQ(*look(std::nullopt), *set);
  // A new name then: the time of the one before is the best guess.
  const auto named = look(std::nullopt, {{"rover", "other"}, {}});
  EXPECT_EQ(read_certificate(named->server.certificate)->not_before, kAutumn - kBackdated);
}

TEST_F(OwnIdentity, AClockThatJumpsForwardAndBackLeavesAValidOne) {
  for (const WallTime now : {kAutumn, kAutumn + 40 * kYear, kAutumn, kAutumn - kYear}) {
    const auto facts = read_certificate(look(now)->server.certificate);
    EXPECT_LE(facts->not_before, now);
    EXPECT_GE(facts->not_after, now);
  }
}

TEST_F(OwnIdentity, ADamagedServerFileIsSetAsideAndMadeAnew) {
  const auto first = look();
  const std::string whole = content(tls / "server.pem");
  for (const std::string& damaged :
       {std::string(), whole.substr(0, 300), std::string("\0\xff", 2)}) {
    put(tls / "server.pem", damaged);
    const auto next = look();
    ASSERT_TRUE(next);
    EXPECT_EQ(next->authority, first->authority);
    ASSERT_EQ(next->told.size(), 1U);
    EXPECT_NE(next->told[0].text.find("it was damaged, see "), std::string::npos)
        << next->told[0].text;
  }
  EXPECT_EQ(content(tls / "server.pem.damaged-2"), whole.substr(0, 300));
}

TEST_F(OwnIdentity, ADamagedAuthorityIsToldLoudlyAndTheServersCertificateFollows) {
  const auto first = look();
  put(tls / "authority.pem", content(tls / "authority.pem").substr(0, 200));

  const auto next = look();

  ASSERT_TRUE(next);
  EXPECT_NE(next->authority, first->authority);
  EXPECT_TRUE(signed_by(next->server.certificate, next->authority));
  ASSERT_EQ(next->told.size(), 2U);
  EXPECT_NE(next->told[0].text.find("every device must be paired again"), std::string::npos);
  EXPECT_TRUE(next->told[0].alarming);
  EXPECT_EQ(next->told[1].text, "a server certificate was made: another authority had signed it");
}

TEST_F(OwnIdentity, AServersCertificateIsNoAuthority) {
  ASSERT_TRUE(look());
  put(tls / "authority.pem", content(tls / "server.pem"));
  const auto next = look();
  ASSERT_TRUE(next);
  EXPECT_TRUE(read_certificate(next->authority)->authority);
}

TEST_F(OwnIdentity, KeysThatOthersCanReadAreRefusedNotReplaced) {
  ASSERT_TRUE(look());
  const std::string before = content(tls / "authority.pem");
  put(tls / "authority.pem", before, 0644);

  const auto refused = look();

  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::Invalid);
  EXPECT_EQ(content(tls / "authority.pem"), before);
}

TEST_F(OwnIdentity, WithoutAPlaceForItThereIsNone) {
  EXPECT_EQ(own_identity(folder.path / "no" / "tls", kRover, kAutumn, kYoung).error().code,
            Code::Unavailable);
}

class GivenIdentity : public OwnIdentity {
 protected:
  GivenIdentity() {
    const auto made = look();
    put(certificate, made->server.certificate, 0644);
    put(key, made->server.key);
    top = made->authority;
  }
  base::Result<Identity> given(std::optional<WallTime> now = kAutumn, const Names& names = kRover) {
    return given_identity(certificate, key, names, now);
  }
  const std::filesystem::path certificate = folder.path / "chain.pem";
  const std::filesystem::path key = folder.path / "key.pem";
  std::string top;
};

TEST_F(GivenIdentity, IsTakenAsItIs) {
  const auto taken = given();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->server.certificate, content(certificate));
  EXPECT_EQ(taken->authority, top);
  EXPECT_TRUE(taken->told.empty());
}

TEST_F(GivenIdentity, WhatItDoesNotNameIsTold) {
  const auto taken = given(kAutumn, {{"rover", "farm.example"}, {"10.0.0.1"}});
  ASSERT_EQ(taken->told.size(), 2U);
  EXPECT_EQ(taken->told[0].text, certificate.string() + " does not name farm.example");
}

TEST_F(GivenIdentity, IsRefusedWhenOverAndToldWhenNotYetValid) {
  const auto over = given(kAutumn + 2 * kYear);
  ASSERT_FALSE(over);
  EXPECT_NE(over.error().detail.find("is over since 2027-10"), std::string::npos)
      << over.error().detail;
  EXPECT_EQ(given(kAutumn - kYear)->told.size(), 1U);
  EXPECT_TRUE(given(std::nullopt)) << "a clock that was never set judges nothing";
}

TEST_F(GivenIdentity, UglyFilesAreRefusedByName) {
  const std::string good_key = content(key);
  put(key, good_key, 0644);
  EXPECT_EQ(given().error().code, Code::Invalid) << "others can read it";
  put(key, good_key.substr(0, 80));
  EXPECT_TRUE(given().error().detail.starts_with(key.string()));
  put(key, make_server(*make_authority("x"), kRover, kAutumn)->key);
  EXPECT_EQ(given().error().detail, key.string() + ": key and certificate do not belong together");
  put(key, good_key);
  put(certificate, content(certificate).substr(0, 90));
  EXPECT_TRUE(given().error().detail.starts_with(certificate.string()));
  std::filesystem::remove(certificate);
  EXPECT_EQ(given().error().code, Code::NotFound);
  put(certificate, make_authority("x")->certificate);
  EXPECT_FALSE(given());
  std::filesystem::remove(key);
  EXPECT_EQ(given().error().code, Code::NotFound);
}

}  // namespace
}  // namespace roverd::trust
