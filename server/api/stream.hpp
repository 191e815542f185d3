#pragma once
// The live stream's texts: hello, subscriptions, teleoperation, the stop, errors.
//
// One client at a time drives: the first who sends a drive message with the dead-man's switch held,
// until it lets go, leaves, or is silent for half a second. Who that is, and whether a stick may
// act at all, the robot decides (robot/modes/manual.hpp); what it refuses is told to the client.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/context.hpp"

namespace roverd::api {

/// {"topic", "seq", "time", "mono_s", "data"} around a JSON text.
std::string stream_text(std::string_view topic, std::uint64_t seq, std::string_view data);

class StreamTexts {
 public:
  StreamTexts(ContextPtr context, Stream stream);

  /// @param who empty: nobody is known, or access control is off
  void on_client(ClientId client, std::optional<people::Who> who, const std::string& address);
  /// Who is not let in any more is closed.
  void look_at_people();
  /// @param begun when its first byte was there
  void on_text(ClientId client, base::Time begun, std::string_view text);
  void on_gone(ClientId client);
  int streams_of(const std::string& user) const;
  /// That one has a stream open.
  bool is_linked(const people::Driver& who) const;
  /// Everybody who has one open, by name; a person with several pages once.
  std::vector<Present> present() const;
  /// Tells everyone; sticks of those who do not hold control any more are dropped.
  void control_changed(const Control::Notice& notice);

  void publish_event(const base::Event& event);
  void publish_mission(const std::string& id, std::optional<std::int64_t> revision);
  /// Publishes if something worth a message changed since the last time.
  void look_at_execution();

 private:
  struct Client {
    std::optional<people::Who> who{};
    std::string address{};
    int complaints = 0;  ///< in a row
    std::uint64_t errors_sent = 0;
    std::optional<std::int64_t> drive_seq;
    bool watches = false;   ///< the vehicle
    bool drives = false;    ///< it held the dead-man's switch in its last drive message
    bool at_stick = false;  ///< the robot heard of its stick
    bool at_speed = false;  ///< and of its hand on the speed of what drives by itself
    std::optional<people::Driver> driver{};
    base::Time refused_at;    ///< told so, last
    std::string refused_why;  ///< with that
  };

  bool may(ClientId id, Client& client, const Json& message);
  base::Result<void> read(ClientId id, Client& client, const Json& message, base::Time begun);
  base::Result<void> subscribe(ClientId id, Client& client, const Json& topics);
  base::Result<void> drive(ClientId id, Client& client, Members& message, base::Time begun);
  base::Result<void> take_wheel(ClientId id, const robot::Command& command,
                                const robot::Validity& validity);
  void let_go(const Client& client, const robot::Drive& command);
  base::Result<void> throttle(ClientId id, Client& client, Members& message, base::Time begun);
  void drop_speed(ClientId id, Client& client);
  void drive_refused(ClientId id, const base::Error& error);
  void estop(ClientId id, const Client& client);
  void confirm_estop(ClientId id);
  base::Result<void> halt(const robot::Command& command);
  void answer_ping(ClientId id, double ping);
  void stop_driving(ClientId id, Client& client);
  void drop_stick(ClientId id, Client& client);
  void without_control(ClientId id, Client& client);
  void tell_control(ClientId id);
  void tell_robot(const Client& client);
  void complain(ClientId id, Client& client, const base::Error& error);
  std::optional<std::string> vehicle_text(std::uint64_t seq);
  void add_seen_topics();

  ContextPtr context_;
  Stream stream_;
  std::unordered_map<ClientId, Client> clients_;
  std::uint64_t encoded_tick_ = 0;
  std::string encoded_;  ///< the vehicle's state at that tick
  std::string execution_seen_;
  base::Time operator_told_;  ///< that one is there
  std::shared_ptr<StreamTexts*> self_ = std::make_shared<StreamTexts*>(this);  ///< for late answers
};

}  // namespace roverd::api
