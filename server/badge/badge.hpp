#pragma once
// By what people tell this robot from the others in a network: name, colour, picture. Pure.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.hpp"

namespace roverd::badge {

/// White letters stand out on each of them (WCAG: at least 4.5 to 1). None is the red of STOP.
struct Colour {
  std::string_view name;
  std::string_view rgb;  ///< "#0b57d0"
};
inline constexpr std::array<Colour, 10> kColours{{{"blue", "#0b57d0"},
                                                  {"green", "#146c2e"},
                                                  {"purple", "#6a1b9a"},
                                                  {"brown", "#7a4a16"},
                                                  {"teal", "#00696d"},
                                                  {"pink", "#ad1457"},
                                                  {"olive", "#5c6300"},
                                                  {"navy", "#1a2f6e"},
                                                  {"slate", "#455a64"},
                                                  {"black", "#1f1f1f"}}};

inline constexpr std::size_t kLongestName = 40;  ///< bytes

/// Error Invalid: a name that is no line of text, or too long.
base::Result<void> check_name(std::string_view name);
/// Empty: chosen by the name, always the same for one name. Error Invalid: none of the list.
base::Result<Colour> colour_of(std::string_view said, std::string_view name);

/// As DNS knows it, without ".local": "Põllu robot 2" is "pollu-robot-2". Never empty, at most 50
/// characters.
std::string label_of(std::string_view name);
/// One or two letters: "north field" is "NF", "kask" is "KA", "Kask 2" is "K2".
std::string initials_of(std::string_view name);

struct Picture {
  std::string bytes;
  std::string_view content_type;
  std::string_view path;  ///< where it is served: "/robot.png"
};
/// What kind it is, its first bytes tell: PNG, JPEG or WebP. Error Invalid: something else.
base::Result<Picture> picture_of(std::string bytes);

struct Badge {
  std::string name;
  Colour colour = kColours.front();
  std::shared_ptr<const Picture> picture{};  ///< null: none was given
};

/// The initials on the colour.
std::string svg_of(const Badge& badge);
/// Where its picture is served; without one the drawn badge.
std::string_view picture_path(const Badge& badge) noexcept;

struct File {
  std::string_view content_type;
  std::string body;
};
/// What a page that is put on a phone's home screen is called there, and looks like.
std::string manifest_of(const Badge& badge);
/// /robot.svg, the picture where there is one, and /roverd.webmanifest. Empty: none of them.
std::optional<File> file_at(std::string_view path, const Badge& badge);

}  // namespace roverd::badge
