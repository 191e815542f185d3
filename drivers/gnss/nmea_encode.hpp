#pragma once
// Typed sentences to NMEA 0183 lines, for simulated receivers. Every line ends with CR LF. Empty
// optionals become empty fields. What decode gives for an encoded sentence is the same up to the
// printed decimals. Pure; may allocate the string.

#include <string>
#include <string_view>

#include "gnss/sentence.hpp"

namespace roverd::gnss {

/// "$" + body + "*hh\r\n".
std::string line(std::string_view body);

/// @param decimals of a minute of arc, 4..9; 7 is 0.2 mm.
std::string encode(const Gga& s, int decimals = 7);
std::string encode(const Rmc& s, int decimals = 7);
/// New form, knots and km/h; an empty speed_kmh is computed from speed_kn.
std::string encode(const Vtg& s);
std::string encode(const Gsa& s);
std::string encode(const Gsv& s);
std::string encode(const Gst& s);
std::string encode(const Hdt& s);
std::string encode(const Ths& s);
std::string encode(const Zda& s);

}  // namespace roverd::gnss
