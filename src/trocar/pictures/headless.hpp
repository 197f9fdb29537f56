// The loop without a window: ticks as fast as they go, pictures drawn in between on the same thread. `train --headless`
// and `replay` run it; what is drawn has no influence on what happens.
#pragma once

#include <functional>

#include <trocar/attempt/session.hpp>
#include <trocar/pictures/data_frames.hpp>
#include <trocar/pictures/picture_size.hpp>
#include <trocar/pictures/pictures.hpp>

namespace trocar::pictures {

struct HeadlessOptions {
  std::filesystem::path shots;  ///< folder; empty: none
  std::filesystem::path video;  ///< file; empty: none
  DataOptions data;
  PictureSize size;
  PictureLook look;        ///< of pictures and film
  double seconds = 0;      ///< stop after so much simulated time; 0: no limit
  bool real_time = false;  ///< no faster than the clock
};

/// What else a loop left behind, in the result's words: "pictures", "picture_index", "video", "data".
using Leftovers = Json;

/// Runs until the source has no more, time is up, somebody interrupts, or the physics has failed; an exercise that is
/// done does not end it, for the source may have instruments to take out. `each_tick` is called after every tick and
/// may end the loop by returning false.
Leftovers run_headless(attempt::Session& session, attempt::InputSource& source, const HeadlessOptions& options,
                       const std::function<bool()>& each_tick = {});

}  // namespace trocar::pictures
