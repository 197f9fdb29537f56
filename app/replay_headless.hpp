// `trocar replay` without a window: the recording's inputs again, every hash compared if that is wanted, pictures and a
// film of any part from any camera. A recording of another version of the physics gives its keyframes.
#pragma once

#include <string>

#include <trocar/sim/recording.hpp>

#include "camera_choice.hpp"
#include "data_frames.hpp"
#include "film_plan.hpp"
#include "json.hpp"
#include "lesson.hpp"
#include "picture_size.hpp"
#include "pictures.hpp"

namespace trocar::app {

struct ReplayOptions {
  std::string file;          ///< the recording, for messages
  std::string shots, video;  ///< folder, file; empty: none
  DataOptions data;
  PictureSize size;
  PictureLook look;  ///< of pictures and film
  CameraChoice camera;
  double from = 0, to = -1;  ///< [s]; to < 0: the end
  double speed = 1;          ///< of the film
  bool verify = false;
};

/// The part from..to in ticks, of `last` at most.  @throws core::BadInput where it is empty
FilmPlan plan_of(const ReplayOptions& options, std::uint64_t last);

/// Runs it; what is to say about it: "played", "verified", "pictures", "video" ...
/// @throws core::BadInput, core::EnvironmentLacks
Json replay_headless(const Lesson& lesson, const sim::Recording& recording, const ReplayOptions& options);

}  // namespace trocar::app
