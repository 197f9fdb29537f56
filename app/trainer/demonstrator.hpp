// Demonstrations in the trainer's window. The first time that one is asked for it is recorded beside what people do
// there, with its progress in a corner; then the player shows it, and "Now you" starts the exercise with the same
// patient. What has been recorded is kept.
//
//   demonstrator.ask(*lesson);                             // the button was pressed
//   if (demonstrator.draw(lesson)) ...                     // once a picture: it is there, and may be played
//   if (demonstrator.play(stage, *lesson) == PlayerEnd::now_you) train(...);
#pragma once

#include <optional>
#include <string>

#include <trocar/attempt/playback/demonstration_maker.hpp>

#include "player/player.hpp"
#include "trainer/trainer_window.hpp"

namespace trocar::app {

class Demonstrator {
 public:
  /// Plays what is kept, or begins to record it.
  void ask(const attempt::Lesson& lesson);
  /// The corner with the progress. @param lesson  what is shown; may be null
  /// @return the demonstration that was asked for is there, and it is of this lesson: play it now
  bool draw(const attempt::Lesson* lesson);
  /// Until the person leaves it. What cannot be played is said in the corner.
  PlayerEnd play(TrainerWindow& stage, const attempt::Lesson& lesson);

  const attempt::DemonstrationMaker& maker() const { return m_maker; }

 private:
  void draw_progress(const attempt::DemonstrationMaker::Progress& p);
  bool is_of(const attempt::Lesson* lesson) const;

  attempt::DemonstrationMaker m_maker;
  std::string m_exercise;  ///< of what was asked for; empty: nothing
  std::uint64_t m_seed = 0;
  std::optional<std::filesystem::path> m_file;  ///< it is there
  std::string m_failure;
};

/// A recording in the trainer's window until the person leaves it. Nothing is thrown: what is wrong comes in `failure`.
PlayerEnd play_recording(TrainerWindow& stage, const attempt::Lesson& lesson, const std::filesystem::path& file,
                         bool demonstration, std::string& failure);

}  // namespace trocar::app
