// The first thing that people see: who practises, then the exercises as tiles in the order in which they are learned,
// and from there everything else that Trocar can do. It only draws, and answers what was wanted.
//
//   StartAnswer answer = draw_start(content, memory);   // once per picture, in ImGui's frame
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <trocar/attempt/paths.hpp>
#include <trocar/training/store/attempt.hpp>

#include "start/children.hpp"
#include "start/past.hpp"

namespace trocar::app {

enum class StartPage { person, exercises, details, recordings, rooms, instruments, box, team, more };
/// For the log.
const char* name_of(StartPage page);

/// What is known of the selected exercise; empty while its scene is being prepared.
struct ExerciseFacts {
  std::vector<std::string> steps;  ///< their titles
  unsigned picture = 0;            ///< GL texture, 0: none yet
  float aspect = 4.0f / 3;
};

struct StartContent {
  const std::vector<attempt::ExerciseEntry>& exercises;
  const ExerciseFacts& facts;  ///< of the selected one
  bool ready = false;          ///< its scene is there
  std::string failure;         ///< why not
  const Past& past;
  std::string person;               ///< who practises; empty: without a name
  std::vector<std::string> people;  ///< everybody who is known, last first
  std::vector<std::string> gamepads;
  std::vector<std::string> notices;  ///< faults of settings, of the store
  bool sound = true;
  std::string news;  ///< how far a report is, or empty
  const Children& children;
  std::function<unsigned(int)> thumbnail;  ///< GL texture of an exercise; 0: none yet
};

enum class StartChoice { none, start, familiarise, demonstrate, settings, help, quit };

/// Patients that the screen offers are numbered 0, the standard patient, to this; the command line knows more.
inline constexpr std::uint64_t kMostAnatomies = 9999;

/// What the forms hold while one fills them in.
struct TeamForm {
  char address[64] = "0.0.0.0", port[8] = "4711", key[96] = "";
  char join_address[64] = "", join_port[8] = "4711", join_key[96] = "";
  int exercise = 0, role = 0, join_role = 0;
};

/// The screen's own memory.
struct StartMemory {
  static constexpr int kFresh = 4;  ///< Dear ImGui gives a new window's focus to its first widget once
  StartPage page = StartPage::person;
  int fresh = kFresh;  ///< pictures in which the first widget of a page that was opened takes the focus
  int selected = -1;   ///< exercise
  std::uint64_t seed = 0;
  bool was_ready = false;
  char name[training::kLongestName + 1] = {};  ///< of a person to add
  char search[64] = {};
  bool letters = false;             ///< the letters to type with a gamepad or mouse are shown
  std::optional<std::string> jump;  ///< group to be scrolled to
  std::string refusal;              ///< why a name was not taken
  bool all_results = false;         ///< attempts that were left after a few seconds, too
  TeamForm team;

  void open(StartPage where) { page = where, fresh = kFresh, was_ready = false; }
};

struct StartAnswer {
  StartChoice choice = StartChoice::none;
  std::optional<std::string> person;  ///< somebody practises from now on; empty: without a name
  std::int64_t report_of = 0;         ///< number of a past attempt
  ChildRequest program;               ///< to be started
  std::string stop;                   ///< title of a program to be ended
  bool news_read = false;             ///< the news need not be shown any more
};
/// @param back  Esc, or the gamepad's B
StartAnswer draw_start(const StartContent& content, StartMemory& memory, bool back);

}  // namespace trocar::app
