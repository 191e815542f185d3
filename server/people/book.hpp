#pragma once
// The book of users, sessions, tokens and devices: who is it that asks, and what may they do. Pure
// but for chance: time is an argument, passwords are hashed elsewhere (they take long), rows are
// kept elsewhere (take_change). One thread at a time.
//
//   log-in:  login_wait ─▶ begin_login ─▶ (is_password, beside) ─▶ end_login ─▶ a cookie
//   PIN:     login_wait ─▶ begin_pin ─▶ (is_password, beside) ─▶ end_pin ─▶ a cookie
//   request: by_session or by_token ─▶ Who
//
// A session lives by the monotonic clock: wall time that jumps neither ends nor lengthens it. One
// from before this start is judged by the wall clock when that is known; until then it opens
// nothing. A token that expires opens nothing while the time is not known.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/result.hpp"
#include "people/backoff.hpp"
#include "people/words.hpp"

namespace roverd::people {

struct Now {
  base::Time mono;
  base::WallTime wall;  ///< before base::kYoungest: not known
};

/// Somebody who showed a cookie or a token.
struct Who {
  enum class By { Session, Token };
  std::string user;
  Role role = Role::Viewer;
  By by = By::Session;
  std::string id;                      ///< of the session or token
  std::vector<std::string> methods{};  ///< of a token; empty: all
  bool may(std::string_view method) const;
};

/// A log-in whose password is being compared.
struct Attempt {
  std::string user;
  std::string address;
  std::string hash;
};

/// A PIN that is being compared. It counted as wrong when it began.
struct PinAttempt {
  std::string device;
  std::string address;
  std::string hash;
};

/// What a one-time code is good for.
struct Invitation {
  std::string inviter;
  std::string user;  ///< whose device it will be
  Role role = Role::Viewer;
  std::uint64_t number = 0;  ///< filled in by the book
};

/// The secret is told once.
template <class T>
struct Opened {
  std::string secret;
  T row;
};

class Book {
 public:
  static constexpr std::size_t kUsers = 100;
  static constexpr std::size_t kSessionsEach = 20;
  static constexpr std::size_t kTokens = 200;
  static constexpr std::size_t kDevicesEach = 10;
  /// So many wrong PINs, and the device wants the password or a new pairing.
  static constexpr int kWrongPins = 5;
  /// A device that is not used so long is paired no more.
  static constexpr base::Duration kPaired = std::chrono::hours(24 * 365);
  static constexpr base::Duration kInvited = std::chrono::minutes(10);
  static constexpr base::Duration kIdle = std::chrono::hours(12);
  static constexpr base::Duration kAbsolute = std::chrono::hours(24 * 7);
  /// How often "seen" is written.
  static constexpr base::Duration kKeepSeen = std::chrono::minutes(1);

  /// What was kept. Before it, nobody is let in.
  void load(Everybody kept, Now now);
  bool loaded() const noexcept { return loaded_; }

  // The first admin.
  /// Nobody can log in yet.
  bool needs_setup() const noexcept { return loaded_ && users_.empty(); }
  /// A new code; the one before it is dead.
  std::string make_code();
  /// @return the one-time code is this; counts as a try. It dies in add_user.
  bool is_code(std::string_view typed, const std::string& address, Now now);

  // Log-in.
  /// Zero: may try.
  base::Duration login_wait(const std::string& user, const std::string& address, Now now) const;
  Attempt begin_login(const std::string& user, const std::string& address, Now now);
  /// Empty: wrong password, no such user, or the password was changed in between.
  std::optional<Opened<Session>> end_login(const Attempt& attempt, bool right,
                                           const std::string& device, Now now);

  /// The password was right, but nobody comes in by it.
  void clear_login(const Attempt& attempt);

  // Who is it?
  std::optional<Who> by_session(std::string_view secret, Now now);
  std::optional<Who> by_token(std::string_view secret, Now now);
  /// Still, with the role of now. Does not count as being seen.
  std::optional<Who> still(const Who& who, Now now);

  // Users. Errors: Conflict (name taken, too many, the last admin), NotFound.
  base::Result<void> add_user(const std::string& name, Role role, std::string password_hash,
                              Now now);
  /// A new password ends all of the user's sessions but `keep`, all pairings but `keep_device`, and
  /// the invitation.
  base::Result<void> change_user(const std::string& name, std::optional<Role> role,
                                 std::optional<std::string> password_hash,
                                 const std::string& keep = {}, const std::string& keep_device = {});
  base::Result<void> remove_user(const std::string& name);
  const std::vector<User>& users() const noexcept { return users_; }
  const User* user(std::string_view name) const noexcept;

  // Sessions.
  std::vector<Session> sessions_of(const std::string& user) const;
  /// NotFound: that user has none of this id.
  base::Result<void> end_session(const std::string& user, const std::string& id);

  /// All but `keep`. @return how many
  std::size_t end_other_sessions(const std::string& user, const std::string& keep);

  // Paired devices. Conflict: too many; NotFound: no such user.
  /// @param replaced the secret of what that browser was before: that pairing ends. @param session
  /// of the caller, which goes on as the new device's if it was that one's.
  base::Result<Opened<Device>> pair(Device wanted, std::string_view replaced,
                                    const std::string& session, Now now);
  /// Conflict: `user` has as many as there may be.
  base::Result<void> may_pair(const std::string& user) const;
  /// Null: paired no more, or never. Opens nothing.
  const Device* by_device(std::string_view secret, Now now) const;
  std::vector<Device> devices_of(const std::string& user) const;
  /// With its sessions.
  base::Result<void> end_device(const std::string& user, const std::string& id);
  static bool is_locked(const Device& device) noexcept { return device.wrong >= kWrongPins; }
  /// Its user logged in with the password there.
  void unlock(std::string_view secret, const std::string& user, Now now);

  /// Zero: may try.
  base::Duration pin_wait(const Device& device, const std::string& address, Now now) const;
  /// Of a device that is not locked. Keep what changed before the PIN is compared: a restart then
  /// gives no tries back.
  PinAttempt begin_pin(const Device& device, const std::string& address, Now now);
  /// Empty: wrong, or the device is gone or got another PIN in between.
  std::optional<Opened<Session>> end_pin(const PinAttempt& attempt, bool right, Now now);

  // Invitations: one for each inviter, in memory only.
  /// A new code; the inviter's one before it is dead.
  std::string invite(Invitation invitation, Now now);
  /// Its code is used up by that. Counts as a try, see login_wait with no user. Empty: no such
  /// code, or it is over.
  std::optional<Invitation> take_invitation(std::string_view typed, const std::string& address,
                                            Now now);
  /// Of one that was taken, once, when the device is about to be paired: it is still good. Not so
  /// if meanwhile whoever invited was sent away, lost the right to, or ended what they invited
  /// from.
  bool end_invitation(const Invitation& taken, Now now);

  // Tokens. Conflict: too many.
  base::Result<Opened<Token>> add_token(Token wanted, Now now);
  /// Of one user; empty: of all.
  std::vector<Token> tokens_of(const std::string& user) const;
  base::Result<void> end_token(const std::string& user, const std::string& id);

  /// Forgets who is expired; once a second or less often.
  void sweep(Now now);
  /// What has to be kept, since the last time.
  Change take_change();

 private:
  struct Live {
    Session row;
    base::Time begun{};
    base::Time seen{};
    base::Time kept{};     ///< its row
    bool earlier = false;  ///< from before this start, and not judged yet
  };
  struct Invited {
    Invitation invitation;
    std::string hash;  ///< of its code; empty: it was taken
    base::Time over{};
  };
  struct Shown {
    Token row;
    base::Time kept{};
  };
  enum class State { Good, Unknown, Over };

  State judge(Live& live, Now now);
  State judge(const Token& token, Now now) const;
  void see(Live& live, Now now);
  std::optional<Who> who_of(const Live& live) const;
  std::optional<Who> who_of(const Token& token) const;
  bool was_here(const std::string& user, const std::string& address) const;
  std::string door_of(const std::string& user, const std::string& address) const;
  void tried(const std::string& door, const std::string& address, Now now);
  void tried_rightly(const std::string& door, const std::string& address);
  Opened<Session> open_session(const std::string& user, const std::string& address,
                               const std::string& device, Now now, const std::string& paired = {});
  User* find(std::string_view name) noexcept;
  Device* find_device(std::string_view id) noexcept;
  bool is_last_admin(const User& user) const noexcept;
  void drop_sessions(const std::function<bool(const Live&)>& which);
  void drop_tokens(const std::function<bool(const Token&)>& which);
  void drop_devices(const std::function<bool(const Device&)>& which);
  void drop_invitations(const std::string& of);
  bool may_invite(const Invitation& invitation) const noexcept;
  void keep(const Device& device);

  bool loaded_ = false;
  std::string code_;
  std::vector<User> users_;
  std::vector<Live> sessions_;
  std::vector<Shown> tokens_;
  std::vector<Device> devices_;
  std::vector<Invited> invited_;
  std::uint64_t invitations_ = 0;  ///< made so far
  /// Short, or somebody in the network could lock people out; addresses may wait longer.
  Backoff users_wait_{std::chrono::seconds(30), 256};
  Backoff addresses_wait_{std::chrono::minutes(5), 1024};
  /// Of the /64 of IPv6 from which somebody may come under ever other addresses, and in which
  /// others live, too: not for long, and only whoever has not been here from their address.
  Backoff networks_wait_{std::chrono::seconds(30), 256, 4 * Backoff::kFree};
  Change change_;
};

}  // namespace roverd::people
