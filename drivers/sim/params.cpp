#include "sim/params.hpp"

#include <algorithm>
#include <array>

namespace roverd::sim {
namespace {

struct SetOne {
  std::string_view section;
  std::string_view name;
  const base::ParamValue& value;
  bool found = false;
  base::Result<void> result{};

  template <class P>
  void operator()(std::string_view section_name, P& params) {
    if (section_name != section) return;
    found = true;
    result = base::set_param(params, name, value);
  }
};

struct DescribeAll {
  std::vector<base::ParamInfo> out;

  template <class P>
  void operator()(std::string_view section, P& params) {
    for (base::ParamInfo& info : base::describe(params)) {
      info.name = std::string(section) + "." + info.name;
      out.push_back(std::move(info));
    }
  }
};

/// The words a text parameter may hold; empty: any.
std::vector<std::string_view> words_of(std::string_view key) {
  if (key == "device.wire") return {"can", "ackermann", "ratio", "twist_text", "twist_binary"};
  if (key == "device.port") return {"udp", "tcp", "pty"};
  if (key == "base.protocol") return {"v2", "v1"};
  if (key == "gnss.profile") return {"rtk", "float", "consumer", "plain"};
  if (key == "radio.linear_stick") return {"right_ud", "left_ud"};
  if (key == "radio.turn_stick") return {"left_lr", "right_lr"};
  return {};
}

base::Result<void> check_word(std::string_view key, const base::ParamValue& value) {
  const auto words = words_of(key);
  const auto* word = std::get_if<std::string>(&value);
  if (words.empty() || word == nullptr || std::ranges::find(words, *word) != words.end()) return {};
  std::string text = "must be one of";
  for (const std::string_view w : words) text += " " + std::string(w);
  return base::fail(base::Code::Invalid, std::string(key) + " " + text, {{std::string(key), text}});
}

}  // namespace

base::Result<void> set_param(Params& params, std::string_view key, const base::ParamValue& value) {
  const auto dot = key.find('.');
  if (dot != std::string_view::npos) {
    if (auto ok = check_word(key, value); !ok) return ok;
    SetOne visitor{key.substr(0, dot), key.substr(dot + 1), value};
    sections(visitor, params);
    if (visitor.found && visitor.result) return {};
    if (visitor.found && visitor.result.error().detail != "unknown key") {
      const std::string problem = visitor.result.error().fields.at(0).detail;
      return base::fail(base::Code::Invalid, std::string(key) + " " + problem,
                        {{std::string(key), problem}});
    }
  }
  return base::fail(base::Code::Invalid, "unknown key " + std::string(key),
                    {{std::string(key), "unknown key"}});
}

std::vector<base::ParamInfo> describe(const Params& params) {
  Params copy = params;
  DescribeAll visitor;
  sections(visitor, copy);
  return visitor.out;
}

}  // namespace roverd::sim
