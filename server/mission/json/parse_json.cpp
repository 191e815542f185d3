// Text to JSON values with a bound on depth: nlohmann's parser feeds us event by event, so that a
// body of a million brackets costs no stack, and so that the place of an error is known.

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <utility>

#include "mission/json/json.hpp"
#include "mission/json/pointer.hpp"

namespace roverd::mission {
namespace {

using base::Code;
using base::Error;
using nlohmann::json;

/// The library's own destructor lists all values before it frees them: without memory for that list
/// it would end the program. From the leaves up it needs none.
void dismantle(json& value) noexcept {
  if (auto* array = value.get_ptr<json::array_t*>()) {
    for (json& one : *array) dismantle(one);
    array->clear();
  } else if (auto* object = value.get_ptr<json::object_t*>()) {
    for (auto& member : *object) dismantle(member.second);
    object->clear();
  }
}

/// Builds the value. Each level remembers the container it fills and, for objects, the key whose
/// value comes next.
class Builder {
 public:
  Builder() = default;
  ~Builder() { dismantle(root_); }
  Builder(const Builder&) = delete;
  Builder& operator=(const Builder&) = delete;

  using number_integer_t = json::number_integer_t;
  using number_unsigned_t = json::number_unsigned_t;
  using number_float_t = json::number_float_t;
  using string_t = json::string_t;
  using binary_t = json::binary_t;

  bool null() { return put(nullptr); }
  bool boolean(bool value) { return put(value); }
  bool number_integer(number_integer_t value) { return put(value); }
  bool number_unsigned(number_unsigned_t value) { return put(value); }
  bool number_float(number_float_t value, const string_t&) { return put(value); }
  bool string(string_t& value) { return put(std::move(value)); }
  bool binary(binary_t&) { return false; }  // not in JSON text
  bool start_object(std::size_t) { return open(json::object()); }
  bool start_array(std::size_t) { return open(json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(string_t& name) {
    levels_.back().key = std::move(name);
    if (!levels_.back().container->contains(levels_.back().key)) return true;
    error_ = {Code::Invalid, here() + " is there twice", {{here(), "is there twice"}}};
    return false;
  }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& problem) {
    const std::size_t byte = position > 0 ? position - 1 : 0;
    constexpr int kNumberOverflow = 406;
    if (problem.id == kNumberOverflow) {
      const std::string detail = "must be a number that fits a double, is " + shortened(token);
      error_ = {Code::Invalid, here() + " " + detail, {{here(), detail}}};
    } else {
      error_ = {Code::Malformed,
                "not JSON at byte " + std::to_string(byte) + ": " + reason(problem.what()),
                {{"byte " + std::to_string(byte), reason(problem.what())}}};
    }
    return false;
  }

  json take() { return std::move(root_); }
  /// Is there memory for the list that its destructor makes, later and elsewhere?
  bool may_be_freed() const noexcept {
    constexpr std::size_t kSmall = 1 << 20;
    return bytes_ < kSmall || std::unique_ptr<char[]>(new (std::nothrow) char[bytes_]) != nullptr;
  }
  Error error() { return std::move(error_); }

 private:
  struct Level {
    json* container;
    std::string key;
  };

  json* place(json&& value) {
    if (levels_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Level& level = levels_.back();
    if (level.container->is_array()) {
      level.container->push_back(std::move(value));
      return &level.container->back();
    }
    return &level.container->emplace(level.key, std::move(value)).first.value();
  }

  bool put(json&& value) {
    if (!has_room(sizeof(json))) return false;
    place(std::move(value));
    return true;
  }

  /// Text of two bytes a value becomes a value of a hundred: what a document takes in memory is
  /// bounded, not only its length. `bytes` is about right, with the allocator's own.
  bool has_room(std::size_t bytes) {
    constexpr std::size_t kMember = 112;  // of a map, with its key
    const bool named = !levels_.empty() && levels_.back().container->is_object();
    bytes_ += bytes + (named ? kMember : 0);
    if (bytes_ <= kMaxJsonMemory) return true;
    error_ = {Code::TooLarge, "has more values than there is memory for", {}};
    return false;
  }

  bool open(json&& container) {
    if (levels_.size() >= kMaxJsonDepth) {
      error_ = {
          Code::Malformed, "nested deeper than " + std::to_string(kMaxJsonDepth) + " levels", {}};
      return false;
    }
    constexpr std::size_t kContainer = 80;
    if (!has_room(kContainer)) return false;
    levels_.push_back({place(std::move(container)), {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  /// Pointer of the value that is being read. The containers around it are in their parents
  /// already, it is not.
  std::string here() const {
    std::string pointer;
    for (const Level& level : levels_) {
      const std::size_t open = &level == &levels_.back() ? 0 : 1;
      pointer += '/';
      pointer += level.container->is_array() ? std::to_string(level.container->size() - open)
                                             : escaped_key(level.key);
    }
    return pointer;
  }

  /// The library's message without its own name and number: "line 1, column 3: syntax error …".
  /// Bytes that are not printable ASCII are shown as '?', so the answer is always valid text.
  static std::string reason(std::string_view what) {
    const std::size_t at = what.find("at line");
    std::string text(at == std::string_view::npos ? what : what.substr(at + 3));
    return shortened(text);
  }

  static std::string shortened(std::string_view text) {
    constexpr std::size_t kMax = 200;
    std::string out(text.substr(0, kMax));
    std::replace_if(
        out.begin(), out.end(), [](char c) { return c < 0x20 || c > 0x7E; }, '?');
    if (text.size() > kMax) out += "...";
    return out;
  }

  json root_;
  std::vector<Level> levels_;
  std::size_t bytes_ = 0;
  Error error_;
};

}  // namespace

base::Result<json> parse_json(std::string_view text) {
  Builder builder;
  try {
    const bool read = json::sax_parse(text.begin(), text.end(), &builder);
    if (read && builder.may_be_freed()) return builder.take();
    if (read) throw std::bad_alloc();
  } catch (const std::bad_alloc&) {
    return base::fail(Code::Unavailable, "there is no memory for all its values now");
  } catch (const std::exception& problem) {
    return base::fail(Code::Malformed, std::string("not JSON: ") + problem.what());
  }
  return tl::unexpected<Error>(builder.error());
}

}  // namespace roverd::mission
