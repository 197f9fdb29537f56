#include "commands/report/report_forget.hpp"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/store/forgetting.hpp>

#include "commands/command.hpp"
#include "shell/settings.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;
using training::Attempt;
using training::Store;

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string attempts_and_recordings(int attempts, std::size_t recordings) {
  return tr("{} and {}", counted(std::size_t(attempts), tr("attempt"), tr("attempts")),
            counted(recordings, tr("recording"), tr("recordings")));
}

Json texts(const std::vector<fs::path>& paths) {
  Json out = Json::array();
  for (const fs::path& p : paths) out.push_back(p.string());
  return out;
}

/// The pages of these attempts that are there.
std::vector<fs::path> pages_of(const Store& store, const std::string& trainee) {
  std::vector<fs::path> pages;
  for (const Attempt& a : store.list({.trainee = trainee})) {
    std::error_code error;
    const fs::path page = page_folder(store, a);
    if (fs::exists(page, error)) pages.push_back(page);
  }
  return pages;
}

/// Lists what would go.
int list_what_goes(const Store& store, const std::string& trainee, bool json) {
  const Store::Forgotten goes = training::to_forget(store, trainee);
  const std::vector<fs::path> pages = pages_of(store, trainee);
  if (json) {
    print({{"trainee", trainee},
           {"dry_run", true},
           {"attempts", goes.attempts},
           {"recordings", texts(goes.deleted)},
           {"reports", texts(pages)},
           {"left", texts(goes.left)}});
    return core::kDone;
  }
  fmt::print("{}\n",
             tr("{}: {} would be deleted", trainee, attempts_and_recordings(goes.attempts, goes.deleted.size())));
  for (const Attempt& a : store.list({.trainee = trainee}))
    fmt::print("  {:>5}  {}  {}\n", a.number, a.started, a.exercise);
  for (const std::vector<fs::path>* paths : {&goes.deleted, &pages})
    for (const fs::path& p : *paths) fmt::print("  {}\n", p.string());
  for (const fs::path& p : goes.left) fmt::print("{}\n", tr("This file would be left: {}", p.string()));
  return core::kDone;
}

/// Asks at the terminal. @throws core::BadInput where there is none
bool confirmed(const Store& store, const std::string& trainee) {
  if (!isatty(STDIN_FILENO) || !isatty(STDERR_FILENO))
    throw core::BadInput(
        {{{"--forget", 0, 0}, tr("expected --yes where no terminal can ask (--dry-run lists what would be deleted)")}});
  const Store::Forgotten goes = training::to_forget(store, trainee);
  fmt::print(stderr, "{} ",
             tr("Delete {} of {}? This cannot be undone. Type yes:",
                attempts_and_recordings(goes.attempts, goes.deleted.size()), trainee));
  std::fflush(stderr);
  char answer[16] = {};
  return std::fgets(answer, sizeof answer, stdin) && std::string_view(answer) == "yes\n";
}

void say_gone(const Store& store, const std::string& trainee, const Store::Forgotten& gone, bool json) {
  if (json) {
    print({{"trainee", trainee},
           {"attempts_deleted", gone.attempts},
           {"recordings_deleted", texts(gone.deleted)},
           {"left", texts(gone.left)},
           {"not_overwritten", gone.not_overwritten}});
    return;
  }
  fmt::print("{}\n", tr("{}: {} deleted", trainee, attempts_and_recordings(gone.attempts, gone.deleted.size())));
  for (const fs::path& p : gone.left) fmt::print("{}\n", tr("This file is left; delete it yourself: {}", p.string()));
  if (!gone.not_overwritten.empty())
    fmt::print("{}\n", tr("{} still holds deleted text ({}). Close the programs that use it, then repeat this command.",
                          store.database().string(), gone.not_overwritten));
}

}  // namespace

fs::path page_folder(const Store& store, const Attempt& a) {
  return store.folder() / "reports" / (training::is_uuid(a.uuid) ? a.uuid : fmt::format("attempt-{}", a.number));
}

std::string no_attempts_of(const Store& store, const std::string& trainee) {
  std::string known;
  for (const std::string& name : store.trainees()) known += (known.empty() ? "" : ", ") + name;
  if (known.empty()) return tr("no attempts yet in {}", store.folder().string());
  return tr("no attempts of {}; known: {}", trainee, known);
}

int forget_trainee(Store& store, const ForgetChoice& choice, bool json) {
  const std::string& trainee = choice.trainee;
  if (training::to_forget(store, trainee).attempts == 0) {
    if (!choice.dry_run && choice.yes) forget_in_settings(settings_file(), trainee);
    if (json)
      say_gone(store, trainee, training::to_forget(store, trainee), json);
    else
      fmt::print("{}\n", no_attempts_of(store, trainee));
    return core::kGoalNotReached;
  }
  if (choice.dry_run) return list_what_goes(store, trainee, json);
  if (!choice.yes && !confirmed(store, trainee)) {
    fmt::print(stderr, "{}\n", tr("Nothing was deleted."));
    return core::kGoalNotReached;
  }
  const std::vector<fs::path> pages = pages_of(store, trainee);
  Store::Forgotten gone = store.forget(trainee);
  for (const fs::path& page : pages) {
    std::error_code ignored;
    fs::remove_all(page, ignored);
  }
  try {
    forget_in_settings(settings_file(), trainee);
  } catch (const core::EnvironmentLacks& lacks) {
    core::log::warn("{}", lacks.what());
    gone.left.push_back(settings_file());
  }
  say_gone(store, trainee, gone, json);
  return gone.not_overwritten.empty() ? core::kDone : core::kEnvironment;
}

}  // namespace trocar::app
