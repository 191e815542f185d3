#include "trust/identity.hpp"

#include <algorithm>
#include <utility>

#include "trust/private_files.hpp"

namespace roverd::trust {

namespace {

using base::Code;
using base::Result;
namespace fs = std::filesystem;

/// One file: the key first, then the certificate and its chain. Empty: it cannot be used.
std::optional<Credential> parse_kept(const std::string& text) {
  constexpr std::string_view kBegin = "-----BEGIN CERTIFICATE-----";
  const auto at = text.find(kBegin);
  if (at == std::string::npos) return std::nullopt;
  Credential read{text.substr(at), text.substr(0, at)};
  if (!check_pair(read)) return std::nullopt;
  return read;
}

struct Kept {
  std::optional<Credential> credential{};
  std::string damaged{};  ///< where the damaged file lies now; empty: there was none
};

Result<Kept> read_kept(const fs::path& file) {
  auto text = read_private(file);
  if (!text) return tl::unexpected(text.error());
  if (!*text) return Kept{};
  if (auto read = parse_kept(**text)) return Kept{std::move(read)};
  auto moved = set_aside(file);
  if (!moved) return tl::unexpected(moved.error());
  return Kept{std::nullopt, moved->string()};
}

Result<void> keep(const fs::path& file, const Credential& credential) {
  return write_private(file, credential.key + credential.certificate);
}

/// @param told what was done is added
Result<Credential> authority_in(const fs::path& file, const Names& names, std::vector<Told>& told) {
  auto kept = read_kept(file);
  if (!kept) return tl::unexpected(kept.error());
  if (kept->credential && !read_certificate(kept->credential->certificate)->authority) {
    auto moved = set_aside(file);
    if (!moved) return tl::unexpected(moved.error());
    *kept = {std::nullopt, moved->string()};
  }
  if (kept->credential) return std::move(*kept->credential);
  auto made = make_authority(names.hosts.empty() ? "robot" : names.hosts.front());
  if (!made) return made;
  if (auto done = keep(file, *made); !done) return tl::unexpected(done.error());
  const bool damaged = !kept->damaged.empty();
  told.push_back({damaged ? "the certificate authority was damaged (it lies in " + kept->damaged +
                                " now) and a new one was made: every device must be paired again"
                          : "a certificate authority was made: " + file.string(),
                  damaged});
  return made;
}

}  // namespace

std::optional<base::WallTime> believed(base::WallTime clock, base::WallTime youngest) {
  return clock < youngest ? std::nullopt : std::optional(clock);
}

Result<Identity> own_identity(const fs::path& folder, const Names& names,
                              std::optional<base::WallTime> now, base::WallTime youngest) {
  if (auto good = private_folder(folder); !good) return tl::unexpected(good.error());
  Identity identity;
  const auto authority = authority_in(folder / "authority.pem", names, identity.told);
  if (!authority) return tl::unexpected(authority.error());
  identity.authority = authority->certificate;
  const fs::path file = folder / "server.pem";
  auto kept = read_kept(file);
  if (!kept) return tl::unexpected(kept.error());

  std::optional<std::string> why;
  base::WallTime made_at = now.value_or(youngest);
  if (!kept->credential) {
    why = kept->damaged.empty() ? "there was none" : "it was damaged, see " + kept->damaged;
  } else {
    const auto facts = read_certificate(kept->credential->certificate);
    why = signed_by(kept->credential->certificate, authority->certificate)
              ? reason_to_renew(*facts, names, now)
              : "another authority had signed it";
    // Without a clock the time of the one before is the best guess.
    if (!now) made_at = std::max(made_at, facts->not_before + kBackdated);
  }
  if (!why) {
    identity.server = std::move(*kept->credential);
    return identity;
  }
  auto made = make_server(*authority, names, made_at);
  if (!made) return tl::unexpected(made.error());
  if (auto done = keep(file, *made); !done) return tl::unexpected(done.error());
  identity.server = std::move(*made);
  identity.told.push_back({"a server certificate was made: " + *why});
  return identity;
}

Result<Identity> given_identity(const fs::path& certificate, const fs::path& key,
                                const Names& names, std::optional<base::WallTime> now) {
  auto chain = read_public(certificate);
  if (!chain) return tl::unexpected(chain.error());
  auto secret = read_private(key);
  if (!secret) return tl::unexpected(secret.error());
  if (!*secret) return base::fail(Code::NotFound, "there is no file " + key.string());
  Identity identity{
      .server = {std::move(*chain), std::move(**secret)}, .authority = {}, .told = {}};
  const auto facts = read_certificate(identity.server.certificate);
  if (!facts)
    return base::fail(Code::Malformed, certificate.string() + ": " + facts.error().detail);
  if (auto good = check_pair(identity.server); !good) {
    return base::fail(good.error().code, key.string() + ": " + good.error().detail);
  }
  if (now && *now > facts->not_after) {
    return base::fail(Code::Invalid, certificate.string() + " is over since " +
                                         base::to_rfc3339(facts->not_after));
  }
  if (now && *now < facts->not_before) {
    identity.told.push_back(
        {certificate.string() + " is not valid before " + base::to_rfc3339(facts->not_before),
         true});
  }
  if (facts->names.hosts.empty() && facts->names.addresses.empty()) {
    return base::fail(Code::Invalid, certificate.string() +
                                         " names nothing (no subjectAltName): no browser takes it");
  }
  for (const auto& missing : names_missing(*facts, names)) {
    identity.told.push_back({certificate.string() + " does not name " + missing});
  }
  identity.authority = *last_certificate(identity.server.certificate);
  return identity;
}

}  // namespace roverd::trust
