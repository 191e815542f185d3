#include "trust/certificate.hpp"

#include <set>

#include <gtest/gtest.h>

namespace roverd::trust {
namespace {

using namespace std::chrono_literals;
using base::WallTime;

/// 2026-06-01T00:00:00Z.
constexpr WallTime kSummer{std::chrono::seconds(1'780'272'000)};
constexpr auto kDay = 24h;

const Names kNames{.hosts = {"rover", "rover.local", "localhost"},
                   .addresses = {"127.0.0.1", "::1", "192.168.4.1", "fd00::7"}};

Credential authority() {
  auto made = make_authority("rover");
  EXPECT_TRUE(made);
  return made.value_or(Credential{});
}

TEST(Certificate, AnAuthorityIsOneAndLivesWhateverTheClockSays) {
  const auto facts = read_certificate(authority().certificate);

  ASSERT_TRUE(facts);
  EXPECT_TRUE(facts->authority);
  EXPECT_TRUE(facts->subject.starts_with("roverd rover CA ")) << facts->subject;
  EXPECT_EQ(base::to_rfc3339(facts->not_before), "2020-01-01T00:00:00.000Z");
  EXPECT_EQ(base::to_rfc3339(facts->not_after), "2049-12-31T00:00:00.000Z");
  EXPECT_EQ(facts->fingerprint.size(), 32U * 3 - 1);
}

TEST(Certificate, TwoAuthoritiesOfOneHostAreToldApart) {
  std::set<std::string> subjects;
  std::set<std::string> fingerprints;
  for (int i = 0; i < 3; ++i) {
    const auto facts = read_certificate(authority().certificate);
    subjects.insert(facts->subject);
    fingerprints.insert(facts->fingerprint);
  }
  EXPECT_EQ(subjects.size(), 3U);
  EXPECT_EQ(fingerprints.size(), 3U);
}

TEST(Certificate, AHostWithALongNameGetsAnAuthority) {
  EXPECT_TRUE(make_authority(std::string(253, 'a')));
}

TEST(Certificate, AServersNamesWhoItIsAndLives397Days) {
  const Credential ca = authority();
  const auto made = make_server(ca, kNames, kSummer);

  ASSERT_TRUE(made);
  const auto facts = read_certificate(made->certificate);
  ASSERT_TRUE(facts);
  EXPECT_FALSE(facts->authority);
  EXPECT_EQ(facts->names, kNames);
  EXPECT_EQ(facts->not_after - facts->not_before, 397 * kDay);
  EXPECT_EQ(facts->not_before, kSummer - kBackdated);
  EXPECT_TRUE(check_pair(*made));
  EXPECT_TRUE(signed_by(made->certificate, ca.certificate));
  // The chain's top is the authority.
  EXPECT_EQ(*last_certificate(made->certificate), ca.certificate);
}

TEST(Certificate, AnotherAuthoritysSignatureIsNone) {
  const auto made = make_server(authority(), kNames, kSummer);
  EXPECT_FALSE(signed_by(made->certificate, authority().certificate));
  EXPECT_FALSE(signed_by("", authority().certificate));
}

TEST(Certificate, AKeyOfAnotherCertificateIsFound) {
  const Credential ca = authority();
  const auto one = make_server(ca, kNames, kSummer);
  const auto other = make_server(ca, kNames, kSummer);

  const auto checked = check_pair({one->certificate, other->key});

  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, base::Code::Invalid);
  EXPECT_EQ(checked.error().detail, "key and certificate do not belong together");
}

TEST(Certificate, EveryTruncatedTextIsRefused) {
  const Credential ca = authority();
  const std::string end = "-----END CERTIFICATE-----";
  const auto whole = ca.certificate.find(end) + end.size();
  for (std::size_t n = 0; n < whole; n += 7) {
    EXPECT_FALSE(read_certificate(ca.certificate.substr(0, n))) << n;
    EXPECT_FALSE(der_of(ca.certificate.substr(0, n))) << n;
    EXPECT_FALSE(last_certificate(ca.certificate.substr(0, n))) << n;
  }
  const std::string key_end = "-----END PRIVATE KEY-----";
  for (std::size_t n = 0; n < ca.key.find(key_end) + key_end.size(); n += 7) {
    EXPECT_FALSE(check_pair({ca.certificate, ca.key.substr(0, n)})) << n;
  }
}

TEST(Certificate, AKeyWithAPassPhraseIsRefusedAndNobodyIsAsked) {
  constexpr auto kEncrypted =
      "-----BEGIN ENCRYPTED PRIVATE KEY-----\n"
      "MIGjMF8GCSqGSIb3DQEFDTBSMDEGCSqGSIb3DQEFDDAkBBBSbmmTnjfmPNYdIcLP\n"
      "-----END ENCRYPTED PRIVATE KEY-----\n";
  const auto checked = check_pair({authority().certificate, kEncrypted});
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, base::Code::Malformed);
}

TEST(Certificate, AnUnreadableAuthoritySignsNothing) {
  EXPECT_FALSE(make_server({"", ""}, kNames, kSummer));
}

//      not_before                                                not_after
//          |-- 7 d --|------------------- it will do -----------|-- 60 d --|
TEST(Certificate, IsMadeAgainNearItsEndsAndWhenTheClockStandsBeforeIt) {
  const auto made = make_server(authority(), kNames, kSummer);
  const Facts facts = *read_certificate(made->certificate);
  struct Case {
    WallTime now;
    bool renew;
  };
  for (const Case& c : {Case{kSummer, false}, Case{facts.not_before + kRenewAfterBegin, false},
                        Case{facts.not_before + kRenewAfterBegin - 1s, true},
                        Case{facts.not_after - kRenewBeforeEnd, false},
                        Case{facts.not_after - kRenewBeforeEnd + 1s, true},
                        Case{facts.not_after + 1000 * kDay, true}, Case{WallTime{}, true}}) {
    EXPECT_EQ(reason_to_renew(facts, kNames, c.now).has_value(), c.renew)
        << base::to_rfc3339(c.now);
  }
  // A clock that was never set judges nothing.
  EXPECT_EQ(reason_to_renew(facts, kNames, std::nullopt), std::nullopt);
}

TEST(Certificate, IsMadeAgainForANewNameOrAddressNotForOneThatIsGone) {
  const auto made = make_server(authority(), kNames, kSummer);
  const Facts facts = *read_certificate(made->certificate);

  Names more = kNames;
  more.addresses.emplace_back("10.0.0.9");
  EXPECT_EQ(reason_to_renew(facts, more, kSummer), "it does not name 10.0.0.9");
  more = kNames;
  more.hosts.emplace_back("other");
  EXPECT_EQ(reason_to_renew(facts, more, kSummer), "it does not name other");
  EXPECT_EQ(reason_to_renew(facts, {{"ROVER"}, {"::1"}}, kSummer), std::nullopt);
}

TEST(Certificate, AStarStandsForOneLabel) {
  Facts facts;
  facts.names.hosts = {"*.example.org"};
  EXPECT_TRUE(names_missing(facts, {{"a.example.org"}, {}}).empty());
  EXPECT_FALSE(names_missing(facts, {{"example.org"}, {}}).empty());
  EXPECT_FALSE(names_missing(facts, {{"a.b.example.org"}, {}}).empty());
}

}  // namespace
}  // namespace roverd::trust
