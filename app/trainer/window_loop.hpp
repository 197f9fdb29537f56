// The trainee's program: start screen, settings, help, and the exercise with picture, panel and result. The simulation
// runs on a thread of its own at 1 kHz and is never waited for nor skipped. Slow machines show slow motion, and say so.
#pragma once

#include <memory>
#include <optional>

#include <trocar/attempt/inputs/input_map.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/team/host.hpp>
#include <trocar/attempt/team/member.hpp>
#include <trocar/attempt/tracker/tracker_file.hpp>
#include <trocar/pictures/picture_size.hpp>
#include <trocar/training/store/store.hpp>

namespace trocar::app {

struct WindowOptions {
  std::string exercise;         ///< preselected on the start screen; empty: the first
  std::string record;           ///< file; empty: a name of our own in the user's data folder
  std::uint64_t seed = 0;       ///< of the anatomy on the start screen
  std::string trainee;          ///< empty: the last one
  std::string input = "mouse";  ///< mouse or gamepad: hands, by whatever device; or a source: see make_source()
  std::string log;              ///< JSON lines of events; empty: $TROCAR_WINDOW_LOG, or none
  std::optional<pictures::PictureSize> size;            ///< nothing: as last time
  double seconds = 0;                                   ///< 0: no limit
  bool familiarisation = false;                         ///< no score
  training::Store* store = nullptr;                     ///< null: nothing is kept but recordings that were asked for
  std::string beside;                                   ///< organ whose other solver runs beside; empty: none
  std::shared_ptr<const attempt::Lesson> other_solver;  ///< the exercise with it
  std::optional<attempt::InputMap> map;                 ///< what several devices lead; nothing: one person leads all
  std::optional<attempt::TrackerPlan> tracker;          ///< whose tools lead some of it; nothing: there is none
  std::optional<attempt::TeamPlan> team;                ///< whoever plays along; nothing: nobody
  std::shared_ptr<attempt::TeamMember> member;          ///< this is a part in somebody else's attempt; null: it is not
  std::string room;                                     ///< an operating room, in a window of its own; empty: none
  std::string haptics;       ///< device that leads a hand (devices/haptics/choose_device.hpp); empty: none
  std::string haptics_hand;  ///< that it leads, by its trocar; empty, or not there: the right one
};

/// Opens the window: with a lesson straight in the exercise, without one on the start screen. Returns the last
/// attempt's result when it is closed; null where there was none.
/// @throws core::EnvironmentLacks without a display or OpenGL 3.3
Json run_window(std::unique_ptr<attempt::Lesson> lesson, const WindowOptions& options);

}  // namespace trocar::app
