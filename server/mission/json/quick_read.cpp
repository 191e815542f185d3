#include "mission/json/quick_read.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "mission/json/fields.hpp"
#include "mission/json/json.hpp"

namespace roverd::mission {
namespace {

/// A simple member of an object.
struct Simple {
  enum class Kind { Null, Flag, Number, Text };
  std::string_view name;
  Kind kind = Kind::Null;
  bool flag = false;
  double number = 0.0;
  std::string_view text;
  bool known = false;
};

/// Reads the text from left to right; what it does not know makes it stop for good.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  bool take(char c) {
    skip_blanks();
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }
  bool at_end() {
    skip_blanks();
    return at_ == end_;
  }

  /// Text without escapes. Whether it is UTF-8 is for check_plan to say, of the names it gives.
  bool text(std::string_view& out) {
    if (!take('"')) return false;
    const char* begin = at_;
    while (at_ != end_ && *at_ != '"') {
      const auto byte = static_cast<unsigned char>(*at_);
      if (byte < 0x20 || byte == '\\') return false;
      ++at_;
    }
    if (at_ == end_) return false;
    out = {begin, static_cast<std::size_t>(at_ - begin)};
    ++at_;
    return true;
  }

  /// As JSON writes them: from_chars alone would take "inf", "01" and "1." too.
  bool number(double& out) {
    skip_blanks();
    const char* digits = at_ != end_ && *at_ == '-' ? at_ + 1 : at_;
    if (digits == end_ || !is_digit(*digits)) return false;
    if (*digits == '0' && digits + 1 != end_ && is_digit(digits[1])) return false;
    const auto [stop, ec] = std::from_chars(at_, end_, out);
    if (ec != std::errc{} || !std::isfinite(out) || !is_digit(stop[-1])) return false;
    const std::string_view all(at_, static_cast<std::size_t>(stop - at_));
    const std::size_t dot = all.find('.');
    if (dot != std::string_view::npos && !is_digit(all[dot + 1])) return false;
    at_ = stop;
    return true;
  }

  bool simple(Simple& out) {
    skip_blanks();
    if (at_ == end_) return false;
    if (*at_ == '"') {
      out.kind = Simple::Kind::Text;
      return text(out.text);
    }
    for (const auto& [word, kind, flag] :
         {Word{"null", Simple::Kind::Null, false}, Word{"true", Simple::Kind::Flag, true},
          Word{"false", Simple::Kind::Flag, false}}) {
      if (!std::string_view(at_, static_cast<std::size_t>(end_ - at_)).starts_with(word)) continue;
      at_ += word.size();
      out.kind = kind;
      out.flag = flag;
      return true;
    }
    out.kind = Simple::Kind::Number;
    return number(out.number);
  }

 private:
  struct Word {
    std::string_view text;
    Simple::Kind kind;
    bool flag;
  };
  static bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
  void skip_blanks() noexcept {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\t' || *at_ == '\r')) ++at_;
  }

  const char* at_;
  const char* end_;
};

/// The members of one object, for the lists in fields.hpp. What is out of the ordinary clears
/// `fine`; ranges are checked with the whole plan.
class QuickMembers {
 public:
  /// {"name": simple, …}
  bool read(Scanner& in) {
    count_ = 0;
    fine = true;
    if (!in.take('{')) return false;
    if (in.take('}')) return true;
    do {
      if (count_ == members_.size()) return false;
      Simple& member = members_[count_] = {};
      if (!in.text(member.name) || !in.take(':') || !in.simple(member)) return false;
      for (std::size_t i = 0; i < count_; ++i) {
        if (members_[i].name == member.name) return false;
      }
      ++count_;
    } while (in.take(','));
    return in.take('}');
  }

  void number(std::string_view name, double& out, const Range&) {
    if (const Simple* m = required(name, Simple::Kind::Number)) out = m->number;
  }
  void number(std::string_view name, std::optional<double>& out, const Range&) {
    if (const Simple* m = optional(name, Simple::Kind::Number)) out = m->number;
  }
  void whole(std::string_view name, int& out, int min, int max) {
    const Simple* m = required(name, Simple::Kind::Number);
    if (m == nullptr) return;
    if (!(m->number >= min && m->number <= max) || std::nearbyint(m->number) != m->number) {
      fine = false;
    } else {
      out = static_cast<int>(m->number);
    }
  }
  void count(std::string_view name, int& out, int max) { whole(name, out, 0, max); }
  void count(std::string_view name, std::optional<int>& out, int max) {
    const Simple* m = optional(name, Simple::Kind::Number);
    if (m != nullptr) whole(name, out.emplace(), 0, max);
  }
  void flag(std::string_view name, bool& out) {
    if (const Simple* m = optional(name, Simple::Kind::Flag)) out = m->flag;
  }
  template <class E>
  void word(std::string_view name, E& out) {
    if (const Simple* m = required(name, Simple::Kind::Text)) read_word(m->text, out);
  }
  template <class E>
  void word(std::string_view name, std::optional<E>& out) {
    if (const Simple* m = optional(name, Simple::Kind::Text)) read_word(m->text, out.emplace());
  }
  template <class E>
  void word_or(std::string_view name, E& out, E usual) {
    out = usual;
    if (const Simple* m = optional(name, Simple::Kind::Text)) read_word(m->text, out);
  }
  void name(std::string_view name, std::string& out) {
    if (const Simple* m = required(name, Simple::Kind::Text)) out = m->text;
  }
  void name(std::string_view name, std::optional<std::string>& out) {
    if (const Simple* m = optional(name, Simple::Kind::Text)) out = m->text;
  }
  void rest(const nlohmann::json&) { fine = false; }
  void exactly_one(std::string_view, bool has_a, std::string_view, bool has_b) {
    if (has_a == has_b) fine = false;
  }
  void together(std::string_view, bool has_a, std::string_view, bool has_b) {
    if (has_a != has_b) fine = false;
  }

  std::string_view type() {
    const Simple* m = required("type", Simple::Kind::Text);
    return m == nullptr ? std::string_view{} : m->text;
  }
  bool all_known() const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      if (!members_[i].known) return false;
    }
    return fine;
  }

  bool fine = true;

 private:
  /// Also null: absent.
  const Simple* optional(std::string_view name, Simple::Kind kind) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (members_[i].name != name) continue;
      members_[i].known = true;
      if (members_[i].kind == Simple::Kind::Null) return nullptr;
      if (members_[i].kind == kind) return &members_[i];
      fine = false;
      return nullptr;
    }
    return nullptr;
  }
  const Simple* required(std::string_view name, Simple::Kind kind) {
    const Simple* m = optional(name, kind);
    if (m == nullptr) fine = false;
    return m;
  }
  template <class E>
  void read_word(std::string_view text, E& out) {
    for (const E word : kWordsOf<E>) {
      if (to_string(word) != text) continue;
      out = word;
      return;
    }
    fine = false;
  }

  std::array<Simple, 16> members_;
  std::size_t count_ = 0;
};

template <std::size_t... I>
bool place_type(Item& item, std::string_view word, std::index_sequence<I...>) {
  static const std::array<std::string_view, sizeof...(I)> kNames{
      type_name(Item(std::in_place_index<I>))...};
  return ((kNames[I] == word && (static_cast<void>(item.emplace<I>()), true)) || ...);
}

template <class T>
bool quick_object(Scanner& in, QuickMembers& members, T& out) {
  if (!members.read(in)) return false;
  fields(members, out);
  return members.all_known();
}

bool quick_items(Scanner& in, QuickMembers& members, std::vector<Item>& items) {
  if (!in.take('[')) return false;
  if (in.take(']')) return true;
  do {
    Item& item = items.emplace_back();
    if (!members.read(in) || items.size() > kMaxItems) return false;
    constexpr auto kTypes = std::make_index_sequence<std::variant_size_v<Item>>{};
    if (!place_type(item, members.type(), kTypes)) return false;
    std::visit([&](auto& values) { fields(members, values); }, item);
    if (!members.all_known()) return false;
    if (std::holds_alternative<MapPoint>(item)) return false;  // asks for a frame
  } while (in.take(','));
  return in.take(']');
}

}  // namespace

std::optional<Plan> quick_plan(std::string_view text) {
  Scanner in(text);
  QuickMembers members;
  Plan plan;
  std::array<bool, 4> seen{};
  const auto first_time = [&seen](std::size_t i) { return !std::exchange(seen[i], true); };
  if (!in.take('{')) return std::nullopt;
  do {
    std::string_view name;
    if (!in.text(name) || !in.take(':')) return std::nullopt;
    bool read = false;
    if (name == "name") {
      std::string_view value;
      read = first_time(0) && in.text(value);
      plan.name = value;
    } else if (name == "home") {
      read = first_time(1) && quick_object(in, members, plan.home.emplace());
    } else if (name == "settings") {
      read = first_time(2) && quick_object(in, members, plan.settings);
    } else if (name == "items") {
      read = first_time(3) && quick_items(in, members, plan.items);
    }
    if (!read) return std::nullopt;
  } while (in.take(','));
  if (!in.take('}') || !in.at_end() || !seen[0] || !seen[3]) return std::nullopt;
  if (!check_plan(plan)) return std::nullopt;
  return plan;
}

}  // namespace roverd::mission
