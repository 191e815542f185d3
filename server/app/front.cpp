#include "app/front.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "base/time.hpp"
#include "net/assets.hpp"
#include "pair/code.hpp"
#include "trust/certificate.hpp"
#include "trust/host_names.hpp"

namespace roverd {
namespace {

namespace http = boost::beast::http;
using base::Result;

std::string_view view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

net::Response text_answer(http::status status, std::string body) {
  net::Response response{status, 11};
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  net::set_security_headers(response);
  response.body() = std::move(body);
  return response;
}

/// "rover.local:8080" without the port, lower case; an IPv6 address without its brackets.
std::string bare_host(std::string_view host) {
  if (host.starts_with('[')) {
    host = host.substr(1, host.find(']') == std::string_view::npos ? 0 : host.find(']') - 1);
  } else {
    host = host.substr(0, host.find(':'));
  }
  std::string bare(host);
  std::transform(bare.begin(), bare.end(), bare.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return bare;
}

}  // namespace

Result<std::unique_ptr<Front>> Front::open(const ServerSettings& settings,
                                           const std::filesystem::path& data) {
  std::unique_ptr<Front> front(new Front(settings, data / "tls"));
  auto identity = front->look();
  if (!identity) return tl::unexpected(identity.error());
  auto tls = net::Tls::make(identity->server.certificate, identity->server.key);
  if (!tls) return tl::unexpected(tls.error());
  front->tls_ = std::move(*tls);
  front->show(std::move(*identity));
  return front;
}

Result<trust::Identity> Front::look() const {
  const std::string host = trust::host_name();
  const auto names = trust::all_names(host, trust::interface_addresses(), settings_.names);
  if (!names) return base::fail(names.error().code, "server.names: " + names.error().detail);
  const auto now = trust::believed(base::wall_now(), base::kYoungest);
  if (settings_.tls_certificate.empty()) {
    return trust::own_identity(folder_, *names, now, base::kYoungest);
  }
  return trust::given_identity(settings_.tls_certificate, settings_.tls_key, *names, now);
}

void Front::take(Result<trust::Identity> next) {
  if (next && *next == identity_) return;
  auto shown = next ? tls_->show(next->server.certificate, next->server.key)
                    : Result<void>(tl::unexpected(next.error()));
  const std::string trouble = shown ? std::string() : shown.error().detail;
  if (!trouble.empty() && trouble != trouble_) {
    news_.push_back({trouble + "; the certificate before it stays", true});
  }
  trouble_ = trouble;
  if (shown) show(std::move(*next));
}

void Front::show(trust::Identity next) {
  identity_ = std::move(next);
  names_ = trust::read_certificate(identity_.server.certificate)->names;
  facts_.name = names_.hosts.empty() ? "robot" : names_.hosts.front();
  facts_.authority = identity_.authority;
  facts_.authority_der = trust::der_of(identity_.authority).value_or(std::string());
  facts_.fingerprint = trust::read_certificate(identity_.authority)->fingerprint;
  news_ = std::exchange(identity_.told, {});
}

void Front::set_address(const std::string& address) {
  facts_.address = address;
}

std::optional<net::Response> Front::answer(const net::Request& request) const {
  if (request.method() != http::verb::get && request.method() != http::verb::head) return {};
  const std::string_view target = view(request.target());
  auto file = pair::file_at(target.substr(0, target.find('?')), facts_);
  if (!file) return std::nullopt;
  net::Response response{http::status::ok, 11};
  response.set(http::field::content_type,
               boost::beast::string_view(file->content_type.data(), file->content_type.size()));
  response.set(http::field::cache_control, "no-store");
  net::set_security_headers(response);
  if (!file->saved_as.empty()) {
    response.set(http::field::content_disposition,
                 "attachment; filename=\"" + std::string(file->saved_as) + "\"");
  }
  response.body() = std::move(file->body);
  return response;
}

bool Front::is_ours(std::string_view host) const {
  const std::string bare = bare_host(host);
  const auto in = [&bare](const auto& list) {
    return std::find(list.begin(), list.end(), bare) != list.end();
  };
  return in(names_.hosts) || in(names_.addresses);
}

net::Response Front::on_plain(const net::Request& request) const {
  const std::string_view host = view(request[http::field::host]);
  // A foreign name that was pointed here gets nothing, as everywhere.
  if (request.count(http::field::host) != 1 || !is_ours(host)) {
    return text_answer(http::status::forbidden, "this name is not served here\n");
  }
  if (auto file = answer(request)) return std::move(*file);
  const bool reads = request.method() == http::verb::get || request.method() == http::verb::head;
  const std::string_view target = view(request.target());
  if (!reads || !target.starts_with('/')) {
    return text_answer(
        http::status::forbidden,
        "nothing is taken unencrypted: use https, see http://" + std::string(host) + "/pair\n");
  }
  auto response =
      text_answer(http::status::temporary_redirect, "use https; how to trust it: /pair\n");
  response.set(http::field::location, "https://" + std::string(host) + std::string(target));
  response.set(http::field::cache_control, "no-store");
  return response;
}

std::string Front::invitation(bool drawn) const {
  std::string text = "pair at " +
                     pair::code_text(facts_).substr(0, pair::code_text(facts_).find('#')) +
                     "\nfingerprint " + facts_.fingerprint + "\n";
  if (!drawn) return text;
  const auto code = pair::qr_code(pair::code_text(facts_));
  return code ? text + pair::terminal_text_of(*code) : text;
}

}  // namespace roverd
