#pragma once
// Who this server is for its clients: the credential that it shows, and the authority they are to
// trust. Its own (made at the first start, kept in a private folder, made again by itself), or one
// that was given.
//
//   FOLDER/authority.pem   key and certificate; made once. Lost or damaged: every phone must trust
//                          the new one again, so that is told loudly.
//   FOLDER/server.pem      key, certificate and the authority's; made again when it must be
//
// Key and certificate lie in one file: what is renamed into its place always fits together.
// These functions read and write files: not on the web thread once it runs.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"
#include "trust/certificate.hpp"

namespace roverd::trust {

/// What was done, or is doubtful, for people.
struct Told {
  std::string text;
  bool alarming = false;  ///< devices must be paired again, or cannot connect
};

struct Identity {
  Credential server;      ///< chain and key
  std::string authority;  ///< certificate that clients are to trust, PEM
  std::vector<Told> told;
  friend bool operator==(const Identity& a, const Identity& b) {
    return a.server.certificate == b.server.certificate && a.authority == b.authority;
  }
};

/// This computer's clock, as it may be believed: empty before `youngest`.
std::optional<base::WallTime> believed(base::WallTime clock, base::WallTime youngest);

/// Reads what is kept, and makes what is missing, damaged or due. Called again later it gives an
/// equal one, or the next.
/// @param now empty: this clock was never set; what is made then lives from `youngest` on, and is
/// made again as soon as a clock says that it must be.
/// Errors: Invalid (others can read the keys), Unavailable (the system's reason: disk full,
/// read-only).
base::Result<Identity> own_identity(const std::filesystem::path& folder, const Names& names,
                                    std::optional<base::WallTime> now, base::WallTime youngest);

/// A given one. Checked: readable, the key only for its owner, both belong together, not over.
/// What it does not name of `names` is told. Errors name the file.
base::Result<Identity> given_identity(const std::filesystem::path& certificate,
                                      const std::filesystem::path& key, const Names& names,
                                      std::optional<base::WallTime> now);

}  // namespace roverd::trust
