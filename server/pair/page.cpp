#include "pair/page.hpp"

#include <algorithm>

#include "pair/code.hpp"

namespace roverd::pair {

namespace {

constexpr std::string_view kStyle = R"(:root { color-scheme: light dark; }
body { font: 1.1rem/1.5 system-ui, sans-serif; max-width: 40rem; margin: 0 auto; padding: 1rem; }
img { width: 16rem; max-width: 100%; }
h1 { display: flex; align-items: center; gap: 0.8rem; overflow-wrap: anywhere; }
h1 img { flex: none; width: 3.5rem; height: 3.5rem; object-fit: cover; border-radius: 0.7rem; }
code { overflow-wrap: anywhere; }
.button { display: inline-block; padding: 0.8rem 1.2rem; margin: 0.3rem 0.3rem 0.3rem 0;
  border: 2px solid; border-radius: 0.5rem; font-weight: bold; text-decoration: none; }
summary { padding: 0.6rem 0; font-weight: bold; }
)";

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string hex_digits(std::string_view pairs) {
  std::string out(pairs);
  std::erase(out, ':');
  return out;
}

std::string steps() {
  return R"(<details open><summary>Android</summary><ol>
<li>Download the certificate above.</li>
<li>Settings, <i>Security and privacy</i>, <i>More security settings</i>, <i>Install from storage</i>
 (or <i>Encryption and credentials</i>, <i>Install a certificate</i>), <i>CA certificate</i>,
 <i>Install anyway</i>: choose <code>roverd-ca.crt</code>.</li>
<li>Open the robot's page in Chrome.</li></ol></details>
<details><summary>iPhone, iPad</summary><ol>
<li>In Safari, download the profile above and allow it.</li>
<li>Settings, <i>Profile Downloaded</i>, <i>Install</i>.</li>
<li>Settings, <i>General</i>, <i>About</i>, <i>Certificate Trust Settings</i>: switch the robot's
 certificate on.</li></ol></details>
<details><summary>Windows, macOS, Linux, Firefox</summary>
<p>Windows: open the certificate, <i>Install Certificate</i>, <i>Local Machine</i>, place it in
<i>Trusted Root Certification Authorities</i>. macOS: open it with <i>Keychain Access</i>, then set
<i>Trust</i> to <i>Always Trust</i>. Linux (Debian): <code>sudo cp roverd-ca.pem
/usr/local/share/ca-certificates/roverd.crt &amp;&amp; sudo update-ca-certificates</code>. Firefox:
<i>Settings</i>, <i>Privacy &amp; Security</i>, <i>View Certificates</i>, <i>Authorities</i>,
<i>Import</i>.</p></details>
)";
}

std::string page_text(const Facts& facts) {
  const std::string address = escaped(facts.address);
  std::string others;
  for (const auto& one : facts.addresses) {
    others += "<li><a href=\"" + escaped(one) + "/\">" + escaped(one) + "</a></li>\n";
  }
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
         "<link rel=\"stylesheet\" href=\"/pair.css\"><link rel=\"icon\" href=\"" +
         escaped(facts.picture) + "\"><title>" + escaped(facts.name) +
         " – pair – roverd</title></head><body>\n<h1><img src=\"" + escaped(facts.picture) +
         "\" alt=\"\"><span>Pair with " + escaped(facts.name) +
         "</span></h1>\n<p>This robot has no internet: it vouches for itself. Once you trust its "
         "certificate, the connection is encrypted, and nobody else can pose as the robot.</p>\n"
         "<p><img src=\"/pair.svg\" alt=\"QR code of this page\"></p>\n"
         "<h2>1. Compare</h2>\n<p>The robot's own terminal or screen shows the same SHA-256 "
         "fingerprint, and so does your system when it asks:</p>\n<p><code>" +
         escaped(facts.fingerprint) +
         "</code></p>\n<h2>2. Trust</h2>\n<p><a class=\"button\" href=\"/ca.crt\">Certificate"
         "</a><a class=\"button\" href=\"/ca.mobileconfig\">Profile (iPhone, iPad)</a>"
         "<a class=\"button\" href=\"/ca.pem\">PEM (Linux)</a></p>\n" +
         steps() + "<h2>3. Drive</h2>\n<p><a class=\"button\" href=\"" + address + "/\">" +
         address + "</a></p>\n" + (others.empty() ? "" : "<ul>\n" + others + "</ul>\n") +
         "</body></html>\n";
}

/// Lower case digits of the fingerprint from there on, as a UUID. The same certificate always gets
/// the same, so that installing it again replaces it.
std::string uuid_of(const std::string& digits, std::size_t from) {
  std::string text = digits.substr(from, 32);
  if (text.size() < 32) text.resize(32, '0');
  for (const std::size_t at : {20U, 16U, 12U, 8U}) text.insert(at, "-");
  return text;
}

/// The inner lines of a PEM text: base64.
std::string base64_of(std::string_view pem) {
  const auto begin = pem.find('\n');
  const auto end = pem.find("\n-----END");
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) return {};
  return std::string(pem.substr(begin + 1, end - begin - 1));
}

std::string apple_profile(const Facts& facts) {
  const std::string digits = hex_digits(facts.fingerprint);
  const auto entry = [](std::string_view key, const std::string& value) {
    return "<key>" + std::string(key) + "</key><string>" + escaped(value) + "</string>\n";
  };
  const auto head = [&](const std::string& type, const std::string& name, std::size_t from) {
    const std::string id = uuid_of(digits, from);
    return entry("PayloadDisplayName", name) + entry("PayloadIdentifier", "roverd." + id) +
           entry("PayloadType", type) + entry("PayloadUUID", id) +
           "<key>PayloadVersion</key><integer>1</integer>\n";
  };
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE plist PUBLIC \"-//Apple//DTD PLIST "
         "1.0//EN\" \"http://www.apple.com/DTDs/PropertyList-1.0.dtd\">\n<plist version=\"1.0\">"
         "<dict>\n<key>PayloadContent</key><array><dict>\n<key>PayloadContent</key><data>\n" +
         base64_of(facts.authority) + "\n</data>\n" +
         head("com.apple.security.root", facts.name, 0) + "</dict></array>\n" +
         head("Configuration", "Robot " + facts.name, 32) +
         "<key>PayloadRemovalDisallowed</key><false/>\n</dict></plist>\n";
}

}  // namespace

std::string code_text(const Facts& facts) {
  std::string plain = facts.address;
  if (plain.starts_with("https://")) plain.erase(4, 1);  // not trusted yet
  return plain + "/pair#sha256=" + hex_digits(facts.fingerprint);
}

std::optional<File> file_at(std::string_view path, const Facts& facts) {
  if (path == "/pair") return File{"text/html; charset=utf-8", page_text(facts), {}};
  if (path == "/pair.css") return File{"text/css; charset=utf-8", std::string(kStyle), {}};
  if (path == "/pair.svg") {
    const auto code = qr_code(code_text(facts));
    return File{"image/svg+xml", code ? svg_of(*code) : std::string(), {}};
  }
  if (path == "/ca.crt") {
    return File{"application/x-x509-ca-cert", facts.authority_der, "roverd-ca.crt"};
  }
  if (path == "/ca.pem") return File{"application/x-pem-file", facts.authority, "roverd-ca.pem"};
  if (path == "/ca.mobileconfig") {
    return File{"application/x-apple-aspen-config", apple_profile(facts), {}};
  }
  return std::nullopt;
}

}  // namespace roverd::pair
