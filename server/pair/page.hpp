#pragma once
// What a phone or computer gets before it trusts the robot: a page that needs no script and no
// trust, and the authority's certificate in the shapes that systems take. Pure; the same for all.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roverd::pair {

struct Facts {
  std::string name;                    ///< of the robot, for people
  std::string picture;                 ///< of the robot, its path on this server
  std::string address;                 ///< "https://192.168.4.1:8080", without a path
  std::vector<std::string> addresses;  ///< others under which it may be reached, the same way
  std::string fingerprint;             ///< of the authority, as pairs
  std::string authority;               ///< its certificate, PEM
  std::string authority_der;
};

struct File {
  std::string_view content_type;
  std::string body;
  std::string_view saved_as;  ///< the name that a download gets; empty: it is shown
};

/// What the QR code says: where this page is, and whom to trust then. The fingerprint stands behind
/// the #, so it is not sent.
std::string code_text(const Facts& facts);

/// /pair, /pair.css, /pair.svg; the authority as /ca.crt (DER: Android, Windows, macOS),
/// /ca.pem (Linux, curl) and /ca.mobileconfig (iOS). Empty: none of these.
std::optional<File> file_at(std::string_view path, const Facts& facts);

}  // namespace roverd::pair
