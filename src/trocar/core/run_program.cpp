#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/core/run_program.hpp>

namespace trocar::core {
namespace {

/// What comes through a pipe. False: more than that.
bool read_all(int pipe, std::size_t most, std::string& out) {
  char some[4096];
  for (ssize_t n; (n = read(pipe, some, sizeof some)) != 0;) {
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) break;
    out.append(some, std::size_t(n));
    if (out.size() > most) return false;
  }
  return true;
}

}  // namespace

ProgramEnd run_program(const std::filesystem::path& program, std::vector<std::string> arguments, std::size_t most) {
  ProgramEnd end;
  int pipe[2];
  if (pipe2(pipe, O_CLOEXEC) != 0) return end;
  arguments.insert(arguments.begin(), program.string());
  std::vector<char*> words;
  for (std::string& a : arguments) words.push_back(a.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
  pid_t child = -1;
  end.started = posix_spawn(&child, program.c_str(), &actions, nullptr, words.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  close(pipe[1]);
  if (end.started) {
    if (!read_all(pipe[0], most, end.output)) kill(child, SIGKILL);
    int status = -1;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status)) end.status = WEXITSTATUS(status);
    if (end.status == 127 && end.output.empty()) end.started = false;  // there is no such program
  }
  close(pipe[0]);
  return end;
}

}  // namespace trocar::core
