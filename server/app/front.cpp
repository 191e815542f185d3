#include "app/front.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "api/guard.hpp"
#include "base/time.hpp"
#include "config/reach.hpp"
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

bool holds(const std::vector<std::string>& list, const std::string& one) {
  return std::find(list.begin(), list.end(), one) != list.end();
}

/// "*.farm.example" stands for "rover.farm.example", not for what is below that.
bool in_certificate(const trust::Names& names, const std::string& name) {
  const auto dot = name.find('.');
  return holds(names.hosts, name) || holds(names.addresses, name) ||
         (dot != std::string::npos && dot > 0 && holds(names.hosts, "*" + name.substr(dot)));
}

}  // namespace

Result<std::unique_ptr<Front>> Front::open(const ServerSettings& settings,
                                           const std::filesystem::path& data,
                                           const Presence& presence) {
  std::unique_ptr<Front> front(new Front(settings, data / "tls", presence));
  auto found = front->look();
  if (!found) return tl::unexpected(found.error());
  const trust::Credential& server = found->identity.server;
  auto tls = net::Tls::make(server.certificate, server.key);
  if (!tls) return tl::unexpected(tls.error());
  front->tls_ = std::move(*tls);
  front->call(std::move(found->names), std::move(found->outward));
  for (const std::string& one : addresses_of(settings)) {
    if (one == "::" || one == "0.0.0.0" || is_loopback(one)) continue;
    if (holds(front->names_.addresses, one)) continue;
    front->news_.push_back({"no interface has the address " + one +
                                " now: whoever comes to it is heard as soon as one has",
                            true});
  }
  front->show(std::move(found->identity));
  return front;
}

Result<Front::Found> Front::look() const {
  const std::string host = trust::host_name();
  std::string also = settings_.names;
  for (const std::string& one : presence_.hosts()) {
    if (trust::is_host_name(one)) also += " " + one;
  }
  auto names = trust::all_names(host, trust::interface_addresses(), also);
  if (!names) return base::fail(names.error().code, "server.names: " + names.error().detail);
  const auto now = trust::believed(base::wall_now(), base::kYoungest);
  const bool own = settings_.tls_certificate.empty();
  auto identity =
      own ? trust::own_identity(folder_, *names, now, base::kYoungest)
          : trust::given_identity(settings_.tls_certificate, settings_.tls_key, *names, now);
  if (!identity) return tl::unexpected(identity.error());
  return Found{std::move(*identity), std::move(*names), trust::outward_address()};
}

void Front::take(Result<Found> next) {
  if (next && (next->names != names_ || next->outward != outward_)) {
    const std::string before = address();
    call(std::move(next->names), std::move(next->outward));
    if (address() != before) news_.push_back({"the page is at " + address() + " now"});
  }
  if (next && next->identity == identity_) return;
  const trust::Credential* server = next ? &next->identity.server : nullptr;
  auto shown = server != nullptr ? tls_->show(server->certificate, server->key)
                                 : Result<void>(tl::unexpected(next.error()));
  const std::string trouble = shown ? std::string() : shown.error().detail;
  if (!trouble.empty() && trouble != trouble_) {
    news_.push_back({trouble + "; the certificate before it stays", true});
  }
  trouble_ = trouble;
  if (shown) show(std::move(next->identity));
}

void Front::show(trust::Identity next) {
  identity_ = std::move(next);
  shown_ = trust::read_certificate(identity_.server.certificate)->names;
  facts_.authority = identity_.authority;
  facts_.authority_der = trust::der_of(identity_.authority).value_or(std::string());
  facts_.fingerprint = trust::read_certificate(identity_.authority)->fingerprint;
  auto told = std::exchange(identity_.told, {});
  std::move(told.begin(), told.end(), std::back_inserter(news_));
}

void Front::call(trust::Names names, std::string outward) {
  names_ = std::move(names);
  outward_ = std::move(outward);
  set_port(port_);
}

std::string Front::at(const std::string& address) const {
  return "https://" + authority_of(address, port_);
}

std::string Front::address() const {
  return facts_.address;
}

void Front::set_port(std::uint16_t port) {
  port_ = port;
  std::vector<std::string> reached;
  for (const std::string& one : addresses_of(settings_)) {
    const bool every = one == "::" || one == "0.0.0.0";
    if (!every) {
      reached.push_back(one);
      continue;
    }
    for (const std::string& own : names_.addresses) {
      const bool v6 = own.find(':') != std::string::npos;
      if (!is_loopback(own) && !holds(reached, own) && (!v6 || one == "::")) reached.push_back(own);
    }
  }
  if (reached.empty()) reached.emplace_back("127.0.0.1");
  // People can type those of IPv4. Others are of bridges that only containers know.
  const auto first = std::stable_partition(reached.begin(), reached.end(),
                                           [this](const std::string& a) { return a == outward_; });
  std::stable_partition(first, reached.end(),
                        [](const std::string& a) { return a.find(':') == std::string::npos; });
  facts_.address = at(reached.front());
  facts_.addresses.clear();
  for (std::size_t i = 1; i < reached.size(); ++i) facts_.addresses.push_back(at(reached[i]));
}

std::optional<net::Response> Front::answer(const net::Request& request) const {
  if (request.method() != http::verb::get && request.method() != http::verb::head) return {};
  if (auto picture = presence_.answer(request)) return picture;
  const std::string_view target = view(request.target());
  // Whoever reached it under one name or address goes on there.
  pair::Facts facts = facts_;
  const badge::Badge badge = presence_.badge();
  facts.name = badge.name;
  facts.picture = badge::picture_path(badge);
  if (is_host(request)) facts.address = "https://" + std::string(view(request[http::field::host]));
  std::erase(facts.addresses, facts.address);
  auto file = pair::file_at(target.substr(0, target.find('?')), facts);
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

bool Front::is_ours(const std::string& name) const {
  return in_certificate(shown_, name) || holds(names_.hosts, name) || holds(names_.addresses, name);
}

/// As guard.hpp has it, for what it does not see.
bool Front::is_host(const net::Request& request) const {
  if (request.count(http::field::host) != 1) return false;
  const std::string name = api::bare_name(view(request[http::field::host]));
  const std::string_view here = view(request[{net::kHereHeader.data(), net::kHereHeader.size()}]);
  return !name.empty() && (is_ours(name) || name == here);
}

net::Response Front::on_plain(const net::Request& request) const {
  const std::string_view host = view(request[http::field::host]);
  // A foreign name that was pointed here gets nothing, as everywhere.
  if (!is_host(request)) {
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
  std::string text = "this robot is " + presence_.badge().name + "\n";
  for (const std::string& other : facts_.addresses) text += "also at " + other + "\n";
  const std::string said = pair::code_text(facts_);
  text +=
      "pair at " + said.substr(0, said.find('#')) + "\nfingerprint " + facts_.fingerprint + "\n";
  if (!drawn) return text;
  const auto code = pair::qr_code(said);
  return code ? text + pair::terminal_text_of(*code) : text;
}

}  // namespace roverd
