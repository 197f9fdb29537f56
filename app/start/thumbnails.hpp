// Small pictures of scenes for the tiles: made once, one after the other, by a second Trocar in the background, kept in
// the data folder, and made again when the scene's file changes.
//
//   Thumbnails thumbnails;
//   thumbnails.work(true);                        // once per picture, while nothing else needs the processor
//   unsigned texture = thumbnails.of(exercise);   // GL; 0: not there yet
#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include <trocar/attempt/paths.hpp>
#include <trocar/render/frame/image.hpp>

#include "shell/child_program.hpp"

namespace trocar::app {

inline constexpr int kThumbnailWidth = 480, kThumbnailHeight = 360;

/// Where the picture of an exercise is kept; its name holds what the files of exercise and scene contain.
std::filesystem::path thumbnail_file(const attempt::ExerciseEntry& exercise);

class Thumbnails {
 public:
  Thumbnails() = default;
  ~Thumbnails();
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  /// The texture. What is not there yet is asked for: what was asked for last is made first.
  unsigned of(const attempt::ExerciseEntry& exercise);
  /// Begins the next picture where none is being made. @param may  the processor is free
  void work(bool may);
  /// A picture that was drawn for something else and would do.
  void keep(const attempt::ExerciseEntry& exercise, const render::Image& image);

 private:
  struct Picture {
    std::filesystem::path file;
    unsigned texture = 0;
    bool asked = false, failed = false;
  };
  Picture& picture_of(const attempt::ExerciseEntry& exercise);
  void load(Picture& picture);

  std::map<std::string, Picture> m_pictures;  ///< by the exercise's name
  std::deque<std::string> m_wanted;
  std::string m_being_made;
  int m_looked_up = 0;  ///< since the window's last picture
  std::optional<ChildProgram> m_maker;
};

}  // namespace trocar::app
