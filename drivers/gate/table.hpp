#pragma once
// The words in which a vehicle is told to the gate. A table is all that the gate knows of one
// protocol; gate/vehicles.hpp has them all. Values only.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace roverd::gate {

/// What one byte may hold.
struct Byte {
  std::uint8_t least = 0;
  std::uint8_t most = 0;
};
inline constexpr Byte kZero{0, 0};
inline constexpr Byte kAny{0, 255};
constexpr Byte is(std::uint8_t value) noexcept {
  return {value, value};
}
constexpr Byte up_to(std::uint8_t most) noexcept {
  return {0, most};
}

/// What seals a message.
enum class Check {
  None,
  Sum,    ///< last byte: sum of both bytes of the id, the length and all bytes before
  Crc16,  ///< last two bytes, low one first: CRC-16/CCITT-FALSE of all from the third byte on
  Xor,    ///< text: "*HH", the exclusive or of what stands between the first character and the star
};

/// Bytes, each with what it may hold; exactly so many.
struct Layout {
  static constexpr std::size_t kLongest = 12;
  Layout() = default;
  template <std::size_t N>
  constexpr Layout(const Byte (&list)[N], Check seal = Check::None) : size(N), check(seal) {
    static_assert(N <= kLongest);
    for (std::size_t i = 0; i < N; ++i) byte[i] = list[i];
  }
  std::array<Byte, kLongest> byte{};
  std::size_t size = 0;
  Check check = Check::None;
};

/// A line of decimal numbers: begins, numbers with separators, seal, ends.
struct Text {
  std::string_view begins;
  char separator = ',';
  std::size_t numbers = 0;
  Check check = Check::None;
  std::string_view ends;
};

/// How a number stands in a message.
enum class Form { U8, I8, I16Big, I16Little, F32Big, Decimal };

struct Field {
  std::size_t at = 0;  ///< first byte; in a text the number's place, from 0
  Form form = Form::U8;
  double per_unit = 1.0;  ///< wire steps in one unit of the limits
};

/// A speed, or what else moves the vehicle: turn rate, wheel angle, ratio. Steps count only while
/// it grows away from zero: to slow down is always allowed, to reverse counts from zero.
struct Value {
  Field field;
  double max = 0.0;       ///< largest magnitude
  double max_step = 0.0;  ///< largest growth from one message to the next
  bool holds = false;     ///< a wheel angle: may stand in a stop; each change is a step, both ways
};

/// A field by which a motion message chooses what the vehicle does.
struct Mode {
  Field field;
  int drives = 1;  ///< this value lets it move; with every other one all speeds are zero
  int most = 255;  ///< of a text's number; bytes have their own range
  /// Zero speed in the driving mode asks the vehicle to go over to it, and is a stop once it has.
  /// Otherwise such a message counts as motion.
  bool zero_asks = false;
};

/// The one message of a protocol that moves the vehicle. All values zero, and not in the driving
/// mode if there is one: a stop, which always leaves.
struct Motion {
  std::uint32_t id = 0;  ///< of a CAN frame; 0 for messages of other links
  Layout bytes{};
  std::optional<Text> text = {};  ///< in place of bytes
  std::array<Value, 2> values;
  std::optional<Mode> mode = {};  ///< none: what is not zero moves
  std::optional<std::size_t> asks_at =
      {};                     ///< a byte that makes a request of it, unless it is zero
  double min_period_s = 0.0;  ///< between requests
  double forgets_s = 0.5;     ///< after so long a silence the vehicle stands: steps from zero
};

/// A message that moves nothing.
struct Request {
  std::uint32_t id = 0;
  Layout bytes = {};
  bool zero_stops = false;  ///< all bytes zero: always leaves
  bool to_drive = false;    ///< asks for the driving mode: only while the vehicle says standby
  double min_period_s = 0.0;
};

enum class Need { Always, OnceHeard };

/// What the vehicle says of itself: bytes 0 and 1 of a message that must arrive.
struct State {
  std::uint8_t normal = 0;
  std::uint8_t standby = 0;  ///< takes requests to drive
  std::uint8_t drives = 1;   ///< obeys motion
};

/// What must have arrived lately for anything to move.
struct Feedback {
  std::uint32_t id = 0;  ///< 0: the driver vouches for it
  std::uint8_t len = 8;  ///< at least
  Check check = Check::None;
  double max_age_s = 0.0;
  std::optional<State> state = {};
  Need need = Need::Always;
};

struct Table {
  std::string_view name;
  Motion motion;
  std::vector<Request> requests = {};
  std::vector<Feedback> feedback = {};
};

}  // namespace roverd::gate
