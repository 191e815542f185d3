// Names of signals, by the receivers' numbers for systems and signals.

#include <algorithm>
#include <array>

#include "ubx/messages.hpp"

namespace roverd::ubx {

std::string_view signal_name(int gnss_id, int signal_id) noexcept {
  struct Signal {
    int gnss_id;
    int signal_id;
    std::string_view name;
  };
  constexpr std::array kSignals{
      Signal{0, 0, "L1 C/A"},  Signal{0, 3, "L2 CL"},   Signal{0, 4, "L2 CM"},
      Signal{0, 6, "L5 I"},    Signal{0, 7, "L5 Q"},    Signal{1, 0, "L1 C/A"},
      Signal{2, 0, "E1 C"},    Signal{2, 1, "E1 B"},    Signal{2, 3, "E5a I"},
      Signal{2, 4, "E5a Q"},   Signal{2, 5, "E5b I"},   Signal{2, 6, "E5b Q"},
      Signal{2, 8, "E6 B"},    Signal{2, 9, "E6 C"},    Signal{2, 10, "E6 A"},
      Signal{3, 0, "B1I D1"},  Signal{3, 1, "B1I D2"},  Signal{3, 2, "B2I D1"},
      Signal{3, 3, "B2I D2"},  Signal{3, 4, "B3I D1"},  Signal{3, 5, "B1C P"},
      Signal{3, 6, "B1C D"},   Signal{3, 7, "B2a P"},   Signal{3, 8, "B2a D"},
      Signal{3, 10, "B3I D2"}, Signal{5, 0, "L1 C/A"},  Signal{5, 1, "L1 S"},
      Signal{5, 4, "L2 CM"},   Signal{5, 5, "L2 CL"},   Signal{5, 8, "L5 I"},
      Signal{5, 9, "L5 Q"},    Signal{5, 12, "L1 C/B"}, Signal{6, 0, "L1 OF"},
      Signal{6, 2, "L2 OF"},   Signal{7, 0, "L5 A"}};
  const auto found = std::ranges::find_if(
      kSignals, [&](const Signal& s) { return s.gnss_id == gnss_id && s.signal_id == signal_id; });
  return found == kSignals.end() ? std::string_view() : found->name;
}

}  // namespace roverd::ubx
