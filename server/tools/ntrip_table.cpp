#include "tools/ntrip_table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <nlohmann/json.hpp>

#include "base/time.hpp"
#include "link/address.hpp"
#include "ntrip/caster.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto kPatience = std::chrono::seconds(15);
std::string printable(std::string text) {
  for (char& c : text) {
    if (c < ' ' || c >= 0x7F) c = '?';
  }
  return text;
}

std::string decimals(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

using TableRow = std::array<std::string, 8>;

TableRow row_of(const ntrip::Source& s) {
  const bool placed = s.lat && s.lon;
  return {s.mountpoint,
          s.format,
          s.systems,
          s.country,
          placed ? decimals(*s.lat) : "-",
          placed ? decimals(*s.lon) : "-",
          std::string(s.wants_gga ? "yes" : "no"),
          std::string(s.login == 'N'   ? "none"
                      : s.login == 'B' ? "basic"
                                       : "digest")};
}

/// @return why there is no table; empty: `reply` holds it.
std::string fetch(const ntrip::Caster& caster, ntrip::Reply& reply) {
  boost::asio::io_context io;
  auto made = link::make_byte_link(io, caster.address());
  if (!made) return made.error().detail;
  const auto link = std::move(*made);
  bool closed = false;
  std::string why;
  link->on_bytes = [&](base::Bytes b, base::Time) { reply.feed(b, [](base::Bytes) {}); };
  link->on_closed = [&](const std::string& reason) {
    closed = true;
    why = reason;
  };
  if (const auto opened = link->open(); !opened) return opened.error().detail;
  const std::string text = ntrip::request(caster, 2);
  bool asked = false;
  const base::Time end = base::steady_now() + kPatience;
  const auto settled = [&] {
    using State = ntrip::Reply::State;
    return reply.state() == State::Refused || reply.state() == State::Ended ||
           reply.state() == State::Stream;
  };
  while (!closed && !settled() && base::steady_now() < end) {
    if (!asked) {
      asked = link->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}) ==
              link::SendResult::Sent;
    }
    io.restart();
    io.run_for(std::chrono::milliseconds(20));
  }
  link->close();
  if (reply.state() == ntrip::Reply::State::Refused) return reply.refusal();
  if (!reply.sources().empty() || reply.state() == ntrip::Reply::State::Ended) return {};
  if (reply.state() == ntrip::Reply::State::Table && closed) return {};
  return closed ? why : "no answer";
}

}  // namespace

std::string table_text(const std::vector<ntrip::Source>& sources) {
  std::vector<TableRow> rows{
      {"mountpoint", "format", "systems", "country", "lat", "lon", "wants GGA", "login"}};
  for (const auto& s : sources) rows.push_back(row_of(s));
  TableRow::size_type column = 0;
  std::array<std::size_t, std::tuple_size_v<TableRow>> width{};
  for (const TableRow& row : rows) {
    for (column = 0; column < row.size(); ++column) {
      width[column] = std::max(width[column], row[column].size());
    }
  }
  std::string out;
  for (const TableRow& row : rows) {
    std::string line;
    for (column = 0; column < row.size(); ++column) {
      line += printable(row[column]) + std::string(width[column] - row[column].size() + 2, ' ');
    }
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return out;
}

std::string table_json(const std::string& caster, const std::vector<ntrip::Source>& sources) {
  Json out = Json::array();
  for (const auto& s : sources) {
    Json row = {{"caster", caster},
                {"mountpoint", printable(s.mountpoint)},
                {"place", printable(s.place)},
                {"country", printable(s.country)},
                {"format", printable(s.format)},
                {"systems", printable(s.systems)},
                {"wants_gga", s.wants_gga},
                {"login", s.login == 'N'   ? "none"
                          : s.login == 'B' ? "basic"
                                           : "digest"},
                {"lat", nullptr},
                {"lon", nullptr}};
    if (s.lat) row["lat"] = *s.lat;
    if (s.lon) row["lon"] = *s.lon;
    out.push_back(std::move(row));
  }
  return out.dump(2);
}

int ntrip_table(const std::vector<std::string>& addresses, bool json) {
  std::vector<ntrip::Caster> casters;
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    const bool whole = addresses[i].find("://") != std::string::npos;
    auto parsed = ntrip::parse_casters(whole ? addresses[i] : "ntrip://" + addresses[i]);
    if (!parsed) {
      std::fprintf(stderr, "roverd: argument %zu: %s\n", i + 1, parsed.error().detail.c_str());
      return 2;
    }
    casters.push_back(std::move(parsed->front()));
    casters.back().mountpoint.clear();
  }
  int code = 0;
  Json all = Json::array();
  for (const ntrip::Caster& caster : casters) {
    ntrip::Reply reply;
    if (const std::string why = fetch(caster, reply); !why.empty()) {
      std::fprintf(stderr, "roverd: %s: %s\n", caster.name().c_str(), why.c_str());
      code = 1;
    } else if (json) {
      for (auto& row : Json::parse(table_json(caster.name(), reply.sources()))) all.push_back(row);
    } else {
      std::printf("%s\n%s", caster.name().c_str(), table_text(reply.sources()).c_str());
    }
  }
  if (json) std::printf("%s\n", all.dump(2).c_str());
  return code;
}

}  // namespace roverd
