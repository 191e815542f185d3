#pragma once
// GSV sentences to whole groups: the satellites of one system and signal. Groups of different
// talkers and signals may interleave, so each has its own slot; a group with a missing sentence is
// dropped. Pure state, bounded.

#include <array>
#include <optional>

#include "gnss/sentence.hpp"

namespace roverd::gnss {

struct SatelliteGroup {
  Talker talker{};
  std::optional<int> signal{};
  int in_view = 0;
  std::array<Satellite, 36> sats{};
  std::size_t used = 0;
};

class GsvAssembler {
 public:
  /// @return the group when its last sentence came.
  std::optional<SatelliteGroup> add(const Gsv& s) noexcept {
    Slot& slot = slot_of(s);
    if (s.index == 1) {
      slot.group = {.talker = s.talker, .signal = s.signal, .in_view = s.in_view};
      slot.total = s.total;
    } else if (slot.next != s.index || slot.total != s.total) {
      slot.next = 0;
      return std::nullopt;
    }
    for (std::size_t i = 0; i < s.used; ++i) slot.group.sats[slot.group.used++] = s.sats[i];
    slot.next = s.index + 1;
    if (s.index < s.total) return std::nullopt;
    slot.next = 0;
    return slot.group;
  }

 private:
  struct Slot {
    SatelliteGroup group{};
    int total = 0;
    int next = 0;  ///< the number awaited; 0: none
  };

  Slot& slot_of(const Gsv& s) noexcept {
    for (Slot& slot : slots_) {
      if (slot.total != 0 && slot.group.talker == s.talker && slot.group.signal == s.signal) {
        return slot;
      }
    }
    // A new talker or signal takes the slots in turn; receivers use fewer than there are.
    Slot& slot = slots_[turn_++ % slots_.size()];
    slot = {};
    slot.group.talker = s.talker;
    slot.group.signal = s.signal;
    return slot;
  }

  std::array<Slot, 24> slots_{};
  std::size_t turn_ = 0;
};

}  // namespace roverd::gnss
