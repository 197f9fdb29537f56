// Settings of the machine (window, text, sound, screens) and of each person who practises at it (hands, directions,
// hints): settings.json in the data folder. A file that is wrong somewhere costs only what is wrong: the faults are
// reported, the rest is used, and the program starts.
//
//   std::vector<core::Fault> faults;
//   Settings settings = read_settings(settings_file(), faults);   // a missing file: the defaults, no fault
//   write_settings(settings_file(), settings);                    // atomically: the old one or the new one
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/devices/mouse_keyboard.hpp>
#include <trocar/pictures/two_eyes.hpp>
#include <trocar/scene/json/json.hpp>

#include "shell/layout.hpp"

namespace trocar::app {

/// What each person has for himself or herself.
struct PersonSettings {
  bool left_handed = false;
  double mouse = 1, wheel = 1, keyboard = 1, gamepad = 1;  ///< sensitivities, 1 = usual, kLeastSense..kMostSense
  bool both_hands = false;                                 ///< two instruments are controlled at once
  bool invert_x = false, invert_y = false;                 ///< instrument: moves against the hand, as real handles do
  bool invert_view_x = false, invert_view_y = false;       ///< endoscope
  bool mirrored_picture = false;                           ///< left and right exchanged
  bool show_hint = true;                                   ///< the three things to know, before an attempt

  friend bool operator==(const PersonSettings&, const PersonSettings&) = default;
};

struct KnownPerson {
  std::string name;
  PersonSettings settings;
  friend bool operator==(const KnownPerson&, const KnownPerson&) = default;
};

/// The machine's, and the person's who is at it.
struct Settings : PersonSettings {
  std::string stereo = "off";                     ///< one of kStereoNames (two_eyes.hpp)
  double eye_distance = 4, convergence = 80;      ///< [mm] between the eyes; to what lies on the screen
  LayoutChoice views;                             ///< what the window's panes show, while nothing counts
  bool swap_eyes = false;                         ///< for screens that have them the other way round
  double volume = 0.7;                            ///< of sounds, 0..1
  bool force_trace = false, force_sound = false;  ///< the force on the led hand, drawn; heard
  bool rumble = true;                             ///< felt, where a gamepad has motors
  double text_size = 1;                           ///< times the display's own scale
  int window_width = 1280, window_height = 800;   ///< [px on an ordinary display]
  std::string trainee;                            ///< who is at the machine; empty: practises without a name
  std::vector<KnownPerson> others;                ///< everybody else, last first, at most kMostPeople

  friend bool operator==(const Settings&, const Settings&) = default;
};

inline constexpr double kLeastSense = 0.1, kMostSense = 5, kLeastText = 0.7, kMostText = 1.6;
inline constexpr double kMostTextEver = 2.5;  ///< in files of older versions; read as kMostText
inline constexpr std::size_t kMostPeople = 500;
inline constexpr int kLeastWidth = 640, kLeastHeight = 480, kMostPixels = 8192;

std::filesystem::path settings_file();  ///< data_folder()/settings.json

/// Everything that is right in the file, defaults for the rest. Never throws for what stands in it. With `memory` the
/// file is looked up there instead of on the disk.
Settings read_settings(const std::filesystem::path& file, std::vector<core::Fault>& faults,
                       const scene::MemoryFiles* memory = nullptr);
/// The file's text.
std::string settings_text(const Settings& settings);
/// Into a new file that then takes the old one's place.  @throws core::EnvironmentLacks
void write_settings(const std::filesystem::path& file, const Settings& settings);

/// The person at the machine changes: what the one before had is kept, a new person begins with the defaults.
/// @param name  empty: somebody who practises without a name
void choose_person(Settings& settings, const std::string& name);
/// How the directions of hands are set: as the handles of real instruments move, as things move on a screen, or mixed.
enum class Directions { theatre, screen, custom };
Directions directions_of(const PersonSettings& settings);
void set_directions(PersonSettings& settings, Directions directions);  ///< custom changes nothing
/// The defaults, for machine and person; names stay.
void reset_settings(Settings& settings);

/// Takes the name out, with this person's settings where others are there, too; true: it was there.
/// @throws core::EnvironmentLacks
bool forget_in_settings(const std::filesystem::path& file, const std::string& trainee);

/// The settings as pictures need them.
pictures::TwoEyes two_eyes(const Settings& settings);

/// The settings as the hands need them. @param instruments how many hands there are
devices::HandSettings hand_settings(const Settings& settings, int instruments);

}  // namespace trocar::app
