#include "shell/child_program.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

extern char** environ;

namespace trocar::app {
namespace {

constexpr off_t kLongestTail = 16 * 1024;

/// A file in memory: a pipe would end the child with a signal when this program ends first.
int file_in_memory(const char* name) { return memfd_create(name, MFD_CLOEXEC); }

/// The last part of the file. pread leaves the position alone: the child writes there.
std::string tail_of(int file) {
  struct stat facts {};
  if (file < 0 || fstat(file, &facts) != 0) return {};
  const off_t from = std::max<off_t>(0, facts.st_size - kLongestTail);
  std::string text(std::size_t(facts.st_size - from), '\0');
  const ssize_t got = pread(file, text.data(), text.size(), from);
  text.resize(std::size_t(std::max<ssize_t>(0, got)));
  return text;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> list;
  for (std::string& w : words) list.push_back(w.data());
  list.push_back(nullptr);
  return list;
}

/// This program's environment; what is added stands for what has the same name.
std::vector<std::string> environment_with(const std::vector<std::string>& variables) {
  std::vector<std::string> all = variables;
  for (char** v = environ; *v; ++v) {
    const std::string name = std::string(*v, std::strcspn(*v, "=")) + "=";
    const auto same = [&name](const std::string& added) { return added.compare(0, name.size(), name) == 0; };
    if (std::none_of(variables.begin(), variables.end(), same)) all.emplace_back(*v);
  }
  return all;
}

int spawn_child(pid_t& child, const std::string& program, std::vector<std::string> words,
                std::vector<std::string> variables, int output, int errors) {
  const std::string path = program.empty() ? "/proc/self/exe" : program;
  words.insert(words.begin(), program.empty() ? "trocar" : program);
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_addopen(&streams, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&streams, output, 1);
  posix_spawn_file_actions_adddup2(&streams, errors, 2);
  posix_spawnattr_t attributes;  // a shell that starts programs in the background lets them ignore SIGINT
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGINT);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  const int failed =
      posix_spawnp(&child, path.c_str(), &streams, &attributes, pointers(words).data(), pointers(variables).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&streams);
  return failed;
}

int exit_of(int waited) { return WIFSIGNALED(waited) ? 128 + WTERMSIG(waited) : WEXITSTATUS(waited); }

}  // namespace

ChildProgram::ChildProgram(const std::vector<std::string>& arguments, const std::string& program,
                           const std::vector<std::string>& variables)
    : m_errors(file_in_memory("errors")), m_output(file_in_memory("output")) {
  const int failed = m_errors < 0 || m_output < 0
                         ? errno
                         : spawn_child(m_child, program, arguments, environment_with(variables), m_output, m_errors);
  if (!failed) return;
  m_child = -1;
  leave();
  throw core::EnvironmentLacks(tr("The program could not be started: {}", std::strerror(failed)));
}

ChildProgram::~ChildProgram() { leave(); }

ChildProgram::ChildProgram(ChildProgram&& other) noexcept
    : m_child(std::exchange(other.m_child, -1)),
      m_status(other.m_status),
      m_errors(std::exchange(other.m_errors, -1)),
      m_output(std::exchange(other.m_output, -1)) {}

ChildProgram& ChildProgram::operator=(ChildProgram&& other) noexcept {
  if (this == &other) return *this;
  leave();
  m_child = std::exchange(other.m_child, -1);
  m_status = other.m_status;
  m_errors = std::exchange(other.m_errors, -1);
  m_output = std::exchange(other.m_output, -1);
  return *this;
}

/// A thread waits for a child that outlives this object.
void ChildProgram::leave() {
  if (running())
    std::thread([child = m_child] {
      int ignored = 0;
      waitpid(child, &ignored, 0);
    }).detach();
  m_child = -1;
  for (int* file : {&m_errors, &m_output})
    if (const int open = std::exchange(*file, -1); open >= 0) close(open);
}

bool ChildProgram::running() {
  int waited = 0;
  if (m_child < 0) return false;
  const pid_t ended = waitpid(m_child, &waited, WNOHANG);
  if (ended == 0) return true;
  m_status = ended == m_child ? exit_of(waited) : 0;
  m_child = -1;
  return false;
}

std::optional<int> ChildProgram::exit_status() {
  running();
  return m_status;
}

void ChildProgram::ask_to_end() {
  if (running()) kill(m_child, SIGINT);
}

bool ChildProgram::failed() { return exit_status().value_or(0) != 0; }
std::string ChildProgram::errors() const { return tail_of(m_errors); }
std::string ChildProgram::output() const { return tail_of(m_output); }

}  // namespace trocar::app
