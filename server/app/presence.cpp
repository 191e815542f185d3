#include "app/presence.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "app/version.hpp"
#include "base/log.hpp"
#include "config/reach.hpp"
#include "net/assets.hpp"
#include "trust/host_names.hpp"
#include "trust/private_files.hpp"

namespace roverd {
namespace {

namespace http = boost::beast::http;

/// This computer's, without its domain; what nobody named is a robot.
std::string default_name() {
  const std::string host = trust::host_name();
  std::string name = host.substr(0, host.find('.'));
  name.resize(std::min(name.size(), badge::kLongestName));
  return name.empty() || name == "localhost" || !badge::check_name(name) ? "robot" : name;
}

/// Single addresses are not told: the daemon tells all that the computer has.
bool on_every_address(const ServerSettings& server) {
  const auto addresses = addresses_of(server);
  return std::any_of(addresses.begin(), addresses.end(),
                     [](const std::string& one) { return one == "::" || one == "0.0.0.0"; });
}

base::Result<std::shared_ptr<const badge::Picture>> read_picture(const std::string& file) {
  if (file.empty()) return nullptr;
  auto bytes = trust::read_public(file);
  if (!bytes) return tl::unexpected(bytes.error());
  auto picture = badge::picture_of(std::move(*bytes));
  if (!picture) return tl::unexpected(picture.error());
  return std::make_shared<const badge::Picture>(std::move(*picture));
}

}  // namespace

base::Result<std::unique_ptr<Presence>> Presence::open(const Settings& settings) {
  std::unique_ptr<Presence> made(new Presence);
  const BadgeSettings& said = settings.badge;
  made->name_ = said.name.empty() ? default_name() : said.name;
  made->colour_ = said.colour;
  auto picture = read_picture(said.picture);
  if (!picture) {
    return base::fail(picture.error().code,
                      settings.where("robot.picture") + ": " + picture.error().detail);
  }
  made->picture_ = std::move(*picture);
  made->vehicle_ = settings.vehicle.name;
  made->wanted_ = settings.server.announce && on_every_address(settings.server);
  made->service_.name = made->name_;
  made->service_.label = badge::label_of(made->name_);
  return made;
}

void Presence::announce(std::uint16_t port, const std::string& fingerprint,
                        std::function<void(announce::News)> tell) {
  if (!wanted_) return;
  service_.port = port;
  service_.facts = {
      {"path", "/"}, {"version", kVersion}, {"vehicle", vehicle_}, {"fingerprint", fingerprint}};
  announcer_ = std::make_unique<announce::Announcer>(service_, std::move(tell));
}

std::optional<base::Event> Presence::heard(const announce::News& news) const {
  const auto level = news.alarming ? base::Level::Warning : base::Level::Info;
  base::log(level, "main", "announced", {{"done", news.text}});
  if (!unannounced().empty()) return std::nullopt;
  return base::Event{base::wall_now(), base::Severity::Info, "announced", news.text};
}

void Presence::vouched_by(const std::string& fingerprint) {
  if (!announcer_ || service_.facts.back().second == fingerprint) return;
  service_.facts.back().second = fingerprint;
  announcer_->change(service_);
}

badge::Badge Presence::badge() const {
  const std::string name = announcer_ ? announcer_->state().name : name_;
  return {name, badge::colour_of(colour_, name).value_or(badge::kColours.front()), picture_};
}

api::Identity Presence::identity() const {
  const badge::Badge now = badge();
  const auto state = announcer_ ? announcer_->state() : announce::State{};
  return {.name = now.name,
          .host = state.told ? state.host : std::string(),
          .colour = std::string(now.colour.name),
          .rgb = std::string(now.colour.rgb),
          .picture = std::string(badge::picture_path(now))};
}

std::vector<std::string> Presence::hosts() const {
  if (announcer_) return announcer_->state().hosts;
  return {service_.label + ".local"};
}

std::string Presence::unannounced() const {
  return announcer_ ? announcer_->state().trouble : std::string();
}

std::optional<net::Response> Presence::answer(const net::Request& request) const {
  if (request.method() != http::verb::get && request.method() != http::verb::head) return {};
  const std::string_view target(request.target().data(), request.target().size());
  auto file = badge::file_at(target.substr(0, target.find('?')), badge());
  if (!file) return std::nullopt;
  net::Response response{http::status::ok, 11};
  response.set(http::field::content_type,
               boost::beast::string_view(file->content_type.data(), file->content_type.size()));
  response.set(http::field::cache_control, "no-cache");
  net::set_security_headers(response);
  response.body() = std::move(file->body);
  return response;
}

}  // namespace roverd
