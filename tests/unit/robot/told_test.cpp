// What others found out (the host, the maps, the certificate) while the robot runs.

#include <string>
#include <thread>
#include <vector>

#include "field.hpp"

namespace roverd::robot {
namespace {

TEST(Told, WhatAnotherThreadFoundOutIsHeardOnceAndInOrderWhileTheLoopTellsItsOwn) {
  // Given a robot that ticks, and that has something of its own to tell at every word
  Field f;
  f.run(2.0);
  f.robot.wake = [] {};  // by both threads
  constexpr int kTold = 800;
  std::thread web([&] {
    for (int i = 0; i < kTold; ++i) {
      f.robot.tell({base::wall_now(), base::Severity::Info, "map_in_use", std::to_string(i)});
      (void)f.robot.request(i % 2 == 0 ? Command{Estop{"a script"}} : Command{ResetEstop{}},
                            Time::max(), {});
    }
  });
  // When somebody reads on along the way
  const auto heard = [&f] {
    f.tick();
    std::erase_if(f.events, [](const base::Event& e) { return e.kind != "map_in_use"; });
    return static_cast<int>(f.events.size());
  };
  for (int ticks = 0; ticks < 20'000 && heard() < kTold;) ++ticks;
  web.join();
  // Then each of it has come, as it was told
  ASSERT_EQ(heard(), kTold);
  for (int i = 0; i < kTold; ++i)
    ASSERT_EQ(f.events[static_cast<std::size_t>(i)].detail, std::to_string(i));
}

}  // namespace
}  // namespace roverd::robot
