// The first thing that people see: which exercise, who trains, what is plugged in, how it went last time, and one
// button that says what to do.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <trocar/attempt/paths.hpp>
#include <trocar/training/store/attempt.hpp>

#include "shell/settings.hpp"
#include "trainer/past.hpp"

namespace trocar::app {

/// What is known of the selected exercise; empty while its scene is being prepared.
struct ExerciseFacts {
  std::string summary;             ///< a sentence or two
  std::vector<std::string> steps;  ///< their names, a line a side
  std::vector<std::string> facts;  ///< "time: about 4 minutes", "pass mark: 80 of 100"
  unsigned picture = 0;            ///< GL texture, 0: none yet
  float aspect = 4.0f / 3;
};

struct StartContent {
  const std::vector<attempt::ExerciseEntry>& exercises;
  int selected = 0;
  std::uint64_t seed = 0;  ///< of the anatomy; 0: as drawn
  const ExerciseFacts& facts;
  bool ready = false;   ///< the scene is there
  std::string failure;  ///< why not
  const Past& past;
  std::vector<std::string> gamepads;
  std::vector<std::string> notices;  ///< faults of settings, of the store
  bool sound = true;
  std::string say;  ///< how far a report is, or empty
};

enum class StartChoice { none, start, familiarise, demonstrate, report, settings, help, quit };

/// Anatomies that the screen offers are numbered 0, as drawn, to this; the command line knows more.
inline constexpr std::uint64_t kMostAnatomies = 9999;

/// The screen's own memory.
struct StartMemory {
  char trainee[training::kLongestName + 1] = {};
  bool was_ready = false;  ///< when it was drawn last
  bool letters = false;    ///< the letters to type with a gamepad or mouse are shown
};

struct StartAnswer {
  StartChoice choice = StartChoice::none;
  int selected = -1;                  ///< another exercise
  std::optional<std::uint64_t> seed;  ///< another anatomy
  bool trainee_changed = false;       ///< the name in the memory is another one now
  std::int64_t report_of = 0;         ///< number of a past attempt
};
StartAnswer draw_start(const StartContent& content, StartMemory& memory);

/// Settings, over whatever is there. True: closed. `edited` is applied at once; `before` is what undo brings back.
/// @param quad_buffers  this window has them
bool draw_settings(Settings& edited, const Settings& before, bool sound, bool quad_buffers);

}  // namespace trocar::app
