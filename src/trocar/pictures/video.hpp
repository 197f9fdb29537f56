// A film (H.264, yuv420p, 25 pictures a second) through the `ffmpeg` program: pictures go into its standard input. What
// can go wrong is found out by open(), before anybody has worked for it.
//
//   auto video = Video::open("a.mp4", {800, 600});       // throws core::EnvironmentLacks
//   video->add(image);  ...  video->finish();
//
// It is written beside its name (core::unfinished_name) and takes the name when it is whole: an old film survives a
// failure.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <sys/types.h>

#include <trocar/pictures/picture_size.hpp>
#include <trocar/render/frame/image.hpp>

namespace trocar::pictures {

inline constexpr int kVideoRate = 25;  ///< pictures a second

class Video {
 public:
  /// @throws core::EnvironmentLacks where ffmpeg, its H.264 encoder or the right to write there is missing;
  ///         core::BadInput where the name is not that of a film (.mp4, .m4v, .mov, .mkv)
  static std::unique_ptr<Video> open(const std::filesystem::path& path, PictureSize size);
  ~Video();  ///< without finish(): nothing is left behind
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  /// All pictures must have the size given to open().
  void add(const render::Image& image);
  /// Waits for ffmpeg; false, and a message on stderr, when it failed.
  bool finish();
  std::string path() const { return m_path.string(); }
  std::uint64_t pictures() const { return m_pictures; }
  bool broken() const { return m_broken; }  ///< ffmpeg has given up

 private:
  Video(std::filesystem::path path, std::filesystem::path part, int pipe, pid_t process)
      : m_path(std::move(path)), m_part(std::move(part)), m_pipe(pipe), m_process(process) {}
  void close_pipe();
  int wait();

  std::filesystem::path m_path, m_part;
  int m_pipe = -1;
  pid_t m_process = -1;
  std::uint64_t m_pictures = 0;
  bool m_broken = false;
};

}  // namespace trocar::pictures
