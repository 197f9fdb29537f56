// A film through the `ffmpeg` program, if it is installed: pictures go into its standard input.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <sys/types.h>

#include <trocar/render/image.hpp>

#include "picture_size.hpp"

namespace trocar::app {

inline constexpr int kVideoRate = 25;  ///< pictures a second

class Video {
 public:
  /// Null, and a message on stderr, where there is no ffmpeg.
  static std::unique_ptr<Video> open(const std::filesystem::path& path, PictureSize size);
  ~Video();
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  void add(const render::Image& image);
  /// Waits for ffmpeg; false, and a message on stderr, when it failed.
  bool finish();
  const std::string& path() const { return m_path; }

 private:
  Video(std::string path, int pipe, pid_t process) : m_path(std::move(path)), m_pipe(pipe), m_process(process) {}
  void close_pipe();

  std::string m_path;
  int m_pipe = -1;
  pid_t m_process = -1;
  bool m_broken = false;
};

}  // namespace trocar::app
