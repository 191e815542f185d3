#pragma once
// The device side of the twist protocol (text form) for an Arduino-class board. Plain C++ without
// heap, exceptions or library: copy it, and connect the three functions at the end to the board.
// It shares no line with the driver: the test lets the two talk to each other.

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct TwistDevice {
  // What the motors shall do now; set by loop().
  float speed_mps = 0;
  float turn_radps = 0;
  // What the board measures; set them before loop().
  float left_m = 0, right_m = 0, battery_v = 0;
  bool estop = false;

  // Private from here on.
  char line[96];
  uint8_t used = 0;
  uint8_t seq = 0, ack = 0;
  bool enable = false;
  uint32_t heard_ms = 0, said_ms = 0;
  bool ever_heard = false;

  static uint8_t sum(const char* text, const char* end) {
    uint8_t s = 0;
    while (text != end) s = (uint8_t)(s ^ (uint8_t)*text++);
    return s;
  }

  /// Every byte that arrives: Serial.read().
  void byte_in(char c, uint32_t now_ms) {
    if (c == '$') used = 0;
    if (c == '\n') {
      line[used] = 0;
      take(now_ms);
      used = 0;
    } else if (used < sizeof line - 1) {
      line[used++] = c;
    }
  }

  void take(uint32_t now_ms) {
    char* star = strchr(line, '*');
    if (strncmp(line, "$RVC,", 5) != 0 || star == NULL) return;
    if (strtoul(star + 1, NULL, 16) != sum(line + 1, star)) return;
    char* at = line + 5;
    const uint8_t number = (uint8_t)strtoul(at, &at, 10);
    const float speed = (float)strtod(at + 1, &at);
    const float turn = (float)strtod(at + 1, &at);
    enable = strtoul(at + 1, &at, 10) == 1 && !estop;
    if (at != star) return;
    ack = number;
    speed_mps = enable ? speed : 0;
    turn_radps = enable ? turn : 0;
    heard_ms = now_ms;
    ever_heard = true;
  }

  /// Watchdog and feedback; call it as often as possible. @return bytes of `out` to send, often 0.
  int loop(uint32_t now_ms, char* out, int size) {
    const bool late = !ever_heard || now_ms - heard_ms > 300;
    if (late || estop) {
      speed_mps = turn_radps = 0;
      enable = false;
    }
    if (now_ms - said_ms < 50) return 0;
    said_ms = now_ms;
    const unsigned status = (enable ? 1u : 0u) | (late ? 2u : 0u);
    int n = snprintf(out, (size_t)size, "$RVF,%u,%u,%.3f,%.3f,%.3f,%.3f,%.2f,%u,%u", seq++, ack,
                     (double)speed_mps, (double)turn_radps, (double)left_m, (double)right_m,
                     (double)battery_v, status, estop ? 1u : 0u);
    return n + snprintf(out + n, (size_t)(size - n), "*%02X\r\n", sum(out + 1, out + n));
  }
};
