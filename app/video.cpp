#include "video.hpp"

#include <cerrno>
#include <csignal>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/core/log.hpp>

extern char** environ;

namespace trocar::app {

std::unique_ptr<Video> Video::open(const std::filesystem::path& path, PictureSize size) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    core::log::warn("no video: the system has no pipe left");
    return nullptr;
  }
  std::vector<std::string> words{"ffmpeg",
                                 "-y",
                                 "-loglevel",
                                 "error",
                                 "-f",
                                 "rawvideo",
                                 "-pixel_format",
                                 "rgb24",
                                 "-video_size",
                                 fmt::format("{}x{}", size.width, size.height),
                                 "-framerate",
                                 std::to_string(kVideoRate),
                                 "-i",
                                 "-",
                                 "-vf",
                                 "crop=trunc(iw/2)*2:trunc(ih/2)*2",
                                 "-pix_fmt",
                                 "yuv420p",
                                 path.string()};
  if (words.back().rfind('-', 0) == 0) words.back() = "./" + words.back();  // a file, not an option
  std::vector<char*> arguments;
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);  // standard output is for results
  pid_t process = -1;
  const int error = posix_spawnp(&process, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  if (error != 0) {
    close(ends[1]);
    core::log::warn("no video: the program ffmpeg is missing (apt-get install ffmpeg)");
    return nullptr;
  }
  std::signal(SIGPIPE, SIG_IGN);  // a write to an ffmpeg that gave up is an error to be told, not our death
  return std::unique_ptr<Video>(new Video(path.string(), ends[1], process));
}

Video::~Video() {
  close_pipe();
  if (m_process > 0) waitpid(m_process, nullptr, 0);
}

void Video::close_pipe() {
  if (m_pipe >= 0) close(m_pipe);
  m_pipe = -1;
}

void Video::add(const render::Image& image) {
  const std::uint8_t* data = image.rgb.data();
  std::size_t left = image.rgb.size();
  while (!m_broken && left > 0) {
    const ssize_t written = write(m_pipe, data, left);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      m_broken = true;
      break;
    }
    data += written;
    left -= std::size_t(written);
  }
}

bool Video::finish() {
  close_pipe();
  int status = -1;
  while (waitpid(m_process, &status, 0) < 0 && errno == EINTR) {
  }
  m_process = -1;
  if (!m_broken && WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  core::log::warn("no video: ffmpeg could not write {}", m_path);
  return false;
}

}  // namespace trocar::app
