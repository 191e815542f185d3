#include "gate/vehicles.hpp"

namespace roverd::gate {

namespace {

Value value(const Field& field, double max, double max_step, bool holds = false) {
  return {field, max, max_step, holds};
}

constexpr double kMessagesForgotten_s = 0.6;

}  // namespace

// clang-format off
std::vector<Table> bunker(const BunkerLimits& l) {
  return {
    {.name = "bunker, protocol V2",
     //                      linear      angular     sideways      steering
     .motion = {.id = 0x111, .bytes = {{kAny, kAny, kAny, kAny, kZero, kZero, kZero, kZero}},
                .values = {value({0, Form::I16Big}, l.max_linear, l.max_linear_step),
                           value({2, Form::I16Big}, l.max_angular, l.max_angular_step)}},
     .requests = {
       // Standby or CAN mode; 2 (serial) is nobody's business. A base asked for CAN mode while its
       // radio drives flips between the two and can latch a fault.
       {.id = 0x421, .bytes = {{up_to(1), kZero, kZero, kZero, kZero, kZero, kZero, kZero}},
        .zero_stops = true, .to_drive = true, .min_period_s = 0.45},
       // Clears errors.
       {.id = 0x441, .bytes = {{up_to(2), kZero, kZero, kZero, kZero, kZero, kZero, kZero}}, .min_period_s = 0.1},
       // Lights: switch, mode and brightness twice, a count.
       {.id = 0x121, .bytes = {{up_to(1), up_to(3), up_to(100), up_to(3), up_to(100), kZero, kZero, kAny}},
        .min_period_s = 0.015},
       // Asks for the firmware's version, in the two forms.
       {.id = 0x4A1, .bytes = {{up_to(1)}}, .min_period_s = 0.45},
       {.id = 0x411, .bytes = {{up_to(1)}}, .min_period_s = 0.45}},
     .feedback = {{.id = 0x221, .max_age_s = l.motion_max_age_s},
                  {.id = 0x211, .max_age_s = l.state_max_age_s, .state = State{}}}},
    {.name = "bunker, protocol V1",
     // Mode, error to clear, percent ahead and around, sideways, spare, count, sum. Mode 0 is the
     // radio's.
     .motion = {.id = 0x130,
                .bytes = {{up_to(1), up_to(8), kAny, kAny, kZero, kZero, kAny, kAny}, Check::Sum},
                .values = {value({2, Form::I8}, l.max_linear_pct, l.max_linear_step_pct),
                           value({3, Form::I8}, l.max_angular_pct, l.max_angular_step_pct)},
                .mode = Mode{.field = {0, Form::U8}, .zero_asks = true}, .asks_at = 1, .min_period_s = 0.45},
     .requests = {
       {.id = 0x140,
        .bytes = {{up_to(1), up_to(3), up_to(100), up_to(3), up_to(100), kZero, kAny, kAny}, Check::Sum},
        .min_period_s = 0.015}},
     .feedback = {{.id = 0x131, .check = Check::Sum, .max_age_s = l.motion_max_age_s},
                  {.id = 0x151, .check = Check::Sum, .max_age_s = l.state_max_age_s,
                   .state = State{}}}}};
}

std::vector<Table> ackermann(const Limits& l, bool feedback_required) {
  return {
    {.name = "ackermann",
     .motion = {.bytes = {{is(0x10), kAny, kAny, kAny, kAny, is(0x20), kAny, kAny, kAny, kAny, is(0x30), {1, 3}}},
                .values = {value({1, Form::F32Big}, l.max_speed, l.max_speed_step),
                           value({6, Form::F32Big}, l.max_turn, l.max_turn_step, true)},
                .mode = Mode{.field = {11, Form::U8}, .drives = 2}, .forgets_s = kMessagesForgotten_s},
     .feedback = {{.len = 0, .max_age_s = l.feedback_max_age_s,
                   .need = feedback_required ? Need::Always : Need::OnceHeard}}}};
}

std::vector<Table> twist_text(const Limits& l) {
  return {
    {.name = "twist, text",  // count, speed, turn, enable
     .motion = {.text = Text{"$RVC,", ',', 4, Check::Xor, "\r\n"},
                .values = {value({1, Form::Decimal}, l.max_speed, l.max_speed_step),
                           value({2, Form::Decimal}, l.max_turn, l.max_turn_step)},
                .mode = Mode{.field = {3, Form::Decimal}, .most = 1}, .forgets_s = kMessagesForgotten_s},
     .feedback = {{.len = 0, .max_age_s = l.feedback_max_age_s}}}};
}

std::vector<Table> twist_binary(const Limits& l) {
  return {
    {.name = "twist, binary",  // two marks, type 1, length 6, count, speed, turn, enable, CRC
     .motion = {.bytes = {{is(0xA5), is(0x5A), is(1), is(6), kAny, kAny, kAny, kAny, kAny, up_to(1), kAny, kAny},
                          Check::Crc16},
                .values = {value({5, Form::I16Little, 1000.0}, l.max_speed, l.max_speed_step),
                           value({7, Form::I16Little, 1000.0}, l.max_turn, l.max_turn_step)},
                .mode = Mode{.field = {9, Form::U8}}, .forgets_s = kMessagesForgotten_s},
     .feedback = {{.len = 0, .max_age_s = l.feedback_max_age_s}}}};
}

std::vector<Table> ratio(const Limits& l) {
  return {
    {.name = "ratio",
     .motion = {.text = Text{"", ' ', 2, Check::None, "\n"},
                .values = {value({0, Form::Decimal}, l.max_speed, l.max_speed_step),
                           value({1, Form::Decimal}, l.max_turn, l.max_turn_step)},
                .forgets_s = kMessagesForgotten_s}}};
}
// clang-format on

}  // namespace roverd::gate
