#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/video.hpp>

extern char** environ;

namespace trocar::pictures {

namespace fs = std::filesystem;

namespace {

constexpr const char* kInstall = "install it: apt-get install ffmpeg";

struct Container {
  const char* ending;
  const char* format;  ///< ffmpeg's name
};
constexpr Container kContainers[] = {{".mp4", "mp4"}, {".m4v", "mp4"}, {".mov", "mov"}, {".mkv", "matroska"}};

const char* format_of(const fs::path& path) {
  const std::string ending = core::in_small_letters(path.extension().string());
  for (const Container& c : kContainers)
    if (ending == c.ending) return c.format;
  throw core::BadInput({{{path.string(), 0, 0}, "expected a film's name to end in .mp4, .m4v, .mov or .mkv"}});
}

/// A running program: its id, and our end of the pipe to its input or from its output.
struct Child {
  pid_t process = -1;
  int pipe = -1;
};

/// Starts ffmpeg. `to_it`: we write to its standard input; otherwise we read its standard output.
Child start_ffmpeg(std::vector<std::string> words, bool to_it) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw core::EnvironmentLacks(tr("cannot start ffmpeg: {}", std::strerror(errno)));
  words.insert(words.begin(), {"ffmpeg", "-hide_banner"});
  std::vector<char*> arguments;
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (to_it) {
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);  // standard output is for results
  } else {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  }
  Child child;
  const int error = posix_spawnp(&child.process, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[to_it ? 0 : 1]);
  child.pipe = ends[to_it ? 1 : 0];
  if (error == 0) return child;
  close(child.pipe);
  throw core::EnvironmentLacks(tr("no film: the program ffmpeg is missing; {}", kInstall));
}

int status_of(pid_t process) {
  int status = -1;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

std::string output_of(const std::vector<std::string>& words) {
  const Child child = start_ffmpeg(words, false);
  std::string text;
  char some[4096];
  for (ssize_t n; (n = read(child.pipe, some, sizeof some)) != 0;) {
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) break;
    text.append(some, std::size_t(n));
  }
  close(child.pipe);
  status_of(child.process);
  return text;
}

/// An encoder for H.264 that this ffmpeg has and that needs no special hardware, with what it wants to hear.
std::vector<std::string> h264_encoder() {
  const std::string encoders = output_of({"-loglevel", "error", "-encoders"});
  const auto has = [&encoders](const char* name) {
    return encoders.find(fmt::format(" {} ", name)) != std::string::npos;
  };
  if (has("libx264")) return {"libx264", "-preset", "veryfast", "-crf", "18"};
  if (has("libopenh264")) return {"libopenh264", "-b:v", "6M"};
  throw core::EnvironmentLacks(
      tr("no film: this ffmpeg has no H.264 encoder (libx264 or libopenh264); one of Debian has: {}", kInstall));
}

/// Makes the file, so that a missing folder or right is reported now.
void make_empty(const fs::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file)
    throw core::EnvironmentLacks(
        tr("cannot write the film {}: {}; choose another place", path.string(), std::strerror(errno)));
  std::fclose(file);
}

}  // namespace

std::unique_ptr<Video> Video::open(const fs::path& path, PictureSize size) {
  const char* format = format_of(path);
  const std::vector<std::string> encoder = h264_encoder();
  std::error_code error;
  if (fs::is_directory(path, error))
    throw core::EnvironmentLacks(tr("cannot write the film {}: it is a folder", path.string()));
  core::remove_unfinished(fs::absolute(path).parent_path(), path.filename().string());
  const fs::path part = core::unfinished_name(fs::absolute(path));  // absolute: never an option, never a protocol
  make_empty(part);
  std::vector<std::string> words{"-y", "-loglevel", "error", "-f", "rawvideo", "-pixel_format", "rgb24"};
  words.insert(words.end(), {"-video_size", fmt::format("{}x{}", size.width, size.height)});
  words.insert(words.end(), {"-framerate", std::to_string(kVideoRate), "-i", "-"});
  words.insert(words.end(), {"-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v"});
  words.insert(words.end(), encoder.begin(), encoder.end());
  words.insert(words.end(), {"-pix_fmt", "yuv420p"});
  if (std::strcmp(format, "matroska") != 0) words.insert(words.end(), {"-movflags", "+faststart"});
  words.insert(words.end(), {"-f", format, "file:" + part.string()});
  const Child child = start_ffmpeg(words, true);
  std::signal(SIGPIPE, SIG_IGN);  // a write to an ffmpeg that gave up is an error to report, not a signal that ends us
  return std::unique_ptr<Video>(new Video(path, part, child.pipe, child.process));
}

Video::~Video() {
  close_pipe();
  if (m_process <= 0) return;
  kill(m_process, SIGKILL);
  wait();
  std::error_code ignored;
  fs::remove(m_part, ignored);
}

void Video::close_pipe() {
  if (m_pipe >= 0) close(m_pipe);
  m_pipe = -1;
}

int Video::wait() {
  const int status = status_of(m_process);
  m_process = -1;
  return status;
}

void Video::add(const render::Image& image) {
  const std::uint8_t* data = image.rgb.data();
  std::size_t left = image.rgb.size();
  while (!m_broken && left > 0) {
    const ssize_t written = ::write(m_pipe, data, left);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      m_broken = true;
      break;
    }
    data += written;
    left -= std::size_t(written);
  }
  ++m_pictures;
}

bool Video::finish() {
  close_pipe();
  const int status = wait();
  std::error_code error;
  if (!m_broken && WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    fs::rename(m_part, m_path, error);
    if (!error) return true;
  } else {
    fs::remove(m_part, error);
  }
  core::log::error("no film: ffmpeg could not write {}", m_path.string());
  return false;
}

}  // namespace trocar::pictures
