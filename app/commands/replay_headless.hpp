// `trocar replay` without a window: the recording's inputs again, every hash compared if that is wanted, pictures and a
// film of any part from any camera. A recording of another version of the physics gives its keyframes.
#pragma once

#include <string>

#include <trocar/attempt/lesson.hpp>
#include <trocar/core/json.hpp>
#include <trocar/pictures/camera_choice.hpp>
#include <trocar/pictures/data_frames.hpp>
#include <trocar/pictures/film_plan.hpp>
#include <trocar/pictures/picture_size.hpp>
#include <trocar/pictures/pictures.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::app {

struct ReplayOptions {
  std::string file;          ///< the recording, for messages
  std::string shots, video;  ///< folder, file; empty: none
  pictures::DataOptions data;
  pictures::PictureSize size;
  pictures::PictureLook look;  ///< of pictures and film
  pictures::CameraChoice camera;
  double from = 0, to = -1;  ///< [s]; to < 0: the end
  double speed = 1;          ///< of the film
  bool verify = false;
};

/// The part from..to in ticks, of `last` at most.  @throws core::BadInput where it is empty
pictures::FilmPlan plan_of(const ReplayOptions& options, std::uint64_t last);

/// Runs it; what is to say about it: "played", "verified", "pictures", "video" ...
/// @throws core::BadInput, core::EnvironmentLacks
Json replay_headless(const attempt::Lesson& lesson, const sim::Recording& recording, const ReplayOptions& options);

}  // namespace trocar::app
