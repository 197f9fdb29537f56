// trocar report: what is known of an attempt as a page; all attempts as a list or a table; forgetting a trainee.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/log.hpp>
#include <trocar/reports/export.hpp>
#include <trocar/reports/report.hpp>
#include <trocar/reports/report_page.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/training/store/store.hpp>

#include "commands/command.hpp"
#include "shell/settings.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;
using training::Attempt;
using training::Store;

struct Options {
  std::string what, out, csv, trace, trainee, forget, compare;
  bool list = false, names = false, no_pictures = false;
};

void write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush())
    throw core::EnvironmentLacks(fmt::format("cannot write {}: {}", path, std::strerror(errno ? errno : ENOSPC)));
}

/// How much of `text` fits into so many columns.
std::string cut_to(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t at = most - 1;
  while (at > 0 && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) --at;  // not within a character
  return text.substr(0, at) + "~";
}

int list(const Store& store, const Options& o, bool json) {
  const std::vector<Attempt> attempts = store.list({.trainee = o.trainee});
  if (json) {
    Json entries = reports::attempts_json(attempts, true);
    for (Json& e : entries) e.erase("result");
    print({{"store", store.folder().string()}, {"attempts", entries}, {"notices", store.notices()}});
    return core::kDone;
  }
  if (attempts.empty()) {
    fmt::print("no attempts yet in {}\n", store.folder().string());
    return core::kDone;
  }
  fmt::print("{:>5}  {:16}  {:16}  {:28}  {:14}  {:11}  {:>5}  {:>8}\n", "", "begun (UTC)", "trainee", "exercise",
             "mode", "state", "score", "seconds");
  for (const Attempt& a : attempts) {
    std::string begun = a.started.substr(0, std::min<std::size_t>(16, a.started.size()));
    std::replace(begun.begin(), begun.end(), 'T', ' ');
    fmt::print("{:>5}  {:16}  {:16}  {:28}  {:14}  {:11}  {:>5}  {:8.1f}\n", a.number, begun, cut_to(a.trainee, 16),
               cut_to(a.exercise, 28), name_of(a.mode), name_of(a.state),
               a.score ? fmt::format("{:.0f}", *a.score) : "", a.seconds);
  }
  return core::kDone;
}

int forget(Store& store, const std::string& trainee, bool json) {
  std::vector<std::string> pages;
  for (const Attempt& a : store.list({.trainee = trainee})) pages.push_back(a.uuid);
  Store::Forgotten gone = store.forget(trainee);
  for (const std::string& uuid : pages) {
    std::error_code ignored;
    if (!uuid.empty() && uuid.find('/') == std::string::npos && uuid[0] != '.')
      fs::remove_all(store.folder() / "reports" / uuid, ignored);
  }
  try {
    forget_in_settings(settings_file(), trainee);
  } catch (const core::EnvironmentLacks& lacks) {
    core::log::warn("{}", lacks.what());
    gone.left.push_back(settings_file());
  }
  const auto texts = [](const std::vector<fs::path>& paths) {
    Json out = Json::array();
    for (const fs::path& p : paths) out.push_back(p.string());
    return out;
  };
  if (json) {
    print({{"trainee", trainee},
           {"attempts_deleted", gone.attempts},
           {"recordings_deleted", texts(gone.deleted)},
           {"left", texts(gone.left)},
           {"not_overwritten", gone.not_overwritten}});
  } else {
    fmt::print("{}: {} attempts and {} recordings deleted\n", trainee, gone.attempts, gone.deleted.size());
    for (const fs::path& p : gone.left) fmt::print("left, delete it yourself: {}\n", p.string());
    if (!gone.not_overwritten.empty())
      fmt::print("{} still holds deleted text ({}): end what uses it and do this again\n", store.database().string(),
                 gone.not_overwritten);
  }
  if (!gone.not_overwritten.empty()) return core::kEnvironment;
  return gone.attempts > 0 ? core::kDone : core::kGoalNotReached;
}

/// From a file: what it says itself, and what the store knows of the same attempt.
Attempt from_recording(const Store& store, const std::string& file) {
  Attempt there;
  if (!fill_from_recording(file, there)) {
    sim::read_recording(file);  // says what is wrong with it
    throw core::BadInput({{{file, 0, 0}, "expected a recording"}});
  }
  std::optional<Attempt> kept;
  try {
    kept = store.find(there.uuid);
  } catch (const core::EnvironmentLacks& lacks) {
    core::log::warn("{}", lacks.what());
  }
  if (!kept || kept->uuid != there.uuid) return there;  // another one's, whose uuid begins alike
  kept->recording = there.recording;
  return *kept;
}

Attempt chosen(const Store& store, const Options& o) {
  std::error_code error;
  if (!o.what.empty() && fs::is_regular_file(o.what, error)) return from_recording(store, o.what);
  if (!o.what.empty()) {
    if (std::optional<Attempt> a = store.find(o.what)) return *a;
    throw core::BadInput(
        {{{o.what, 0, 0},
          "expected a recording, or an attempt's number or uuid as `trocar report --list` shows them"}});
  }
  const std::vector<Attempt> all = store.list({.trainee = o.trainee, .limit = 1});
  if (all.empty())
    throw core::BadInput({{{"report", 0, 0}, "expected an attempt, there is none yet: do one with `trocar train`"}});
  return store.find(all.back().uuid).value_or(all.back());  // deleted meanwhile: without its motion
}

Json summary(const reports::Report& r) {
  Json out = reports::attempts_json({r.attempt}, r.names)[0];
  const Json result = out["result"];
  out.erase("result");
  if (!r.names) out.erase("trainee");
  out.update(result);
  out["complete"] = r.attempt.state == training::AttemptState::finished;
  return out;
}

int report(Store& store, const Options& o, bool json) {
  Attempt attempt = chosen(store, o);
  if (!o.compare.empty()) {
    if (o.compare != "demo") throw core::BadInput({{{"--compare", 0, 0}, "expected demo, got '" + o.compare + "'"}});
    if (!reports::gather(&store, attempt).scripted) reports::demonstrate(store, attempt.exercise, attempt.seed);
  }
  reports::Report r = reports::gather(&store, std::move(attempt));
  r.names = o.names;
  if (r.attempt.state != training::AttemptState::finished)
    core::log::warn("attempt {}: {}", r.attempt.uuid, name_of(r.attempt.state));
  Json result = summary(r);
  if (!o.csv.empty()) write_text(o.csv, reports::attempts_csv({r.attempt}, o.names));
  if (!o.trace.empty()) {
    if (!r.trace)
      throw core::BadInput({{{"--trace", 0, 0}, "expected an attempt whose motion is known, this one's is not"}});
    write_text(o.trace, to_csv(*r.trace));
  }
  const bool page = !o.out.empty() || (!json && o.csv.empty() && o.trace.empty());
  if (page) {
    const fs::path folder = o.out.empty() ? store.folder() / "reports" / r.attempt.uuid : fs::path(o.out);
    attempt::make_folder(folder);
    if (!o.no_pictures && !r.attempt.recording.empty()) reports::add_pictures(r, r.attempt.recording, folder);
    result["report"] = reports::write_report(folder, r);
  }
  if (json)
    print(result);
  else if (page)
    fmt::print("{}\n", result["report"].get<std::string>());
  return core::kDone;
}

int run(const Options& o, bool json) {
  Store store(attempt::data_folder());
  if (!o.forget.empty()) return forget(store, training::clean_name(o.forget), json);
  if (o.list) return list(store, o, json);
  if (!o.csv.empty() && o.what.empty()) {
    const std::vector<Attempt> all = store.list({.trainee = o.trainee});
    write_text(o.csv, reports::attempts_csv(all, o.names));
    if (json) print({{"csv", o.csv}, {"attempts", reports::attempts_json(all, o.names)}});
    return core::kDone;
  }
  return report(store, o, json);
}

}  // namespace

void add_report(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<Options>();
  CLI::App* c = add_command(program, chosen, "report", "Show how an attempt went; list, export and delete attempts",
                            "trocar report                      the latest attempt as a page\n"
                            "  trocar report --list\n"
                            "  trocar report 12 --out report --compare demo\n"
                            "  trocar report --csv attempts.csv --names");
  c->add_option("attempt", o->what, "number or uuid from --list, or a recording; default: the latest");
  c->add_flag("--list", o->list, "all attempts, oldest first");
  c->add_option("--trainee", o->trainee, "only this trainee's");
  c->add_option("--out", o->out, "folder of the page; default: reports/UUID in the data folder");
  c->add_option("--csv", o->csv, "write the attempt, or without one all, as a table");
  c->add_option("--trace", o->trace, "write the attempt's motion, 50 samples a second, as a table");
  c->add_option("--compare", o->compare, "demo: with the scripted surgeon, who does it now if need be");
  c->add_flag("--names", o->names, "name the trainee in page and table");
  c->add_flag("--no-pictures", o->no_pictures, "without pictures of key moments: quicker");
  c->add_option("--forget", o->forget, "delete this trainee's attempts and recordings");
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return run(*o, chosen.json); }; });
}

}  // namespace trocar::app
