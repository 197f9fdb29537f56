#include "trainer/report_opener.hpp"

#include <filesystem>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <trocar/core/error.hpp>

#include "shell/ui.hpp"

extern char** environ;

namespace trocar::app {
namespace {

/// Starts `trocar report ATTEMPT --out FOLDER`. 0: it could not be started.
pid_t begin_page(const std::string& attempt, const std::string& folder) {
  std::string words[] = {"trocar", "report", attempt, "--out", folder};
  char* argv[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), words[4].data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);  // results are this process's to print
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed ? 0 : child;
}

}  // namespace

void ReportOpener::open(const training::Store* store, const std::string& attempt) {
  if (m_child > 0 || !store) return;
  std::optional<training::Attempt> found;
  try {
    found = store->find(attempt);
  } catch (const core::EnvironmentLacks& lacks) {
    m_say = std::string("no report: ") + lacks.what();
    return;
  }
  if (!found) {
    m_say = "no report: the store does not know this attempt";
    return;
  }
  const std::string folder = (store->folder() / "reports" / found->uuid).string();
  m_page = folder + "/index.html";
  m_child = begin_page(found->uuid, folder);
  m_say = m_child > 0 ? "making the report ..." : "no report: `trocar report` could not be started";
}

std::string ReportOpener::poll() {
  int status = 0;
  if (m_child <= 0 || waitpid(m_child, &status, WNOHANG) == 0) return {};
  m_child = 0;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    m_say = "no report: `trocar report` failed, see the messages where Trocar was started";
    return {};
  }
  m_say = (ui::open_in_browser(m_page) ? "opened in the browser: " : "the report is in ") + m_page;
  return m_page;
}

}  // namespace trocar::app
