#include "report_opener.hpp"

#include <chrono>
#include <filesystem>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <trocar/core/error.hpp>

#include "ui.hpp"

extern char** environ;

namespace trocar::app {
namespace {

/// Waits for `trocar report ATTEMPT --out FOLDER`. False: it could not be started or failed.
bool make_page(const std::string& attempt, const std::string& folder) {
  std::string words[] = {"trocar", "report", attempt, "--out", folder};
  char* argv[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), words[4].data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);  // results are this process's to print
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  return !failed && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

void ReportOpener::open(const training::Store* store, const std::string& attempt) {
  if (m_page.valid() || !store) return;
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
  m_say = "making the report ...";
  const std::string folder = (store->folder() / "reports" / found->uuid).string();
  m_page = std::async(std::launch::async, [uuid = found->uuid, folder] {
    return make_page(uuid, folder) ? folder + "/index.html" : std::string();
  });
}

std::string ReportOpener::poll() {
  if (!m_page.valid() || m_page.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
  const std::string page = m_page.get();
  if (page.empty())
    m_say = "no report: `trocar report` failed, see the messages where Trocar was started";
  else
    m_say = (ui::open_in_browser(page) ? "opened in the browser: " : "the report is in ") + page;
  return page;
}

}  // namespace trocar::app
