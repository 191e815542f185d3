#pragma once
// The one reader of JSON objects, for requests and for files: strict, every offending member named
// by JSON pointer (RFC 6901). Members are asked for one by one, or by the lists in fields.hpp,
// whose visitor it is. Its calls that return a value treat null as absent.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/result.hpp"
#include "mission/json/fields.hpp"
#include "mission/json/pointer.hpp"

namespace roverd::mission {

/// "must be one of left right"
template <class E>
std::string words_problem() {
  std::string text = "must be one of";
  for (const E word : kWordsOf<E>) text += ' ' + std::string(to_string(word));
  return text;
}

inline constexpr std::string_view kTwoOfOne =
    "and turn_deg exclude each other: give one of the two";

/// A place in a document: "/home", or "/items" and 3. Its text is only made when it is needed.
struct Place {
  std::string_view name;
  std::optional<std::size_t> index{};
  std::string text() const {
    std::string out(name);
    if (index) out += '/' + std::to_string(*index);
    return out;
  }
};

/// Reads the members of one object, and complains about those nobody asked for. Not to be copied:
/// it may own what it found.
class Members {
 public:
  /// A document of its own: finish() tells all that was wrong. The object must outlive it.
  /// @param pointer of the object in its document: "/courses/3"
  explicit Members(const nlohmann::json& object, std::string pointer = {})
      : object_(object), pointer_(std::move(pointer)), where_{pointer_}, problems_(own_) {}
  /// A part of a document whose problems somebody else collects; refuse_unknown() ends it.
  Members(const nlohmann::json& object, Place where, Problems& problems)
      : object_(object), where_(where), problems_(problems) {}
  Members(const Members&) = delete;
  Members& operator=(const Members&) = delete;

  // One by one. Absent: empty. Wrong type or out of range: empty, and noted.
  std::optional<double> number(std::string_view name, double min, double max);
  std::optional<std::int64_t> whole(std::string_view name, std::int64_t min, std::int64_t max);
  std::optional<std::string> text(std::string_view name);
  std::optional<bool> flag(std::string_view name);
  /// For members whose form the caller judges. Null if absent.
  const nlohmann::json* any(std::string_view name);
  /// The same, and a null of the document as it is.
  const nlohmann::json* known(std::string_view name);
  void require(std::string_view name);

  // What is wrong.
  void complain(std::string_view name, std::string detail);
  /// What is wrong beside the object: the name stands as it is.
  void complain_of_header(std::string_view name, std::string detail);
  /// What is wrong with the members of a member: "/front/mode".
  void complain_inside(std::string_view name, const base::Error& inner);
  bool complained() const noexcept { return !problems_.none(); }

  /// After all members were asked for.
  void refuse_unknown();
  /// refuse_unknown(), then Invalid with all that was found, or fine. `subject`: "the body".
  base::Result<void> finish(std::string_view subject = "the body");

  // The visitor of fields.hpp.
  void number(std::string_view name, double& out, const Range& range) {
    if (const nlohmann::json* value = required(name)) read(name, *value, out, range);
  }
  void number(std::string_view name, std::optional<double>& out, const Range& range) {
    if (const nlohmann::json* value = any(name)) read(name, *value, out.emplace(), range);
  }
  void whole(std::string_view name, int& out, int min, int max) {
    if (const nlohmann::json* value = required(name)) read_whole(name, *value, out, min, max);
  }
  void count(std::string_view name, int& out, int max) {
    if (const nlohmann::json* value = required(name)) read_count(name, *value, out, max);
  }
  void count(std::string_view name, std::optional<int>& out, int max) {
    if (const nlohmann::json* value = any(name)) read_count(name, *value, out.emplace(), max);
  }
  void flag(std::string_view name, bool& out) { out = flag(name).value_or(out); }
  template <class E>
  void word(std::string_view name, E& out) {
    if (const nlohmann::json* value = required(name)) read_word(name, *value, out);
  }
  template <class E>
  void word(std::string_view name, std::optional<E>& out) {
    if (const nlohmann::json* value = any(name)) read_word(name, *value, out.emplace());
  }
  template <class E>
  void word_or(std::string_view name, E& out, E usual) {
    out = usual;
    if (const nlohmann::json* value = any(name)) read_word(name, *value, out);
  }
  void name(std::string_view name, std::string& out);
  void name(std::string_view at, std::optional<std::string>& out) {
    if (any(at) != nullptr) name(at, out.emplace());
  }
  void rest(nlohmann::json& out);
  void exactly_one(std::string_view a, bool has_a, std::string_view b, bool has_b) {
    if (has_a && has_b) complain(b, std::string(kTwoOfOne));
    if (!has_a && !has_b && any(a) == nullptr && any(b) == nullptr) {
      complain(a, "or " + std::string(b) + " is required");
    }
  }
  void together(std::string_view a, bool has_a, std::string_view b, bool has_b) {
    if (has_a != has_b && (has_a ? any(b) : any(a)) == nullptr) {
      complain(has_a ? b : a, "is required where the other one is given");
    }
  }

 private:
  const nlohmann::json* required(std::string_view name);
  bool read(std::string_view name, const nlohmann::json& value, double& out, const Range& range);
  void read_whole(std::string_view name, const nlohmann::json& value, int& out, int min, int max);
  void read_count(std::string_view name, const nlohmann::json& value, int& out, int max);
  template <class E>
  void read_word(std::string_view name, const nlohmann::json& value, E& out) {
    if (value.is_string()) {
      for (const E word : kWordsOf<E>) {
        if (to_string(word) == value.get_ref<const std::string&>()) {
          out = word;
          return;
        }
      }
    }
    complain(name, words_problem<E>());
  }
  bool was_asked(const nlohmann::json& value) const;

  const nlohmann::json& object_;
  const std::string pointer_;
  const Place where_;
  Problems own_;
  Problems& problems_;
  // The members that were asked for, by their addresses. The largest item has nine.
  std::array<const nlohmann::json*, 12> asked_{};
  std::size_t asked_count_ = 0;
  std::vector<const nlohmann::json*> more_asked_;
  bool all_known_ = false;
};

}  // namespace roverd::mission
