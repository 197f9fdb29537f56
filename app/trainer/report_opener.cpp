#include "trainer/report_opener.hpp"

#include <filesystem>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

extern char** environ;

namespace trocar::app {
namespace {

/// Starts `trocar report ATTEMPT --out FOLDER`. 0: it could not be started.
pid_t begin_page(const std::string& attempt, const std::string& folder, bool names) {
  std::vector<std::string> words{"trocar", "report", attempt, "--out", folder};
  if (names) words.emplace_back("--names");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);  // results are this process's to print
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed ? 0 : child;
}

}  // namespace

void ReportOpener::open(const training::Store* store, const std::string& attempt, bool names) {
  if (m_child > 0 || !store) return;
  std::optional<training::Attempt> found;
  try {
    found = store->find(attempt);
  } catch (const core::EnvironmentLacks& lacks) {
    m_say = tr("No report: {}", lacks.what());
    return;
  }
  if (!found) {
    m_say = tr("No report: this attempt is not stored.");
    return;
  }
  const std::string folder = (store->folder() / "reports" / found->uuid).string();
  m_page = folder + "/index.html";
  m_child = begin_page(found->uuid, folder, names);
  m_say = m_child > 0 ? tr("Making the report ...") : tr("No report: the program that makes it did not start.");
}

std::string ReportOpener::poll() {
  int status = 0;
  if (m_child <= 0 || waitpid(m_child, &status, WNOHANG) == 0) return {};
  m_child = 0;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    m_say = tr("No report: it could not be made. Run `trocar report` in a terminal to see why.");
    return {};
  }
  m_say = ui::open_in_browser(m_page) ? tr("The report opens in the browser. File: {}", m_page)
                                      : tr("There is no browser to open the report. File: {}", m_page);
  return m_page;
}

}  // namespace trocar::app
